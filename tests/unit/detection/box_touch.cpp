// Two boxes whose edges cross in one point, to the last bit and a little off it: the way that NaN came into a pile.
#include <catch2/catch.hpp>

#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("edges of boxes that just touch have a finite gap and a direction") {
  const double reach = std::sqrt(0.5);
  for (const double turn : {90.0, 60.0, 17.0})
    for (int k = -40; k <= 40; ++k) {
      const double gap = k == 0 ? 0.0 : (k < 0 ? -1.0 : 1.0) * std::pow(10.0, -18.0 + 0.25 * std::abs(k));
      World world;
      BodyDescription lower = cube("lower", 1.0, {0, -reach, 0}), upper = cube("upper", 1.0, {0, reach + gap, 0});
      lower.rotation = {45, 0, 0};
      lower.kind = BodyKind::fixed;
      upper.rotation = {45, turn, 0};
      world.add_body(lower);
      world.add_body(upper);
      world.start();
      CAPTURE(turn, gap);
      REQUIRE(world.record().contacts.size() >= 1);
      for (const ContactRecord& c : world.record().contacts) {
        CHECK(c.gap == Approx(gap).margin(1e-9));
        CHECK(std::abs(c.normal.y()) == Approx(1.0).margin(1e-6));
      }
    }
}
