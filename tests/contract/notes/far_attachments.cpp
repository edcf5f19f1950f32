// What impinge check says of an attachment whose point stands in another unit than its body.
#include "tests/support/program/traps.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("preflight: a point in centimetres is far from the body that it holds, and said to be") {
  const TempFolder folder;
  check_trap(
      folder,
      {"a hinge in centimetres",
       "far-attachment",
       body("crate", "shape = { box = { size = [1, 1, 1] } }\nmaterial = { density = 500 }\nposition = [0, 1, 0]") +
           "[[attachment]]\nname = \"hinge\"\nbody_a = \"crate\"\npoint = [0, 91, 0]\n",
       {"'hinge'", "'crate'", "104 times"},
       "its point ",
       90.0});
}

TEST_CASE(
    "preflight: an arm of ten times a body's reach is none too far, and what a line or a fixed body carries may be") {
  const TempFolder folder;
  const auto scene = [](double away, const std::string& more) {
    return ball("bob", 0.1, {0, 5, 0}) +
           body("post", "shape = { sphere = { radius = 0.01 } }\nposition = [9, 9, 9]", "static") +
           fmt::format("[[attachment]]\nname = \"arm\"\nbody_a = \"bob\"\npoint = [0, {}, 0]\n{}", 5.0 + away, more);
  };
  const auto warned = [&](double away, const std::string& more = "") {
    folder.write("s.toml", scene(away, more));
    const Outcome outcome = impinge_run(folder.path(), {"check", "s.toml"});
    CAPTURE(outcome.out, outcome.err);
    REQUIRE(outcome.code == 0);
    return warnings_in(outcome.out).count("far-attachment");
  };
  CHECK(warned(0.99) == 0);
  CHECK(warned(1.01) == 1);
  CHECK(warned(0.5, "body_b = \"post\"\n") == 0);
  CHECK(warned(1.01, "kind = \"slide\"\ndirection = [0, 1, 0]\n") == 1);  // once, though it has two rows
}
