#include "engine/geometry/exact_separation.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/expansion.hpp"

namespace impinge {
namespace {

using ExactVec3 = std::array<Expansion, 3>;

/// Of coordinates: within these the errors of a product of three are doubles too.
constexpr double kSmallest = 0x1p-200, kLargest = 0x1p200;

ExactVec3 from_to(const Vec3& b, const Vec3& a) {
  return {difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z())};
}

ExactVec3 cross(const ExactVec3& a, const ExactVec3& b) {
  ExactVec3 product;
  for (int k = 0; k < 3; ++k) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    add_product(product[k], a[u], b[v], 1.0);
    add_product(product[k], a[v], b[u], -1.0);
    std::erase(product[k], 0.0);
  }
  return product;
}

int sign_of_dot(const ExactVec3& a, const ExactVec3& b) {
  Expansion sum;
  for (int k = 0; k < 3; ++k) add_product(sum, a[k], b[k], 1.0);
  return sign_of(sum);
}

/// From each corner of the second feature to each of the first, at start and end. At every moment between, and for every
/// two points of the features, the vector is a mean of these.
std::vector<ExactVec3> between(const MovingCorners& corners, int of_first) {
  std::vector<ExactVec3> all;
  for (const auto* p : {&corners.start, &corners.end})
    for (int i = 0; i < of_first; ++i)
      for (int j = of_first; j < 4; ++j) all.push_back(from_to((*p)[j], (*p)[i]));
  return all;
}

double nearest(const Expansion& e) {
  double sum = 0.0;
  for (const double x : e) sum += x;
  return sum;
}
Vec3 nearest(const ExactVec3& v) { return {nearest(v[0]), nearest(v[1]), nearest(v[2])}; }

/// Whether rounding might hide that all are on one side; most directions are out here, without exact products.
bool may_be_on_one_side(const Vec3& normal, const std::vector<Vec3>& all, double size) {
  const double rounding = 1e-14 * size * size * size;
  double low = INFINITY, high = -INFINITY;
  for (const Vec3& d : all) low = std::min(low, normal.dot(d)), high = std::max(high, normal.dot(d));
  return low > -rounding || high < rounding;
}

bool are_on_one_side(const ExactVec3& normal, const std::vector<ExactVec3>& all) {
  const int side = sign_of_dot(normal, all.front());
  if (side == 0) return false;
  return std::all_of(all.begin() + 1, all.end(), [&](const ExactVec3& d) { return sign_of_dot(normal, d) == side; });
}

bool is_in_range(double x) { return x == 0.0 || (std::abs(x) > kSmallest && std::abs(x) < kLargest); }

bool are_apart(const MovingCorners& corners, int of_first) {
  for (const auto* p : {&corners.start, &corners.end})
    for (const Vec3& x : *p)
      if (!is_in_range(x.x()) || !is_in_range(x.y()) || !is_in_range(x.z())) return false;
  const std::vector<ExactVec3> all = between(corners, of_first);
  for (int k = 0; k < 3; ++k) {
    ExactVec3 axis;
    axis[k] = {1.0};
    if (are_on_one_side(axis, all)) return true;
  }
  std::vector<ExactVec3> along;
  for (const auto* p : {&corners.start, &corners.end})
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) along.push_back(from_to((*p)[j], (*p)[i]));
  for (int i = 0; i < 4; ++i) along.push_back(from_to(corners.start[i], corners.end[i]));
  std::vector<Vec3> near_all, near_along;
  double size = 0.0;
  for (const ExactVec3& d : all) near_all.push_back(nearest(d)), size = std::max(size, near_all.back().norm());
  for (const ExactVec3& d : along) near_along.push_back(nearest(d)), size = std::max(size, near_along.back().norm());
  for (std::size_t i = 0; i < along.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (may_be_on_one_side(near_along[i].cross(near_along[j]), near_all, size) &&
          are_on_one_side(cross(along[i], along[j]), all))
        return true;
  return false;
}

}  // namespace

bool is_vertex_kept_off_face(const MovingCorners& corners) { return are_apart(corners, 1); }
bool are_edges_kept_apart(const MovingCorners& corners) { return are_apart(corners, 2); }

}  // namespace impinge
