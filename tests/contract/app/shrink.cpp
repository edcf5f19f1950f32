// Bundles made small: what is left still does it, nothing of it can go, and it opens like any bundle.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <csignal>

#include "engine/io/scene/toml.hpp"
#include "tests/support/program/debug_session.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "viewer/bundle/bundle.hpp"

using namespace impinge;
using namespace impinge::test;
namespace fs = std::filesystem;

namespace {

const fs::path kFaults = fs::path(IMPINGE_SOURCE_DIR) / "scenes/faults";

/// Bodies that have nothing to do with it: a row of marbles in the air, far from everything.
std::string bystanders(int count, double x = 40.0) {
  std::string text;
  for (int k = 0; k < count; ++k)
    text += fmt::format(
        "[[body]]\nname = \"bystander_{}\"\nkind = \"dynamic\"\nshape = {{ sphere = {{ radius = 0.1 }} }}\n"
        "position = [{}, {}, 0]\n",
        k, x + k, 20 + k % 3);
  return text;
}

/// Writes a scene, and a bundle of its frame.
void make_bundle(const TempFolder& folder, const std::string& scene, int frame, const std::string& script = "") {
  folder.write("s.toml", scene);
  folder.write("a.script", script + fmt::format("step {}\nbundle b.tar\n", frame));
  const Outcome made = debug(folder, "s.toml", "a.script");
  INFO(made.err);
  REQUIRE(made.code == 0);
}

struct Small {
  Outcome outcome;
  TomlNode scene;
  int frame = -1;
  std::vector<std::string> bodies;
  /// "before -> after" of a line of what was said.
  std::pair<int, int> sizes(const std::string& what) const {
    std::pair<int, int> both = {-1, -1};
    const std::size_t at = outcome.out.find(what);
    if (at != std::string::npos)
      std::sscanf(outcome.out.c_str() + at + what.size(), "%d -> %d", &both.first, &both.second);
    return both;
  }
  const TomlNode& body(const std::string& name) const {
    for (const TomlNode& body : scene.find("body")->value.items)
      if (body.find("name")->value.string == name) return body;
    FAIL("no " << name);
    return scene;
  }
};

Small shrink(const TempFolder& folder, const std::string& when, const std::string& out = "small.tar") {
  Small small;
  small.outcome = impinge_run(folder.path(), {"shrink", "b.tar", "--when", when, "--out", out});
  INFO(small.outcome.out << small.outcome.err);
  REQUIRE(small.outcome.code == 0);
  const std::string bytes = slurp(folder / out);
  const Bundle bundle = parse_bundle(out, bytes);
  small.frame = bundle.head.frame;
  small.scene = parse_toml("run.toml", std::string(bundle.parts.at("run.toml")));
  for (const TomlNode& body : small.scene.find("body")->value.items)
    small.bodies.push_back(body.find("name")->value.string);
  // it opens like any bundle, its states are what they say, and the condition comes true in its last frame
  CHECK(impinge_run(folder.path(), {"replay", out}).code == 0);
  folder.write("find.script", "find " + when + "\n");
  const Outcome found = debug(folder, out, "find.script");
  CHECK(end_of(found).first == small.frame);
  CHECK(bundle.parts.contains("picture.png"));
  return small;
}

/// Without gravity: a hammer that flies towards a soft block, before a wall.
std::string hammer_scene(const std::string& hammer_x) {
  return R"(
[simulation]
gravity = [0, 0, 0]
[[body]]
name = "hammer"
kind = "dynamic"
shape = { box = { size = [0.5, 1, 1] } }
material = { density = 4000 }
position = [)" +
         hammer_x + R"(, 0, 0]
velocity = [4, 0, 0]
[[body]]
name = "block"
kind = "deformable"
shape = { box = { size = [1, 1, 1] } }
volume = { lattice = { cells = 2 } }
material = { young = 1e6, poisson = 0.3, density = 1000, damping = [0, 0.01] }
[[body]]
name = "wall"
kind = "static"
shape = { box = { size = [0.5, 4, 4] } }
position = [2.5, 0, 0]
)";
}

}  // namespace

