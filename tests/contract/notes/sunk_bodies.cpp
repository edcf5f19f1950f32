// What a run says without a judge of bodies that its own contacts show deep in one another.
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A soft ball pressed into a plate that is much softer and no thicker than the ball's radius: nothing passes.
std::string press(const char* young) {
  return std::string(R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "plate"
kind = "deformable"
shape = { box = { size = [0.8, 0.25, 0.5] } }
volume = { lattice = { cells = 2 } }
material = { model = "corotational", young = )") +
         young + R"(, poisson = 0.0, density = 20, damping = [0, 0.0] }
position = [0, 0.126, 0]
[[body]]
name = "ball"
kind = "deformable"
shape = { sphere = { radius = 0.4 } }
volume = { cage = { cells = 4 } }
mass = 122.324
material = { model = "stvk", young = 900000, poisson = 0, damping = [0, 0.005] }
position = [0.02, 0.671, 0.01]
)";
}

Outcome run(const std::string& scene, const std::vector<std::string>& more) {
  const TempFolder folder;
  folder.write("s.toml", scene);
  std::vector<std::string> words = {"run", "s.toml", "--frames", "50", "--no-images", "--out", "o"};
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

}  // namespace

TEST_CASE("bodies that are crushed into one another are named without a judge, and end a strict run") {
  const Outcome deep = run(press("3000"), {"--strict"});
  CAPTURE(deep.out, deep.err);
  CHECK(deep.code == 1);
  CHECK(deep.out.find("watch:    'plate' and 'ball' overlap by 0.") != std::string::npos);
  CHECK(deep.out.find("% of 0.25 m, in frame ") != std::string::npos);
  // the judge, who goes by vertices and edges, agrees
  const Outcome judged = run(press("3000"), {"--judge"});
  CHECK(judged.out.find("judge:    'plate' and 'ball' overlap by 0.") != std::string::npos);
  CHECK(judged.out.find("watch:") == std::string::npos);
  const Outcome stiff = run(press("3e6"), {"--strict"});
  CAPTURE(stiff.out, stiff.err);
  CHECK(stiff.code == 0);
  CHECK(stiff.out.find("watch:") == std::string::npos);
}
