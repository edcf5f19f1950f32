// splitmix64: small, seeded, the same numbers on every platform. Print the seed with a failure.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/core/types.hpp"

namespace impinge::test {

struct Random {
  std::uint64_t state;
  explicit Random(std::uint64_t seed) : state(seed) {}
  std::uint64_t next() {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double u() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  ///< in [0, 1)
  double sym() { return 2.0 * u() - 1.0; }                              ///< in [-1, 1)
  double in(double lo, double hi) { return lo + (hi - lo) * u(); }
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  Vec3 vector() {
    const double x = sym(), y = sym(), z = sym();
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = vector();
      const double n = v.norm();
      if (n > 0.1 && n < 1.0) return v / n;
    }
  }
  Mat3 rotation() {
    const Vec3 axis = direction();
    return Eigen::AngleAxisd(in(0.0, 2.0 * M_PI), axis).toRotationMatrix();
  }
};

}  // namespace impinge::test
