// impinge compare: the frame, body and field in which two runs part, planted at a known place.
#include <catch2/catch.hpp>

#include "tests/support/pictures/picture_scene.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "left"
kind = "dynamic"
shape = { box = { size = [0.4, 0.4, 0.4] } }
position = [-2, 0.2, 0]
[[body]]
name = "right"
kind = "dynamic"
shape = { sphere = { radius = 0.2 } }
position = [2, 1, 0]
[[body]]
name = "beam"
kind = "deformable"
shape = { box = { size = [0.6, 0.12, 0.12] } }
volume = { lattice = { cells = 4 } }
material = { young = 1e5, poisson = 0.4, damping = [0, 0.01] }
position = [0, 3, 0]
)";

struct Runs {
  TempFolder folder;
  Runs() { folder.write("s.toml", kScene); }
  void run(const std::string& out, const std::string& script = "", const std::vector<std::string>& more = {}) const {
    folder.write("now.script", script);
    REQUIRE(told(folder, {"run", "s.toml", "--script", "now.script", "--out", out, "--frames", "25", "--quiet"}, more)
                .code == 0);
  }
  Outcome compare(const std::vector<std::string>& words) const { return told(folder, {"compare"}, words); }
};

const std::vector<std::string> kNoImages = {"--no-images"};

}  // namespace

TEST_CASE("two runs of the same scene have the same states, in any number of threads") {
  const Runs runs;
  runs.run("a", "", kNoImages);
  runs.run("b", "", {"--no-images", "--threads", "2"});
  const Outcome outcome = runs.compare({"a", "b"});
  CHECK(outcome.code == 0);
  CHECK(holds(outcome.out, "states: 26 frames compared, every state hash is the same"));
}

TEST_CASE("the first frame, the body and the field that differ are those that were changed") {
  const Runs runs;
  runs.run("a", "", kNoImages);
  for (const int frame : {1, 9, 10, 17, 21}) {
    // in free fall nothing but this body is touched
    const std::string b = fmt::format("b{}", frame);
    runs.run(b, fmt::format("at {} set body.right.angular_velocity 0 0.5 0\n", frame), kNoImages);
    const Outcome outcome = runs.compare({"a", b});
    CHECK(outcome.code == 1);
    CHECK(holds(outcome.out,
                fmt::format("script: at {} set body.right.angular_velocity 0 0.5 0: (none) in A, there in B", frame)));
    CHECK(holds(outcome.out, fmt::format("the first that differs is frame {} of 26", frame)));
    CHECK(holds(outcome.out, "body:   right: rotation by "));
    CHECK(holds(outcome.out, ", angular velocity by 0.5 rad/s"));
    CHECK_FALSE(holds(outcome.out, "left"));
    CHECK_FALSE(holds(outcome.out, "beam"));
    CHECK_FALSE(holds(outcome.out, "right: position"));
  }
  runs.run("soft", "at 12 set body.beam.material.young 2e5\n", kNoImages);
  const Outcome soft = runs.compare({"a", "soft"});
  CHECK(soft.code == 1);
  CHECK(holds(soft.out, "body:   beam: position by "));
  CHECK(holds(soft.out, " at node "));
  CHECK_FALSE(holds(soft.out, "right"));
}

TEST_CASE("what was set differently comes first, a distance that a formula gives is found") {
  const Runs runs;
  runs.run("a", "", kNoImages);
  runs.run("b", "", {"--no-images", "--set", "body.right.velocity=[0,0,3]"});
  const Outcome outcome = runs.compare({"a", "b", "--out", "cmp"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "settings: 1 differs\n  body.right.velocity: (none) in A, [0"));
  CHECK(holds(outcome.out, "the first that differs is frame 0 of 26"));
  CHECK(holds(outcome.out, "body:   right: velocity by 3 m/s"));
  CHECK(holds(outcome.out, "sheet:  none: a has no picture of frame 0"));
  // nothing touches it for twenty frames: 3 m/s times 20/60 s
  const std::string csv = slurp(runs.folder / "cmp/difference.csv");
  std::istringstream lines(csv);
  std::string line;
  double at_20 = 0.0;
  while (std::getline(lines, line))
    if (line.rfind("20,", 0) == 0) {
      std::istringstream cells(line);
      std::string cell;
      for (int k = 0; k < 5; ++k) std::getline(cells, cell, ',');
      at_20 = std::stod(cell);
    }
  CHECK(at_20 == Approx(1.0).epsilon(1e-9));
  CHECK(read_png(runs.folder / "cmp/difference.png").width == 1280);
}

TEST_CASE("the sheet shows A, B and what differs, bodies of one run alone are named") {
  const Runs runs;
  runs.run("a", "", {"--size", "320x180"});
  runs.folder.write("s.toml", std::string(kScene) +
                                  "[[body]]\nname = \"extra\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.3 } "
                                  "}\nposition = [0, 1, 1]\n");
  runs.run("b", "", {"--size", "320x180"});
  const Outcome outcome = runs.compare({"a", "b", "--out", "cmp"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "body:   extra (only in B)"));
  CHECK(read_png(runs.folder / "cmp/sheet.png").width == 3 * 320 + 4 * 10);
}

TEST_CASE("a comparison that can't be written whole leaves the one before as it was") {
  const Runs runs;
  runs.run("a", "");
  runs.run("b", "at 9 set body.right.angular_velocity 0 0.5 0\n");
  REQUIRE(runs.compare({"a", "b", "--out", "cmp"}).code == 1);
  const std::string before = slurp(runs.folder / "cmp/difference.csv");
  REQUIRE(!before.empty());
  runs.run("c", "at 5 set body.right.angular_velocity 0 1 0\n");
  fs::remove(runs.folder / "cmp/sheet.png");
  fs::create_directory(runs.folder / "cmp/sheet.png");
  const std::vector<std::string> names = listing(runs.folder / "cmp");
  const Outcome outcome = runs.compare({"a", "c", "--out", "cmp"});
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(holds(outcome.err, "cmp/sheet.png: can't be written (Is a directory)"));
  CHECK(slurp(runs.folder / "cmp/difference.csv") == before);
  CHECK(listing(runs.folder / "cmp") == names);
}

TEST_CASE("folders that are no runs are refused") {
  const Runs runs;
  runs.run("a", "", kNoImages);
  const TempFolder& folder = runs.folder;
  check_refused(folder, {"compare", "a", "nowhere"}, "nowhere: there is no such folder", "check the path");
  folder.write("bare/run.toml", kScene);
  check_refused(folder, {"compare", "bare", "a"}, "bare/run.toml: has no table [run]", "that a run wrote");
  folder.write("file", "");
  check_refused(folder, {"compare", "a", "a", "--out", "file"}, "file: can't be made", "choose another --out");
  // a damaged table
  fs::copy(folder / "a", folder / "cut", fs::copy_options::recursive);
  folder.write("cut/stats.csv", "frame\n");
  check_refused(folder, {"compare", "a", "cut"}, "cut/stats.csv:1:1: ", "another header");
}