TEST_CASE("of a fault with bystanders the two bodies that overlap are left, and one frame") {
  const TempFolder folder;
  make_bundle(folder, slurp(kFaults / "start_overlap.toml") + bystanders(37), 30,
              "at 4 set contact.friction 0.2\nat 9 layer +aabbs\nat 12 set simulation.gravity 0 -3 0\n");
  const Small small = shrink(folder, "max_penetration_m > 0.3");
  CHECK(small.bodies == std::vector<std::string>{"left", "right"});
  CHECK(small.sizes("bodies") == std::pair(41, 2));
  CHECK(small.sizes("frames") == std::pair(31, 1));
  CHECK(small.sizes("commands") == std::pair(3, 0));
  CHECK(small.frame == 0);
  // every time the same, byte for byte
  const Small again = shrink(folder, "max_penetration_m > 0.3", "again.tar");
  CHECK(slurp(folder / "again.tar") == slurp(folder / "small.tar"));
}

TEST_CASE("of a body shot at a sheet its form goes too, as far as it still comes out below") {
  const TempFolder folder;
  std::string scene = slurp(kFaults / "passed_sheet.toml");
  const std::string meshes = "../meshes/", there = (fs::path(IMPINGE_SOURCE_DIR) / "scenes/meshes/").string();
  for (std::size_t at; (at = scene.find(meshes)) != std::string::npos;) scene.replace(at, meshes.size(), there);
  make_bundle(folder, scene + bystanders(11), 8);
  const Small small = shrink(folder, "unsafe_motions > 0");
  CHECK(small.bodies == std::vector<std::string>{"sheet", "bunny"});
  CHECK(small.sizes("bodies") == std::pair(13, 2));
  const auto [before, after] = small.sizes("triangles");
  CHECK(before > 1000);
  CHECK(20 * after < before);
}

TEST_CASE("frames before it matters are left out: bodies begin where they were, as fast as they were") {
  const TempFolder folder;
  make_bundle(
      folder,
      "[[body]]\nname = \"stone\"\nkind = \"dynamic\"\nshape = { box = { size = [1, 2, 3] } }\nposition = [0, 50, "
      "0]\nrotation = [10, 20, 30]\nangular_velocity = [1, 0, 0]\n" +
          bystanders(5),
      80);
  // speed after k frames: 9.81 k / 60, so the 61st is the first
  const Small small = shrink(folder, "speed(stone) > 9.9");
  CHECK(small.bodies == std::vector<std::string>{"stone"});
  CHECK(small.sizes("frames") == std::pair(81, 2));
  const TomlNode& velocity = small.body("stone").find("velocity")->value;
  CHECK(velocity.items[1].as_number() == Approx(-9.81).epsilon(1e-9));
}

TEST_CASE("of many commands those are left without which it doesn't come true") {
  const TempFolder folder;
  std::string script;
  for (int k = 1; k < 12; ++k) script += fmt::format("at {} set contact.friction 0.{}\n", k, 10 + k);
  make_bundle(
      folder,
      "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
      "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.5 } }\nposition = [0, 0.5, 0]\n",
      60, script + "at 20 set simulation.gravity 30 -9.81 0\n");
  const Small small = shrink(folder, "speed(ball) > 5");
  CHECK(small.bodies == std::vector<std::string>{"ball"});
  CHECK(small.sizes("commands") == std::pair(12, 1));
  CHECK(small.scene.find("run")->value.find("script")->value.items.at(0).string ==
        "at 0 set simulation.gravity 30 -9.81 0");
}

TEST_CASE("attached bodies begin later where their joints are by then") {
  // a rod swings about its end, past the lowest point and into a post: without its joint it would fall beside it
  const TempFolder folder;
  make_bundle(folder,
              "[[body]]\nname = \"rod\"\nkind = \"dynamic\"\nshape = { box = { size = [1, 0.1, 0.1] } }\n"
              "position = [0.5, 3, 0]\n[[body]]\nname = \"post\"\nkind = \"static\"\n"
              "shape = { sphere = { radius = 0.1 } }\nposition = [-0.5, 2.2, 0]\n"
              "[[attachment]]\nbody_a = \"rod\"\npoint = [0, 3, 0]\n" +
                  bystanders(4),
              60);
  const Small small = shrink(folder, "contacts(rod,post) > 0");
  CHECK(small.bodies == std::vector<std::string>{"rod", "post"});
  CHECK(small.sizes("frames").first == 61);
  CHECK(small.sizes("frames").second < 5);
  CHECK(small.outcome.out.find("note:") == std::string::npos);
  if (const TomlEntry* attachments = small.scene.find("attachment")) {
    // what the world holds has not moved
    const TomlNode& point = attachments->value.items.at(0).find("point")->value;
    CHECK(std::hypot(point.items[0].as_number(), point.items[1].as_number() - 3.0, point.items[2].as_number()) < 1e-3);
  }
}

