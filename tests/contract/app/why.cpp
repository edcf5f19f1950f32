// impinge why: each filter's verdict on a pair of bodies, held against what a formula says of the same scene.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A ball falls on a floor past a shelf that it misses; a lamp hangs from the world, a wheel from the lamp; two posts
/// stand; a soft cube lies apart; two boxes of triangles rest on the floor, touching.
constexpr const char* kScene = R"([simulation]
substeps = 2
sleep_time = 0.5
[contact]
activation_distance = 1e-3
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.1 } }
position = [0, 0.5, 0]
[[body]]
name = "shelf"
kind = "static"
shape = { box = { size = [0.2, 0.1, 0.2] } }
position = [0.25, 0.3, 0]
[[body]]
name = "post"
kind = "static"
shape = { capsule = { radius = 0.05, length = 0.5 } }
position = [3, 0.3, 0]
[[body]]
name = "block"
kind = "dynamic"
surface = "meshes/block.off"
position = [5, 0.1, 0]
[[body]]
name = "brick"
kind = "dynamic"
surface = "meshes/block.off"
position = [5.2005, 0.1, 0]
[[body]]
name = "soft"
kind = "deformable"
shape = { box = { size = [0.2, 0.2, 0.2] } }
volume = { cage = { cells = 2 } }
material = { young = 1e5, poisson = 0.3, density = 500 }
position = [7, 0.1005, 0]
[[body]]
name = "lamp"
kind = "dynamic"
shape = { sphere = { radius = 0.1 } }
position = [-2, 1, 0]
[[body]]
name = "wheel"
kind = "dynamic"
shape = { sphere = { radius = 0.1 } }
position = [-2, 0.75, 0]
[[attachment]]
name = "hook"
body_a = "lamp"
point = [-2, 1.1, 0]
[[attachment]]
name = "joint"
body_a = "lamp"
body_b = "wheel"
point = [-2, 0.9, 0]
)";

struct Files {
  TempFolder folder;
  Files() {
    folder.write("s.toml", kScene);
    folder.write("short.script", "expect contacts >= 0 at 3\n");
    folder.write("meshes/block.off", off_text(box(Vec3::Constant(0.1), {2, 2, 2})));
  }
  Outcome why(std::vector<std::string> pair, std::vector<std::string> more = {},
              const std::string& of = "s.toml") const {
    std::vector<std::string> words = {"why", of, "--pair"};
    words.insert(words.end(), pair.begin(), pair.end());
    words.insert(words.end(), more.begin(), more.end());
    Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    return outcome;
  }
};

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

/// The number after "NAME": in a JSON text, of the first place after `from`.
double number(const std::string& json, const std::string& name, const std::string& from = "") {
  std::size_t at = from.empty() ? 0 : json.find(from);
  REQUIRE(at != std::string::npos);
  at = json.find("\"" + name + "\": ", at);
  INFO(name << " in " << json);
  REQUIRE(at != std::string::npos);
  return std::stod(json.substr(at + name.size() + 4));
}

std::string line_of(const std::string& text, const std::string& label) {
  const std::size_t at = text.find("\n" + label + " ");
  INFO(label << " in " << text);
  REQUIRE(at != std::string::npos);
  return text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

}  // namespace

TEST_CASE("why says how near two shapes came and when, as falling bodies do") {
  const Files files;
  const double h = 1.0 / 120.0, g = 9.81;
  // the ball's way down, at the start of each sub-step, by the scheme v += h g, x += h v
  double y = 0.5, v = 0.0;
  std::vector<double> heights = {y, y};  // frame 0, and the start of its first sub-step
  for (int i = 0; i < 24; ++i) v -= h * g, y += h * v, heights.push_back(y);
  // of the sphere from the shelf, whose side is at x = 0.15
  double nearest = INFINITY;
  const auto distance = [](double at) {
    const double up = std::max({at - 0.35, 0.25 - at, 0.0});
    return std::hypot(0.15, up) - 0.1;
  };
  for (const double at : heights) nearest = std::min(nearest, distance(at));

  const Outcome miss = files.why({"ball", "shelf"}, {"--frame", "12", "--json"});
  CHECK(says(miss.out, "\"in_contact\": false"));
  CHECK(number(miss.out, "distance_m", "\"nearest_miss\"") == Approx(nearest).epsilon(1e-9));
  // the moment asked for is the start of frame 12's second sub-step
  CHECK(number(miss.out, "distance_m", "\"nearest\"") == Approx(distance(heights[1 + 2 * 11 + 1])).epsilon(1e-9));
  CHECK(number(miss.out, "time_s") == Approx(23 * h));
  CHECK(number(miss.out, "frame", "\"nearest_miss\"") >= 1.0);

  const Outcome first = files.why({"ball", "shelf"}, {"--frame", "3", "--substep", "1", "--json"});
  CHECK(number(first.out, "distance_m", "\"nearest\"") == Approx(distance(heights[1 + 2 * 2])).epsilon(1e-9));
  CHECK(number(first.out, "substep") == 1.0);

  const Outcome text = files.why({"shelf", "ball"}, {"--frame", "12"});  // in any order
  CHECK(says(text.out, fmt::format("never in contact in frames 0 to 12; nearest {:.4g} m apart", nearest)));
  CHECK(says(line_of(text.out, "boxes"), "stops"));
  CHECK(says(line_of(text.out, "distance"), "not asked"));
}

