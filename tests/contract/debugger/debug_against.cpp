// Two sessions side by side: where they part is what their runs' tables say, and neither feels the other.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// The first frame in which two runs' hashes differ, and -1.
int parted(const TempFolder& folder, int frames) {
  for (int frame = 0; frame <= frames; ++frame)
    if (hash_in(folder / "plain/stats.csv", frame) != hash_in(folder / "b/stats.csv", frame)) return frame;
  return -1;
}

}  // namespace

TEST_CASE("A and B part in the frame in which their runs do, and A is as it is alone") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 60\nback 20\nstep 5\nset contact.restitution 0.3\nstep 30\n");
  const auto run = [&](const std::string& out, const std::string& set) {
    std::vector<std::string> words = {"run", "s.toml", "--out", out, "--frames", "60", "--no-images", "--force"};
    if (!set.empty()) words.insert(words.end(), {"--set", set});
    REQUIRE(impinge_run(folder.path(), words).code == 0);
  };
  run("plain", "");
  const Outcome alone = debug(folder, "s.toml", "a.script", {});
  REQUIRE(alone.code == 0);
  int differ = 0;
  for (const std::string& set :
       {std::string("contact.friction=0.11"), std::string("simulation.substeps=3"),
        std::string("simulation.substeps=4"), std::string("body.ball.mass=7"), std::string("view.point_size=9")}) {
    CAPTURE(set);
    run("b", set);
    const int wanted = parted(folder, 60);
    const Outcome both = debug(folder, "s.toml", "a.script", {"--against", set, "--record", "r.script"});
    CAPTURE(both.out, both.err);
    REQUIRE(both.code == 0);
    CHECK(both.out.starts_with(alone.out));
    if (wanted < 0) {
      // until it is changed by hand, which B is not
      folder.write("unchanged.script", "step 60\n");
      const Outcome same = debug(folder, "s.toml", "unchanged.script", {"--against", set});
      CHECK(same.out.find(fmt::format("A and B ({}) are the same", set)) != std::string::npos);
    } else {
      CHECK(both.out.find(fmt::format("A and B ({}) differ from frame {} on: ", set, wanted)) != std::string::npos);
      CHECK(both.out.find("; first in sub-step ") != std::string::npos);
      ++differ;
    }
    CHECK(slurp(folder / "r.script").find(fmt::format("--against '{}'", set)) != std::string::npos);
    // another run's folder in place of the setting
    const Outcome with_run = debug(folder, "s.toml", "a.script", {"--against", "b"});
    CAPTURE(with_run.out);
    if (wanted >= 0)
      CHECK(with_run.out.find(fmt::format("A and B (b) differ from frame {} on", wanted)) != std::string::npos);
    // and two runs that were made before: most of A's frames are gone past
    folder.write("far.script", "step 60\n");
    const Outcome runs = debug(folder, "plain", "far.script", {"--against", "b"});
    CAPTURE(runs.out, runs.err);
    CHECK(runs.out.find(wanted < 0 ? "A and B (b) are the same"
                                   : fmt::format("A and B (b) differ from frame {} on", wanted)) != std::string::npos);
    // and what is elsewhere then has its name
    if (wanted >= 0 && both.out.find("'s position by ") != std::string::npos)
      CHECK(runs.out.find("'s position by ") != std::string::npos);
  }
  CHECK(differ >= 3);
}

TEST_CASE("what A is changed to by hand parts it from B in the next frame, and undone it doesn't") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 30\nset simulation.gravity 0 -5 0\nstep 3\n");
  const Outcome changed = debug(folder, "s.toml", "a.script", {"--against", "view.point_size=9"});
  CAPTURE(changed.out);
  CHECK(changed.out.find("differ from frame 31 on: ") != std::string::npos);
  CHECK(changed.out.find("position by ") != std::string::npos);
  folder.write("a.script", "step 30\nset simulation.gravity 0 -5 0\nstep 3\nundo\nstep 3\n");
  const Outcome undone = debug(folder, "s.toml", "a.script", {"--against", "view.point_size=9"});
  CAPTURE(undone.out);
  CHECK(undone.out.find("are the same") != std::string::npos);
}

