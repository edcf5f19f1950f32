#include "engine/geometry/expansion.hpp"

#include <cmath>

namespace impinge {

void grow(Expansion& e, double x) {
  for (double& component : e) {  // each partial sum leaves its rounding error behind
    const double sum = x + component, part = sum - x;
    const double error = (x - (sum - part)) + (component - part);
    component = error;
    x = sum;
  }
  e.push_back(x);
}

Expansion difference(double a, double b) {
  Expansion e{a};
  grow(e, -b);
  return e;
}

void add_product(Expansion& sum, const Expansion& e, const Expansion& f, double sign) {
  for (const double x : e)
    for (const double y : f) {
      const double high = x * y, low = std::fma(x, y, -high);
      grow(sum, sign * low);
      grow(sum, sign * high);
    }
}

int sign_of(const Expansion& e) {
  for (auto it = e.rbegin(); it != e.rend(); ++it)
    if (*it != 0.0) return *it > 0.0 ? 1 : -1;
  return 0;
}

}  // namespace impinge
