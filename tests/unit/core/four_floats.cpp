#include "engine/core/four_floats.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using impinge::FourFloats;

TEST_CASE("four floats at once are what each is by itself, to the bit", "[four_floats]") {
  alignas(16) const float a[4] = {1.5f, -2.25e-3f, 3.1e17f, 0.1f}, b[4] = {-0.3f, 7.0f, 2.9e17f, 0.1f};
  const FourFloats x = FourFloats::at(a), y = FourFloats::at(b);
  alignas(16) float result[4];
  const auto check = [&](FourFloats of, auto&& expected) {
    of.store(result);
    for (int k = 0; k < 4; ++k) CHECK(result[k] == expected(a[k], b[k]));
  };
  check(x + y, [](float l, float r) { return l + r; });
  check(x - y, [](float l, float r) { return l - r; });
  check(x * y, [](float l, float r) { return l * r; });
  check(x / y, [](float l, float r) { return l / r; });
  check(larger(x, y), [](float l, float r) { return l > r ? l : r; });
  check(magnitude(x), [](float l, float) { return std::abs(l); });
  check(square_root(magnitude(x)), [](float l, float) { return std::sqrt(std::abs(l)); });
  CHECK(is_larger(x, y) == 0b0101u);
  CHECK(is_larger(FourFloats(std::numeric_limits<float>::quiet_NaN()), x) == 0u);
  CHECK(is_larger(x, FourFloats(std::numeric_limits<float>::quiet_NaN())) == 0u);
}
