// A moment of a session in one file: opened where nothing of the scene is left, it is the same moment.
#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/io/tar.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/debug_session.hpp"
#include "viewer/bundle/bundle.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;
namespace fs = std::filesystem;

namespace {

/// Meshes beside the scene and outside of its folder, two of one name, and tetrahedra in two files.
constexpr const char* kMeshes = R"([simulation]
substeps = 2
[scene]
allow_outside_files = true
[[body]]
name = "floor"
kind = "static"
shape = { box = { size = [3, 0.2, 3] } }
position = [0, -0.1, 0]
[[body]]
name = "near"
kind = "dynamic"
surface = "rock.off"
position = [0, 0.4, 0]
[[body]]
name = "far"
kind = "dynamic"
surface = "../elsewhere/rock.off"
position = [0.2, 2.2, 0]
[[body]]
name = "hull"
kind = "dynamic"
shape = { compound = { parts = [ { shape = { convex_hull = { surface = "rock.off" } } } ] } }
position = [-0.9, 0.2, 0.1]
[[body]]
name = "jelly"
kind = "deformable"
volume = "tets/jelly.node"
material = { young = 1e5, poisson = 0.4, density = 1000 }
position = [0.9, 1.1, 0]
[view]
backdrop = "flat"
)";

void write_scene(const TempFolder& folder) {
  folder.write("here/s.toml", kMeshes);
  folder.write("here/rock.off", off_text(tetrahedron()));
  folder.write("elsewhere/rock.off", off_text(tetrahedron()) + "# another\n");
  folder.write("here/tets/jelly.node", "4 3 0 0\n1 0 0 0\n2 0.5 0 0\n3 0 0.5 0\n4 0 0 0.5\n");
  folder.write("here/tets/jelly.ele", "1 4 0\n1 1 2 3 4\n");
}

constexpr const char* kSession = R"(at 3 set contact.friction 0.2
at 5 layer +aabbs
step 20
back 8
set simulation.gravity 0 -12 0
step 10
layer +normals
camera orbit 30 10
hide floor
panel plot +residual
panel sort bodies speed down
select body far
break when contacts > 1000
)";

struct TempDir {
  explicit TempDir(const TempFolder& folder) { setenv("TMPDIR", folder.path().c_str(), 1); }
  ~TempDir() { unsetenv("TMPDIR"); }
};

}  // namespace

TEST_CASE("a bundle opens elsewhere at the same moment: state, picture, past and future") {
  const std::string within = GENERATE("", "step stage 9\nback stage 2\n");
  CAPTURE(within);
  const TempFolder folder;
  write_scene(folder);
  folder.write("a.script", std::string(kSession) + within + "bundle b.tar\nshot here.png\n");
  const Outcome made = debug(folder, "here/s.toml", "a.script", {"--record", "made.script"});
  INFO(made.err);
  REQUIRE(made.code == 0);
  folder.write("go.script", std::string(kSession) + within + "back 15\nstep 1\nshot past.png\nseek 40\n");
  const Outcome gone_on = debug(folder, "here/s.toml", "go.script");
  // what was recorded writes the same bundle
  folder.write("again/a.script", slurp(folder / "made.script"));
  REQUIRE(debug(folder, "here/s.toml", "again/a.script", {"--out", "again"}).code == 0);
  CHECK((slurp(folder / "again/b.tar") == slurp(folder / "b.tar")));  // not printed

  const TempFolder away;
  fs::rename(folder / "b.tar", away / "b.tar");
  fs::remove_all(folder / "here"), fs::remove_all(folder / "elsewhere");
  away.write("look.script", "shot there.png\n");
  const Outcome opened = debug(away, "b.tar", "look.script", {"--record", "look.again"});
  INFO(opened.err);
  REQUIRE(opened.code == 0);
  CHECK(opened.err.empty());
  CHECK(end_of(opened) == end_of(made));
  CHECK(opened.out.substr(opened.out.find(',')) == made.out.substr(made.out.find(',')));

  // its past and its future are those that the session would have had
  away.write("go.script", "back 15\nstep 1\nseek 40\n");
  const Outcome on = debug(away, "b.tar", "go.script");
  CHECK(on.err.empty());
  CHECK(end_of(on) == end_of(gone_on));

  // and a bundle of it is the same moment once more
  away.write("more.script", "bundle c.tar\n");
  REQUIRE(debug(away, "b.tar", "more.script").code == 0);
  const std::string b = slurp(away / "b.tar"), c = slurp(away / "c.tar");
  const Bundle first = parse_bundle("b", b), second = parse_bundle("c", c);
  CHECK(second.head.frame == first.head.frame);
  CHECK(second.head.stage == first.head.stage);
  CHECK(second.head.state_hash == first.head.state_hash);
  for (const auto& [name, bytes] : first.parts) {
    CAPTURE(name);
    REQUIRE(second.parts.contains(name));
    if (name == "run.toml" || name.starts_with("meshes/") || name.starts_with("snapshots/") || name == "opening.script")
      CHECK((second.parts.at(name) == bytes));
  }
  CHECK(first.parts.size() == 5 + 2 + 1 + 4);  // texts and picture, states, frozen step, meshes

  // replayed: every state is the one that was
  const Outcome replayed = impinge_run(away.path(), {"replay", "b.tar"});
  INFO(replayed.err);
  CHECK(replayed.code == 0);
  CHECK(replayed.out ==
        fmt::format("b.tar: {} frames repeated, every state hash is the recorded one\n", first.head.frame + 1));
  // tar makes a run's folder of it
  REQUIRE(std::system(("cd " + away.path().string() + " && tar xf b.tar").c_str()) == 0);
  CHECK(impinge_run(away.path(), {"replay", "impinge-bundle"}).code == 0);
  const FrozenStep frozen = read_frozen_step(away / fmt::format("impinge-bundle/frozen/{:06}.step", first.head.frame));
  CHECK(frozen.frame == first.head.frame);
  CHECK(frozen.bodies.size() == 5);
}