TEST_CASE("why follows a pair into contact") {
  const Files files;
  const Outcome start = files.why({"floor", "ball"}, {"--frame", "0", "--json"});
  CHECK(number(start.out, "distance_m", "\"nearest\"") == Approx(0.4).epsilon(1e-12));
  CHECK(number(start.out, "gap_at_rest_m") == Approx(0.4).epsilon(1e-12));
  CHECK(number(start.out, "substep") == 0.0);
  // 0.4 m take 0.286 s: frame 17 or 18
  const Outcome touch = files.why({"floor", "ball"}, {"--frame", "40", "--json"});
  CHECK(says(touch.out, "\"in_contact\": true"));
  CHECK(says(touch.out, "\"stopped_by\": null"));
  CHECK(number(touch.out, "frame", "\"first_contact\"") >= 17.0);
  CHECK(number(touch.out, "frame", "\"first_contact\"") <= 18.0);
  CHECK(std::abs(number(touch.out, "distance_m", "\"nearest\"")) < 1e-3);
  CHECK(number(touch.out, "contacts", "\"filter\": \"contacts\"") == 1.0);
  CHECK(number(touch.out, "normal_y", "\"filter\": \"contacts\"") == -1.0);  // from the ball towards the floor
  // it carries the ball's weight for a sub-step
  const double mass = 1000.0 * 4.0 / 3.0 * M_PI * 1e-3;
  CHECK(number(touch.out, "impulse_N_s") == Approx(mass * 9.81 / 120.0).epsilon(1e-6));
  // without a frame: the first contact
  const Outcome run = files.why({"floor", "ball"}, {"--json", "--script", "short.script"});
  CHECK(number(run.out, "frame") == number(touch.out, "frame", "\"first_contact\""));
}

TEST_CASE("why looks at triangles and at what deforms") {
  const Files files;
  const Outcome meshes = files.why({"block", "brick"}, {"--frame", "1", "--json"});
  CHECK(says(meshes.out, "\"in_contact\": true"));
  CHECK(number(meshes.out, "distance_m", "\"nearest\"") == Approx(5e-4).margin(1e-9));
  CHECK(std::abs(number(meshes.out, "normal_x", "\"filter\": \"distance\"") + 1.0) < 1e-9);
  CHECK(number(meshes.out, "triangle_pairs") >= 8.0);  // of each side's 8 triangles, one at least
  const Outcome soft = files.why({"floor", "soft"}, {"--frame", "1", "--json"});
  CHECK(says(soft.out, "\"in_contact\": true"));
  CHECK(number(soft.out, "distance_m", "\"nearest\"") <= 5.1e-4);
  const Outcome apart = files.why({"block", "soft"}, {"--frame", "0", "--json"});
  CHECK(number(apart.out, "distance_m", "\"nearest\"") == Approx(1.8).epsilon(1e-9));
  CHECK(says(apart.out, "\"stopped_by\": \"boxes\""));
}

TEST_CASE("why says that one mesh lies inside another") {
  const Files files;
  files.folder.write("meshes/core.off", off_text(box(Vec3::Constant(0.02))));
  files.folder.write("nested.toml", R"([[body]]
name = "outer"
kind = "static"
surface = "meshes/block.off"
[[body]]
name = "inner"
kind = "dynamic"
surface = "meshes/core.off"
position = [0.05, 0, 0]
)");
  const Outcome nested = files.why({"outer", "inner"}, {"--frame", "0"}, "nested.toml");
  INFO(nested.out);
  CHECK(says(nested.out, "in contact, 1 contact\n"));
  CHECK(says(line_of(nested.out, "candidates"), "one body lies inside the other"));
  // 0.05 m to the face and 0.02 m beyond the middle
  CHECK(says(line_of(nested.out, "contacts"), "the smallest gap is -0.07 m, normal (-1, 0, 0)"));
}