TEST_CASE("of grippers that pull a bar apart both stay, it begins with a state, since its error is one") {
  const TempFolder folder;
  make_bundle(folder, slurp(kFaults / "contradiction.toml") + bystanders(6), 20);
  const Small small = shrink(folder, "attachment_error_m > 1e-3");
  CHECK(small.sizes("attachments") == std::pair(2, 2));
  CHECK(small.sizes("bodies") == std::pair(9, 3));
  CHECK(small.sizes("frames") == std::pair(21, 2));
  CHECK(small.outcome.out.find("note: it begins with a state") != std::string::npos);
}

TEST_CASE("bodies that deform begin later with a state, and go on as they did, bit for bit") {
  const TempFolder folder;
  make_bundle(folder, slurp(kFaults / "inverted_element.toml") + bystanders(6), 10);
  const Small small = shrink(folder, "elastic_J > 0.1");
  CHECK(small.sizes("bodies").second == small.sizes("bodies").first - 6);
  CHECK(small.sizes("frames") == std::pair(11, 2));
  CHECK(small.outcome.out.find("note: it begins with a state") != std::string::npos);
  // the fault alone, from its beginning
  REQUIRE(impinge_run(folder.path(), {"run", (kFaults / "inverted_element.toml").string(), "--no-images", "--frames",
                                      "10", "--out", "o"})
              .code == 0);
  const std::string bytes = slurp(folder / "small.tar");
  folder.write("small.csv", std::string(parse_bundle("small.tar", bytes).parts.at("stats.csv")));
  const std::vector<double> whole = numbers(csv_rows(folder / "o/stats.csv"), "elastic_J"),
                            part = numbers(csv_rows(folder / "small.csv"), "elastic_J");
  const auto first = std::find_if(whole.begin(), whole.end(), [](double j) { return j > 0.1; });
  REQUIRE(first != whole.end());
  REQUIRE(part.size() == 2);
  CHECK(part[0] == *(first - 1));
  CHECK(part[1] == *first);
  // unpacked it is a run like any other, and a bundle of it carries the state on
  folder.write("more.script", "step 3\nbundle more.tar\n");
  REQUIRE(debug(folder, "small.tar", "more.script").code == 0);
  CHECK(impinge_run(folder.path(), {"replay", "more.tar"}).code == 0);
}

TEST_CASE("a body that is needed only before the state with which it begins goes too") {
  const TempFolder folder;
  // without gravity: a hammer sets a soft block going, which arrives at a wall much later
  const std::string scene = hammer_scene("-0.9") + bystanders(2);
  make_bundle(folder, scene, 60);
  const Small small = shrink(folder, "contacts(block,wall) > 0");
  INFO(small.outcome.out);
  CHECK(small.bodies == std::vector<std::string>{"block", "wall"});
  CHECK(small.frame <= 3);
  CHECK(small.outcome.out.find("note: it begins with a state") != std::string::npos);
  // it flies as the hammer left it: of 2 t at 4 m/s, which stick to 1 t or bounce off it
  const std::string bytes = slurp(folder / "small.tar");
  folder.write("small.csv", std::string(parse_bundle("small.tar", bytes).parts.at("stats.csv")));
  const double speed = numbers(csv_rows(folder / "small.csv"), "momentum_x").front() / 1000.0;
  CHECK(speed > 8.0 / 3.0 - 0.01);
  CHECK(speed < 16.0 / 3.0 + 0.01);
  // what was made small once, and begins with a state, can be made small again
  fs::rename(folder / "small.tar", folder / "b.tar");
  const Small again = shrink(folder, "contacts(block,wall) > 0", "again.tar");
  CHECK(again.bodies == small.bodies);
}