TEST_CASE("what is seen when a bundle is opened is its picture") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write(
      "a.script",
      "step 12\nlayer +normals +aabbs\ncamera orbit 40 5\nhide ball\nset contact.friction 0.3\npanel filter fric\n"
      "panel sort gap down\nselect contact 0\nbundle b.tar\n");
  const Outcome made = debug(folder, "s.toml", "a.script");
  INFO(made.err);
  REQUIRE(made.code == 0);
  const std::string bytes = slurp(folder / "b.tar");
  const Bundle bundle = parse_bundle("b.tar", bytes);
  folder.write("look.script", "shot opened.png\n");
  REQUIRE(debug(folder, "b.tar", "look.script").code == 0);
  const Image seen = decode_png(bundle.parts.at("picture.png"), "picture.png"),
              opened = read_png(folder / "opened.png");
  REQUIRE(seen.width == opened.width);
  REQUIRE(seen.height == opened.height);
  // above transport, timeline and console, which know what was before
  int different = 0;
  for (int y = 0; y < seen.height * 7 / 10; ++y)
    for (int x = 0; x < seen.width; ++x)
      for (int c = 0; c < 3; ++c) different += seen.pixel(x, y)[c] != opened.pixel(x, y)[c] ? 1 : 0;
  CHECK(different == 0);
}

TEST_CASE("a bundle whose states are others is told, with exit code 1") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 12\nbundle b.tar\n");
  REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
  const std::string bytes = slurp(folder / "b.tar");
  const Bundle bundle = parse_bundle("b.tar", bytes);
  std::map<std::string, std::string> parts(bundle.parts.begin(), bundle.parts.end());
  std::string& table = parts["stats.csv"];
  const std::string hash = hex64(bundle.head.state_hash);
  table.replace(table.find(hash), 4, hash.substr(0, 4) == "0000" ? "1111" : "0000");
  folder.write("other.tar", format_bundle(bundle.head, parts));
  const Outcome outcome = impinge_run(folder.path(), {"replay", "other.tar"});
  CHECK(outcome.code == 1);
  CHECK(outcome.out.find("frame 12: state hash " + hash) != std::string::npos);
  CHECK(outcome.out.find("other.tar: 1 of 13 frames differ") != std::string::npos);

  // of another version the states are made again, not read
  BundleHead older = bundle.head;
  older.version = "0.0.1";
  folder.write("older.tar",
               format_bundle(older, std::map<std::string, std::string>(bundle.parts.begin(), bundle.parts.end())));
  folder.write("look.script", "shot x.png\n");
  const Outcome made_again = debug(folder, "older.tar", "look.script");
  CHECK(made_again.code == 0);
  CHECK(made_again.err.empty());
  CHECK(end_of(made_again) == std::pair(12, hash));
}