TEST_CASE("why names the filter that stops a pair") {
  const Files files;
  const auto stopped = [&](std::vector<std::string> pair, const std::string& filter,
                           std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--frame", "1"});
    const Outcome outcome = files.why(std::move(pair), more);
    INFO(outcome.out);
    CHECK(says(outcome.out, "no contact, stopped by " + filter + "\n"));
    return line_of(outcome.out, filter);
  };
  CHECK(says(stopped({"shelf", "post"}, "kind"), "a contact would move neither"));
  CHECK(says(stopped({"ball", "ball"}, "kind"), "can't meet itself"));
  CHECK(says(stopped({"soft", "soft"}, "exempt"), "self_collision of 'soft' is off"));
  CHECK(says(stopped({"soft", "soft"}, "candidates", {"--set", "body.soft.self_collision=true"}), "triangle pairs"));
  CHECK(says(stopped({"ball", "soft"}, "boxes"), "along x"));
  // both at rest on the floor for longer than simulation.sleep_time
  const Outcome sleepers = files.why({"block", "brick"}, {"--frame", "60", "--set", "simulation.sleep_time=0.1"});
  CHECK(says(line_of(sleepers.out, "asleep"), "stops"));
  CHECK(says(line_of(sleepers.out, "asleep"), "'brick' sleeps"));
  CHECK(says(sleepers.out, "contacts in"));
  // what is joined may touch all the same
  const Outcome joined = files.why({"lamp", "wheel"}, {"--frame", "1"});
  CHECK(says(line_of(joined.out, "exempt"), "passes"));
  CHECK(says(line_of(joined.out, "exempt"), "joined by 'joint'"));
}

TEST_CASE("why says of a body that is added later that it is not there yet, and sees no distance to it before") {
  const Files files;
  files.folder.write("add.script", "at 4 add late like ball at 0 0.35 1\nat 8 delete late\n");
  const auto asked = [&](int frame) {
    return files.why({"floor", "late"}, {"--script", "add.script", "--frame", std::to_string(frame)}).out;
  };
  const std::string before = asked(2), there = asked(6), after = asked(9);
  CHECK(says(before, "'late' is not there yet"));
  CHECK(!says(before, "deleted"));
  CHECK(says(before, "never in contact in frames 0 to 2\n"));
  CHECK(says(there, "'late' is dynamic"));
  CHECK(says(after, "'late' is deleted"));
  // a body of 0.1 m falls from 0.35 m: nearest is where it was last, and no frame from before it was there
  CHECK(says(after, "in frame 7"));
}

TEST_CASE("why tells of a motion that was taken back") {
  TempFolder folder;
  folder.write("s.toml", R"([simulation]
substeps = 1
gravity = [0, 0, 0]
[[body]]
name = "plate"
kind = "static"
surface = "plate.off"
[[body]]
name = "bullet"
kind = "dynamic"
surface = "cube.off"
position = [0, 1, 0]
velocity = [0, -120, 0]
# alone the two would meet in flight
[[attachment]]
kind = "slide"
body_a = "bullet"
point = [0, 1, 0]
direction = [0, 1, 0]
)");
  folder.write("plate.off", off_text(box({0.5, 0.005, 0.5}, {10, 1, 10})));
  folder.write("cube.off", off_text(box(Vec3::Constant(0.05))));
  const auto why = [&](const std::string& continuous) {
    const Outcome outcome = impinge_run(folder.path(), {"why", "s.toml", "--pair", "bullet", "plate", "--frame", "1",
                                                        "--json", "--set", "narrow_phase.continuous=" + continuous});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome.out;
  };
  // 1 m less half of the cube and half of the plate's thickness, at 120 m/s
  const std::string cut = why("auto");
  CHECK(number(cut, "time_s", "\"filter\": \"time_of_impact\"") == Approx((1.0 - 0.055) / 120.0).epsilon(0.01));
  CHECK(number(cut, "pieces") >= 2.0);
  const std::string off = why("off");
  CHECK(says(off, "\"filter\": \"time_of_impact\", \"outcome\": \"stops\""));
  CHECK(number(off, "unsafe_motions") == 1.0);
  CHECK(number(cut, "unsafe_motions") == 0.0);
  CHECK(number(off, "approach_m", "\"filter\": \"time_of_impact\"") == Approx(2.0));
  CHECK(number(off, "safe_m") == Approx(1e-3));
}

