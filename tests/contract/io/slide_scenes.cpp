// Attachments that slide, through the program: what is refused and where, and that runs are repeated, resumed and frozen.
#include <catch2/catch.hpp>

#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kScene = R"([simulation]
substeps = 2
[[body]]
name = "ball"
kind = "static"
shape = { sphere = { radius = 0.5 } }
[[body]]
name = "bead"
kind = "dynamic"
shape = { box = { size = [0.1, 0.1, 0.1] } }
position = [0.5, 0, 0]
[[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [0.2, 0.2, 0.2] } }
volume = { lattice = { cells = 2 } }
position = [2, 0, 0]
[[attachment]]
)";

void check_refused_slide(const std::string& keys, const std::string& place, const std::string& contains) {
  static const TempFolder folder;
  folder.write("s.toml", kScene + keys);
  check_refused(folder, {"check", "s.toml"}, "s.toml:" + place + ": ", contains);
}

/// Slides of every kind, on every kind of body.
constexpr const char* kAllKinds = R"(name = "on_ball"
kind = "slide"
body_a = "bead"
body_b = "ball"
point = [0.5, 0, 0]
on = "surface"
collide = false
[[attachment]]
name = "rail"
kind = "slide"
body_a = "jelly"
point = [2, 0.1, 0]
direction = [3, -1, 0]
[[body]]
name = "arm"
kind = "scripted"
shape = { box = { size = [0.5, 0.02, 0.02] } }
position = [0, 2, 0]
motion = [ { time = 0 }, { time = 1, rotation = [0, 90, 0] } ]
[[body]]
name = "puck"
kind = "dynamic"
shape = { sphere = { radius = 0.05 } }
position = [0.1, 2.1, 0]
[[attachment]]
name = "in_plane"
kind = "slide"
body_a = "puck"
body_b = "arm"
point = [0.1, 2.1, 0.05]
normal = [0, 1, 0.1]
[[body]]
name = "rider"
kind = "dynamic"
shape = { sphere = { radius = 0.03 } }
position = [2.02, 0.1, 0.03]
[[attachment]]
name = "on_jelly"
kind = "slide"
body_a = "rider"
body_b = "jelly"
point = [2.02, 0.1, 0.03]
on = "surface"
collide = false
)";

}  // namespace

TEST_CASE("slides that say too little, too much or nonsense are refused at the right place") {
  const std::string ends = "body_a = \"bead\"\nbody_b = \"ball\"\npoint = [0.5, 0, 0]\n";
  const std::string kind = "kind = \"slide\"\n";
  check_refused_slide("kind = \"slid\"\n" + ends, "19:8", "did you mean 'slide'?");
  check_refused_slide("kind = 3\n" + ends, "19:8", "a text is wanted");
  check_refused_slide(kind + ends, "19:8",
                      "direction = [x, y, z] (along a line), normal = [x, y, z] (in a plane) or on");
  check_refused_slide(kind + ends + "direction = [1, 0, 0]\nnormal = [0, 1, 0]\n", "24:1", "normal beside direction");
  check_refused_slide(kind + ends + "on = \"surface\"\ndirection = [1, 0, 0]\n", "24:1", "direction beside on");
  check_refused_slide(kind + ends + "direction = [0, 0, 0]\n", "23:13", "direction has no length");
  check_refused_slide(kind + ends + "normal = [0, 0, 0]\n", "23:10", "normal has no length");
  check_refused_slide(kind + ends + "direction = [1, 0]\n", "23:13", "[x, y, z]");
  check_refused_slide(kind + ends + "direction = [1, 0, nan]\n", "23:20", "nan");
  check_refused_slide(kind + ends + "on = \"edge\"\n", "23:6", "\"surface\", that of body_b");
  check_refused_slide(kind + ends + "axis = [1, 0, 0]\n", "23:1", "allowed: ");
  check_refused_slide(kind + "body_a = \"bead\"\npoint = [0.5, 0, 0]\non = \"surface\"\n", "22:1", "has no body_b");
  check_refused_slide(kind + "body_a = \"bead\"\npoint = [0.5, 0, 0]\ndirection = [1, 0, 0]\ncollide = false\n", "23:1",
                      "collide, but no body_b");
  check_refused_slide(kind + ends + "direction = [1, 0, 0]\ncollide = 1\n", "24:11", "true or false");
  check_refused_slide(kind + "body_a = \"bead\"\nbody_b = \"jelly\"\npoint = [0.5, 0, 0]\ndirection = [1, 0, 0]\n",
                      "18:1", "outside of the deformable body 'jelly'");
  for (const char* key : {"direction = [1, 0, 0]\n", "normal = [1, 0, 0]\n", "on = \"surface\"\n"}) {
    check_refused_slide(ends + key, "22:1", "but its kind is \"point\"");
    check_refused_slide("kind = \"point\"\n" + ends + key, "23:1", "add kind = \"slide\"");
  }
}

TEST_CASE("a scene of slides is told in words, repeated, resumed, frozen and solved by every method") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kScene) + kAllKinds);
  const auto run = [&](std::vector<std::string> words) {
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    return outcome.out;
  };
  run({"check", "s.toml"});
  CHECK(run({"info", "s.toml"})
            .find("1 sliding on a line, two bilateral rows each; 1 in a plane, one bilateral row "
                  "each; 2 on a surface, one bilateral row each") != std::string::npos);
  run({"run", "s.toml", "--out", "whole", "--frames", "40", "--no-images", "--freeze", "20", "--quiet"});
  run({"replay", "whole"});
  run({"run", "s.toml", "--out", "parts", "--frames", "25", "--no-images", "--quiet"});
  run({"run", "s.toml", "--out", "parts", "--frames", "40", "--no-images", "--quiet", "--resume"});
  run({"compare", "whole", "parts"});
  run({"step", "whole/frozen/000020.step", "--out", "step"});
  CHECK(run({"why", "s.toml", "--pair", "bead", "ball", "--frame", "3"})
            .find("joined by 'on_ball', which exempts the pair") != std::string::npos);
  const std::string stats = slurp(folder / "whole/stats.csv");
  CHECK(stats.substr(0, stats.find('\n')).find(",attachment_error_m") != std::string::npos);
}