TEST_CASE("a state to which lines added bodies loses those that are not needed, and keeps what the others do") {
  const TempFolder folder;
  // without gravity: a copy of the hammer sets a soft block going, another one flies beside it; both are added by lines
  const std::string scene = hammer_scene("-9") + bystanders(1);
  const std::string script =
      "add aside like hammer at -0.9 9 0 velocity 4 0 0\nadd second like hammer at -0.9 0 0 velocity 4 0 0\nadd late "
      "like bystander_0 at 0 0 30\n";
  make_bundle(folder, scene, 60, script);
  const auto lines_of = [](const Small& small) {
    std::string lines;
    for (const TomlNode& line : small.scene.find("run")->value.find("script")->value.items) lines += line.string + "\n";
    return lines;
  };
  const Small small = shrink(folder, "contacts(block,wall) > 0");
  INFO(small.outcome.out);
  CHECK(small.outcome.out.find("note: it begins with a state") != std::string::npos);
  CHECK(small.bodies == std::vector<std::string>{"block", "wall"});
  CHECK(lines_of(small).empty());
  CHECK(small.frame <= 3);
  // of 2 t at 4 m/s, which stick to 1 t or bounce off it
  const std::string bytes = slurp(folder / "small.tar");
  folder.write("small.csv", std::string(parse_bundle("small.tar", bytes).parts.at("stats.csv")));
  const double speed = numbers(csv_rows(folder / "small.csv"), "momentum_x").front() / 1000.0;
  CHECK(speed > 8.0 / 3.0 - 0.01);
  CHECK(speed < 16.0 / 3.0 + 0.01);
  // one that the condition speaks of stays, with what it is a copy of, and goes on as fast as it went
  const Small kept = shrink(folder, "contacts(block,wall) > 0 && position_x(aside) > 2", "kept.tar");
  INFO(kept.outcome.out);
  CHECK(kept.bodies == std::vector<std::string>{"hammer", "block", "wall"});
  CHECK(lines_of(kept).find("add aside like hammer") != std::string::npos);
  CHECK(lines_of(kept).find("second") == std::string::npos);
  CHECK(lines_of(kept).find("late") == std::string::npos);
  folder.write("speed.script", "seek 0\nfind velocity_x(aside) > 3.999 && velocity_x(aside) < 4.001\n");
  CHECK(end_of(debug(folder, "kept.tar", "speed.script")).first == 0);
}

TEST_CASE("what a scene moves goes on as it was in the state of fewer bodies") {
  const TempFolder folder;
  // a hammer shoves a soft block along a lift that rises a second later
  const std::string scene = R"(
[contact]
friction = 0
[[body]]
name = "lift"
kind = "scripted"
shape = { box = { size = [40, 0.5, 4] } }
motion = [{ time = 0, position = [0, -0.75, 0] }, { time = 1, position = [0, -0.75, 0] }, { time = 2, position = [0, 0.25, 0] }, { time = 9, position = [0, 0.25, 0] }]
[[body]]
name = "block"
kind = "deformable"
shape = { box = { size = [1, 1, 1] } }
volume = { lattice = { cells = 2 } }
material = { young = 1e6, poisson = 0.3, density = 1000, damping = [0, 0.01] }
[[body]]
name = "hammer"
kind = "dynamic"
shape = { box = { size = [0.5, 0.9, 0.9] } }
material = { density = 4000 }
position = [-1, 0, 0]
velocity = [4, 0, 0]
)";
  make_bundle(folder, scene, 110);
  const Small small = shrink(folder, "position_x(block) > 2 && position_y(block) > 0.5 && position_y(lift) > -10");
  INFO(small.outcome.out);
  CHECK(small.bodies == std::vector<std::string>{"lift", "block"});
  CHECK(small.frame <= 3);
}

TEST_CASE("a shrink that is interrupted keeps the smallest bundle by then") {
  const TempFolder folder;
  make_bundle(folder, std::string(kRigid) + bystanders(60, 10.0), 120);
  const Outcome outcome = impinge_watched(
      folder.path(), {"shrink", "b.tar", "--when", "contacts > 3", "--out", "small.tar"}, [&](pid_t pid) {
        if (fs::exists(folder / "small.tar")) kill(pid, SIGINT);
      });
  CHECK(outcome.code == 130);
  CHECK(impinge_run(folder.path(), {"replay", "small.tar"}).code == 0);
}

TEST_CASE("what can't be shrunk is refused, and nothing is written") {
  const TempFolder folder;
  make_bundle(folder, kRigid, 5);
  const auto refused = [&](std::vector<std::string> words, const std::string& part) {
    words.insert(words.begin(), "shrink");
    check_refused(impinge_run(folder.path(), words), part);
    CHECK_FALSE(fs::exists(folder / "b_small.tar"));
  };
  refused({"b.tar", "--when", "contacts > 1000"}, "contacts > 1000 doesn't come true in frames 0 to 5 of the bundle; ");
  refused({"b.tar", "--when", "speed(bal) > 1"}, "--when:1:7: ");
  refused({"b.tar", "--when", "contacts >"}, "--when:1:");
  refused({"b.tar"}, "shrink without --when");
  refused({"s.toml", "--when", "contacts > 0"}, "s.toml: is no bundle");
  refused({".", "--when", "contacts > 0"}, ".: is a folder; a bundle is wanted");
  refused({"b.tar", "--when", "contacts > 0", "--out", "b.tar"}, "--out is the bundle itself");
  refused({"b.tar", "--when", "contacts > 0", "--out", "s.toml"}, "which is there and no bundle");
}