TEST_CASE("what is no whole bundle is refused by one message, and nothing of it is left") {
  const TempFolder folder, temporary;
  const TempDir dir(temporary);
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 3\nbundle b.tar\n");
  folder.write("look.script", "shot x.png\n");
  REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
  const std::string whole = slurp(folder / "b.tar");
  const Bundle bundle = parse_bundle("b.tar", whole);
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    folder.write("x.tar", bytes);
    check_refused(debug(folder, "x.tar", "look.script"), part);
    check_refused(impinge_run(folder.path(), {"replay", "x.tar"}), part);
    CHECK(fs::is_empty(temporary.path()));
    CHECK_FALSE(fs::exists(folder / "x.png"));
  };
  refused(whole.substr(0, 5000), "x.tar: byte ");
  refused(whole.substr(0, whole.size() - 512), "x.tar: byte ");
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] + 1);
  refused(damaged, "is damaged; a whole bundle is wanted");
  // a newer form
  std::string newer = whole;
  const std::size_t at = newer.find("form = 1");
  newer.replace(at, 8, "form = 2");
  const std::size_t end = newer.find('\0', at), begin = newer.find("hash = \"") + 8;
  newer.replace(begin, 16, hex64(hash_bytes(std::string_view(newer).substr(begin + 18, end - begin - 18))));
  refused(newer, "x.tar: is a bundle of form 2, by version");
  // parts that lead elsewhere, under names that the head agrees with
  for (const char* name : {"../outside", "/tmp/outside", "meshes/../../outside"})
    CHECK_THROWS_AS(format_bundle(bundle.head, {{"run.toml", ""}, {"stats.csv", ""}, {name, "x"}}), InputError);
  // a bundle without a scene, and one whose scene asks for what is not in it
  CHECK_THROWS_AS(parse_bundle("x", format_bundle(bundle.head, {{"stats.csv", ""}})), InputError);
  std::map<std::string, std::string> parts(bundle.parts.begin(), bundle.parts.end());
  parts["run.toml"] += "\n[[body]]\nname = \"spy\"\nkind = \"static\"\nsurface = \"/etc/passwd\"\n";
  refused(format_bundle(bundle.head, parts), "leads out of the scene's folder");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"folder = \".\"", "folder = \"/etc\""},
           {"folder = \".\"", "folder = \"..\""},
           {"folder = \".\"", "folder = \".\"\nstart = \"/etc/passwd\""},
           {"\n[simulation]", "\n[scene]\nallow_outside_files = true\n[simulation]"}}) {
    std::map<std::string, std::string> other(bundle.parts.begin(), bundle.parts.end());
    std::string& scene = other["run.toml"];
    REQUIRE(scene.find(from) != std::string::npos);
    scene.replace(scene.find(from), from.size(), to);
    refused(format_bundle(bundle.head, other), "its scene asks for files outside of it");
  }
  // some other tar, and some other file
  folder.write("other/file", "x");
  REQUIRE(std::system(("cd " + folder.path().string() + " && tar cf x.tar other && tar cf y.tar other").c_str()) == 0);
  CHECK_FALSE(is_bundle(folder / "y.tar"));
  // and what a whole one is not: a scene
  for (const char* command : {"run", "info", "check"})
    check_refused(impinge_run(folder.path(), {command, "b.tar"}), "b.tar: this is a tar, as a bundle of impinge debug");
  CHECK(debug(folder, "y.tar", "look.script").code == 2);
}

TEST_CASE("a bundle that can't be written, or whose mesh has changed, is refused at its line") {
  const TempFolder folder;
  write_scene(folder);
  folder.write("a.script", "step 2\nbundle b.txt\n");
  check_refused(debug(folder, "here/s.toml", "a.script"),
                "a.script:2:8: 'b.txt'; a file name that ends in .tar is wanted");
  folder.write("file", "");
  folder.write("a.script", "step 2\nbundle file/b.tar\n");
  check_refused(debug(folder, "here/s.toml", "a.script"), "a.script:2:1: file/b.tar can't be written");
}
