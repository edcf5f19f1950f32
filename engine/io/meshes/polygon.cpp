#include "engine/io/meshes/polygon.hpp"

#include <algorithm>

namespace impinge {
namespace {

constexpr std::size_t kMostEars = 4096;  // corners; finding ears takes the square of them

void append_fan(const std::vector<int>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

class Polygon {
 public:
  Polygon(const std::vector<int>& corners, const std::vector<Vec3>& vertices) : corners_(corners) {
    const Vec3& origin = vertices[corners[0]];
    for (const int v : corners) points_.push_back(vertices[v] - origin);
    for (std::size_t i = 0; i < points_.size(); ++i)
      normal_ += points_[i].cross(points_[(i + 1) % points_.size()]);  // twice its area, as seen along each axis
  }

  bool is_fan() const {
    for (std::size_t i = 2; i < points_.size(); ++i)
      if (turn(0, i - 1, i) < 0.0) return false;
    return true;
  }

  void cut_ears(std::vector<Triangle>& triangles) {
    left_.resize(points_.size());
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = i;
    std::size_t at = 0, tried = 0;
    while (left_.size() > 3) {
      const std::size_t n = left_.size(), a = left_[(at + n - 1) % n], b = left_[at % n], c = left_[(at + 1) % n];
      // where nothing is an ear the polygon crosses itself: any triangle is as good as another
      if (is_ear(a, b, c) || tried > n) {
        triangles.push_back({corners_[a], corners_[b], corners_[c]});
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at % n));
        at = at % n == 0 ? 0 : at % n - 1;
        tried = 0;
      } else {
        at = (at + 1) % n;
        ++tried;
      }
    }
    triangles.push_back({corners_[left_[0]], corners_[left_[1]], corners_[left_[2]]});
  }

 private:
  /// Positive where a, b, c turn as the polygon does.
  double turn(std::size_t a, std::size_t b, std::size_t c) const {
    return (points_[b] - points_[a]).cross(points_[c] - points_[a]).dot(normal_);
  }

  bool is_ear(std::size_t a, std::size_t b, std::size_t c) const {
    if (!(turn(a, b, c) > 0.0)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::size_t i) {
      if (i == a || i == b || i == c) return false;
      // a point where a corner is may be the other side of a slit
      if (points_[i] == points_[a] || points_[i] == points_[b] || points_[i] == points_[c]) return false;
      return turn(a, b, i) >= 0.0 && turn(b, c, i) >= 0.0 && turn(c, a, i) >= 0.0;
    });
  }

  const std::vector<int>& corners_;
  std::vector<Vec3> points_;
  Vec3 normal_ = Vec3::Zero();
  std::vector<std::size_t> left_;
};

}  // namespace

void append_polygon(const std::vector<int>& corners, const std::vector<Vec3>& vertices,
                    std::vector<Triangle>& triangles) {
  const bool are_known =
      std::all_of(corners.begin(), corners.end(), [&](int v) { return v < static_cast<int>(vertices.size()); });
  if (corners.size() == 3 || corners.size() > kMostEars || !are_known) return append_fan(corners, triangles);
  Polygon polygon(corners, vertices);
  if (polygon.is_fan()) return append_fan(corners, triangles);
  polygon.cut_ears(triangles);
}

}  // namespace impinge
