#include "engine/geometry/surface/surface_side.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/inside.hpp"

namespace impinge {
namespace {

constexpr double kOnSurface = 1e-10;  // of the surface's size
constexpr double kWhole = 1e-6;       // how near to a whole number the solid angles must add up

/// Turns an odd direction into z.
const Mat3& turn() {
  static const Mat3 rotation =
      (Eigen::AngleAxisd(0.6180339887498949, Vec3::UnitX()) * Eigen::AngleAxisd(1.3247179572447460, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.2360679774997897, Vec3::UnitZ()))
          .toRotationMatrix();
  return rotation;
}

/// Twice the signed area of a, b, p seen along z.
double side(const Vec3& a, const Vec3& b, const Vec3& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

}  // namespace

SurfaceSide::SurfaceSide(std::span<const Vec3> vertices, std::vector<Triangle> triangles)
    : vertices_(vertices), triangles_(std::move(triangles)) {
  Aabb bounds;
  for (const Triangle& t : triangles_)
    for (const int v : t) bounds.include(vertices_[v]);
  origin_ = bounds.center();
  turned_.reserve(triangles_.size());
  for (const Triangle& t : triangles_) {
    const auto turned = [&](int v) -> Vec3 { return turn() * (vertices_[v] - origin_); };
    turned_.push_back({turned(t[0]), turned(t[1]), turned(t[2])});
    for (const Vec3& x : turned_.back()) box_.include(x);
  }
  cells_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(triangles_.size()))), 1, 2048);
  begin_.assign(static_cast<std::size_t>(cells_) * cells_ + 1, 0);
  std::vector<int> cursor;
  for (const bool count : {true, false}) {
    for (std::size_t t = 0; t < turned_.size(); ++t) {
      Aabb box;
      for (const Vec3& x : turned_[t]) box.include(x);
      for (int j = cell_of(1, box.min.y()); j <= cell_of(1, box.max.y()); ++j)
        for (int i = cell_of(0, box.min.x()); i <= cell_of(0, box.max.x()); ++i) {
          const std::size_t c = static_cast<std::size_t>(j) * cells_ + i;
          if (count)
            ++begin_[c + 1];
          else
            member_[cursor[c]++] = static_cast<int>(t);
        }
    }
    if (!count) break;
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    member_.resize(begin_.back());
    cursor.assign(begin_.begin(), begin_.end() - 1);
  }
}

int SurfaceSide::cell_of(int axis, double value) const {
  const double extent = std::max(box_.max[axis] - box_.min[axis], 1e-300);
  return std::clamp(static_cast<int>((value - box_.min[axis]) / extent * cells_), 0, cells_ - 1);
}

std::optional<int> SurfaceSide::winding(const Vec3& x) const {
  const double size = box_.extent().maxCoeff(), reach = kOnSurface * size;
  const Vec3 p = turn() * (x - origin_);
  for (int k = 0; k < 3; ++k)
    if (p[k] < box_.min[k] - reach || p[k] > box_.max[k] + reach) return 0;
  const std::size_t cell = static_cast<std::size_t>(cell_of(1, p.y())) * cells_ + cell_of(0, p.x());
  const double unsure = 16.0 * 2.3e-16 * size;  // rounding of turned coordinates
  int sum = 0;
  for (int m = begin_[cell]; m < begin_[cell + 1]; ++m) {
    const auto& [a, b, c] = turned_[member_[m]];
    const double ab = side(a, b, p), bc = side(b, c, p), ca = side(c, a, p);
    const double slack = unsure * ((b - a).cwiseAbs().sum() + (c - b).cwiseAbs().sum());
    const bool left = ab > -slack && bc > -slack && ca > -slack, right = ab < slack && bc < slack && ca < slack;
    if (!left && !right) continue;
    if (std::min({std::abs(ab), std::abs(bc), std::abs(ca)}) <= slack) {
      // the ray passes the triangle's edge: it counts or doesn't by rounding
      const double number = winding_number(x, vertices_, triangles_);
      if (!(std::abs(number - std::round(number)) < kWhole)) return std::nullopt;
      return static_cast<int>(std::round(number));
    }
    const Vec3 normal = (b - a).cross(c - a);
    const double height = normal.dot(a - p) / normal.z();  // of the triangle above p
    if (std::abs(normal.dot(a - p)) <= reach * normal.norm()) return std::nullopt;
    if (height > 0.0) sum += left ? 1 : -1;
  }
  return sum;
}

}  // namespace impinge