TEST_CASE("B is seen through where it is elsewhere, in every frame that is gone to") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "step 4\nshot early.png\nstep 56\nshot late.png\nback 56\nshot again.png\nseek 60\nshot end.png\n");
  REQUIRE(debug(folder, "s.toml", "a.script", {"--out", "one"}).code == 0);
  REQUIRE(debug(folder, "s.toml", "a.script", {"--out", "two", "--against", "contact.restitution=0.7"}).code == 0);
  const auto view = [&](const char* name) {  // without the panels
    const Image whole = read_png(folder.path() / name);
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < 400; ++y)
      pixels.insert(pixels.end(), whole.pixel(240, y), whole.pixel(240, y) + 3 * (whole.width - 520));
    return pixels;
  };
  CHECK((view("one/early.png") == view("two/early.png")));  // nothing has touched anything
  CHECK((view("one/late.png") != view("two/late.png")));
  CHECK((view("two/again.png") == view("two/early.png")));
  CHECK((view("two/end.png") == view("two/late.png")));
}

TEST_CASE("what B can't be is refused with its place") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 2\n");
  for (const char* wrong : {"nothing.toml", "contact.frictio=0.1", "contact.friction=much"}) {
    const Outcome outcome = debug(folder, "s.toml", "a.script", {"--against", wrong});
    CAPTURE(wrong, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
  }
}

TEST_CASE("a deformable body of B is seen through where it is elsewhere, and not where it is the same") {
  const TempFolder folder;
  folder.write("s.toml", R"([simulation]
substeps = 2
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [0.6, 0.6, 0.6] } }
volume = { lattice = { cells = 3 } }
material = { young = 2e4, density = 400 }
position = [0, 0.5, 0]
[view]
backdrop = "flat"
[view.camera]
eye = [0, 0.7, 3]
target = [0, 0.3, 0]
)");
  folder.write("a.script",
               "step 3\nshot early.png\nstep 27\nshot late.png\nback 27\nshot again.png\nseek 30\nshot end.png\n");
  REQUIRE(debug(folder, "s.toml", "a.script", {"--out", "one"}).code == 0);
  REQUIRE(debug(folder, "s.toml", "a.script", {"--out", "two", "--against", "body.jelly.material.young=5e3"}).code ==
          0);
  const auto magenta = [&](const char* name) {
    const Image whole = read_png(folder.path() / name);
    int count = 0;
    for (int y = 0; y < 400; ++y)
      for (int x = 240; x < whole.width - 280; ++x) {
        const std::uint8_t* p = whole.pixel(x, y);
        count += p[0] > p[1] + 40 && p[2] > p[1] + 40;
      }
    return count;
  };
  CHECK(magenta("one/late.png") == 0);
  CHECK(magenta("two/early.png") == 0);  // it falls: both are the same
  CHECK(magenta("two/late.png") > 200);
  CHECK(magenta("two/again.png") == 0);
  CHECK(magenta("two/end.png") == magenta("two/late.png"));
}

TEST_CASE("where the first difference is of no position, the first frame with one is told too") {
  const TempFolder folder;
  folder.write("s.toml", R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
position = [0, 0.25, 0]
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.3 } }
position = [0.2, 4, 0.1]
)");
  // how long something has been at rest is kept in a state; where it is, is another matter until it sleeps
  folder.write("a.script", "step 90\n");
  const Outcome both =
      debug(folder, "s.toml", "a.script",
            {"--against", "simulation.sleeping=false", "--set", "simulation.sleeping=true", "--answers"});
  CAPTURE(both.out);
  REQUIRE(both.code == 0);
  const std::size_t first = both.out.find("differ from frame "), apart = both.out.find("positions differ from frame ");
  REQUIRE(first != std::string::npos);
  CHECK(both.out.find("no position or velocity yet") != std::string::npos);
  REQUIRE(apart != std::string::npos);
  const int frame = std::stoi(both.out.substr(apart + 28));
  CHECK(frame > std::stoi(both.out.substr(first + 18)));
  // the first: told by two runs' poses
  const auto pose_rows = [&](const std::string& sleeping) {
    REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "o", "--frames", "90", "--no-images", "--force",
                                        "--set", "simulation.sleeping=" + sleeping, "--export", "poses.csv"})
                .code == 0);
    std::map<int, std::string> by_frame;
    std::istringstream rows(slurp(folder / "o/export/poses.csv"));
    std::string line;
    std::getline(rows, line);
    while (std::getline(rows, line)) {
      std::vector<std::string> cells;
      std::istringstream in(line);
      for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
      by_frame[std::stoi(cells[0])] += cells[16] + cells[17] + cells[18] + " ";  // the centre
    }
    return by_frame;
  };
  const auto with = pose_rows("true"), without = pose_rows("false");
  int wanted = 0;
  while (with.at(wanted) == without.at(wanted)) ++wanted;
  CHECK(frame == wanted);
}
