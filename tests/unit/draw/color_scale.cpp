// Values to places on a colour bar, by formulas; and ends that contradict each other.
#include "viewer/draw/color_scale.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace impinge;

TEST_CASE("a colour bar goes evenly, by the logarithm, or both ways from zero") {
  const ColorScale linear{ScaleForm::linear, -2.0, 6.0}, log{ScaleForm::logarithmic, 1e-3, 10.0},
      diverging{ScaleForm::diverging, -4.0, 4.0};
  for (const double v : {-2.0, -1.0, 0.0, 3.5, 6.0}) CHECK(linear.place(v) == Approx((v + 2.0) / 8.0).margin(1e-15));
  for (const double v : {1e-3, 0.02, 1.0, 10.0})
    CHECK(log.place(v) == Approx((std::log10(v) + 3.0) / 4.0).margin(1e-12));
  CHECK(diverging.place(0.0) == 0.5);
  for (const double v : {0.1, 1.0, 3.9}) CHECK(diverging.place(v) - 0.5 == Approx(0.5 - diverging.place(-v)));
  for (const ColorScale& scale : {linear, log, diverging}) {
    CHECK(scale.place(scale.low) == 0.0);
    CHECK(scale.place(scale.high) == Approx(1.0));
    CHECK(scale.place(-INFINITY) == 0.0);
    CHECK(scale.place(1e300) == 1.0);
    CHECK(scale.place(NAN) == 0.0);
  }
  CHECK(log.place(0.0) == 0.0);
  CHECK(log.place(-5.0) == 0.0);
}

TEST_CASE("a colour bar tells what lies beyond its ends") {
  ColorBar bar;
  bar.scale = {ScaleForm::logarithmic, 0.1, 10.0};
  for (const double v : {0.1, 1.0, 10.0}) bar.place(v);
  CHECK_FALSE(bar.below);
  CHECK_FALSE(bar.exceeded);
  bar.place(11.0);
  CHECK(bar.exceeded);
  CHECK_FALSE(bar.below);
  bar.place(0.0);
  CHECK(bar.below);
}

TEST_CASE("the ends of a colour bar are what is set, else the frame's, however they are set one is below the other") {
  ScaleSettings own;
  CHECK(own.scale(3.2, false).form == ScaleForm::linear);
  CHECK(own.scale(3.2, false).high == Approx(5.0));
  CHECK(own.scale(3.2, false).low == 0.0);
  CHECK(own.scale(3.2, true).form == ScaleForm::diverging);
  CHECK(own.scale(3.2, true).low == Approx(-5.0));
  for (const ScaleForm form : {ScaleForm::linear, ScaleForm::logarithmic, ScaleForm::diverging})
    for (const double min : {-1e6, -1.0, 0.0, 1e-5, 0.5, 7.0, 1e9})
      for (const double max : {0.0, 1e-6, 0.5, 3.0, 1e12})
        for (const double largest : {1e-12, 0.3, 4e7}) {
          own = {form, min, max};
          const ColorScale scale = own.scale(largest, false);
          CAPTURE(min, max, largest, scale.low, scale.high);
          CHECK(scale.low < scale.high);
          CHECK(std::isfinite(scale.high - scale.low));
          if (form == ScaleForm::logarithmic) CHECK(scale.low > 0.0);
          if (form == ScaleForm::linear) CHECK(scale.low == min);
          if (max > min && max > 0.0) CHECK(scale.high == max);
        }
}