TEST_CASE("why repeats a run from its folder") {
  const Files files;
  REQUIRE(impinge_run(files.folder.path(), {"run", "s.toml", "--frames", "30", "--no-images", "--out", "o", "--set",
                                            "body.ball.position=[0,0.6,0]"})
              .code == 0);
  const Outcome run = files.why({"floor", "ball"}, {"--json"}, "o");
  CHECK(run.err.empty());
  CHECK(number(run.out, "last_frame") == 30.0);
  // 0.5 m take 0.319 s
  CHECK(number(run.out, "frame", "\"first_contact\"") >= 19.0);
  CHECK(number(run.out, "frame", "\"first_contact\"") <= 20.0);
  // the contacts of contacts.csv are those of the last sub-step
  const Outcome last = files.why({"block", "brick"}, {"--json", "--frame", "30"}, "o");
  REQUIRE(impinge_run(files.folder.path(), {"run", "o/run.toml", "--no-images", "--out", "p", "--contacts"}).code == 0);
  const std::string contacts = slurp(files.folder / "p/contacts.csv");
  int rows = 0;
  for (std::size_t at = contacts.find("\n30,block,brick,"); at != std::string::npos;
       at = contacts.find("\n30,block,brick,", at + 1))
    ++rows;
  CHECK(number(last.out, "contacts", "\"filter\": \"contacts\"") == rows);

  files.folder.write("changed/run.toml", slurp(files.folder / "o/run.toml"));
  std::string stats = slurp(files.folder / "o/stats.csv");
  files.folder.write("changed/stats.csv", stats.substr(0, stats.find("\n20,") + 1));  // a run that ended early
  const Outcome early = files.why({"floor", "ball"}, {"--json"}, "changed");
  CHECK(number(early.out, "last_frame") == 19.0);
}

TEST_CASE("why refuses what is not there, and says what is") {
  const Files files;
  REQUIRE(impinge_run(files.folder.path(), {"run", "s.toml", "--frames", "3", "--no-images", "--out", "o"}).code == 0);
  const auto refused = [&](const std::vector<std::string>& words, const std::string& what) {
    CAPTURE(words);
    std::vector<std::string> all = {"why"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome outcome = impinge_run(files.folder.path(), all);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.out.empty());
    CHECK(outcome.error_lines() == 1);
    CHECK(says(outcome.err, what));
  };
  refused({"s.toml", "--pair", "bal", "floor"},
          "--pair names 'bal', which is no body of the scene; floor, ball, shelf");
  refused({"s.toml", "--pair", "bal", "floor"}, "did you mean 'ball'?");
  refused({"s.toml", "--pair", "ball"}, "--pair");
  refused({"s.toml"}, "--pair");
  refused({"s.toml", "--pair", "ball", "floor", "--frame", "-1"}, "--frame is '-1'");
  refused({"s.toml", "--pair", "ball", "floor", "--substep", "1"}, "--substep without --frame");
  refused({"s.toml", "--pair", "ball", "floor", "--frame", "0", "--substep", "1"}, "frame 0");
  refused({"s.toml", "--pair", "ball", "floor", "--frame", "2", "--substep", "3"}, "frame 2 has sub-steps 1 to 2");
  refused({"o", "--pair", "ball", "floor", "--frame", "4"}, "frames 0 to 3");
  refused({"o", "--pair", "ball", "floor", "--set", "contact.friction=0"}, "--set with a finished run");
  refused({"meshes", "--pair", "ball", "floor"}, "no run.toml");
  refused({"nothing.toml", "--pair", "ball", "floor"}, "nothing.toml");
}

TEST_CASE("the deepest of a pair that never touches is the deepest of all its frames") {
  const TempFolder folder;
  folder.write("through.toml", R"([simulation]
substeps = 1
[[body]]
name = "shelf"
kind = "static"
shape = { box = { size = [1, 0.1, 1] } }
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.2 } }
material = { density = 500 }
position = [0, 0.5, 0]
[[attachment]]
name = "tag"
kind = "slide"
body_a = "ball"
body_b = "shelf"
point = [0, 0.5, 0]
direction = [0, 1, 0]
collide = false
)");
  const auto number_after = [](const std::string& text, const std::string& key, std::size_t from) {
    const std::size_t at = text.find(key, from);
    return at == std::string::npos ? NAN : std::stod(text.substr(at + key.size()));
  };
  double deepest = INFINITY;
  for (int frame = 10; frame <= 30; ++frame) {
    const Outcome one = impinge_run(
        folder.path(), {"why", "through.toml", "--pair", "ball", "shelf", "--frame", std::to_string(frame), "--json"});
    REQUIRE(one.code == 0);
    deepest = std::min(deepest, number_after(one.out, "\"distance_m\": ", one.out.find("\"nearest\": {")));
  }
  CHECK(deepest < -0.1);  // half the shelf and more
  const Outcome all = impinge_run(folder.path(), {"why", "through.toml", "--pair", "ball", "shelf", "--json"});
  CAPTURE(all.out);
  REQUIRE(all.code == 0);
  CHECK(number_after(all.out, "\"distance_m\": ", all.out.find("\"nearest_miss\": {")) ==
        Approx(deepest).margin(1e-12));
}
