// A convex polygon that rolls or rocks on a floor, with friction that holds: it turns about the corner it stands on until the
// next one comes down, and then about that one, with the angular momentum about it [McGeer90].
#pragma once

#include <cmath>
#include <vector>

#include "engine/core/types.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge::test {

using Profile = std::vector<Eigen::Vector2d>;  ///< against the clock, about the centre of mass, metres

/// With ends at z = ± half its length, and sides of two triangles.
inline TriangleMesh prism(const Profile& profile, double length) {
  TriangleMesh mesh;
  const int n = static_cast<int>(profile.size());
  for (const double z : {-0.5 * length, 0.5 * length})
    for (const Eigen::Vector2d& p : profile) mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + i}), mesh.triangles.push_back({j, n + j, n + i});
    if (i > 0 && i + 1 < n) mesh.triangles.push_back({0, i + 1, i}), mesh.triangles.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

class RollingPolygon {
 public:
  /// `inertia`: about the centre of mass by mass, m². Angles against the clock, radians; it stands on its lowest corner.
  RollingPolygon(Profile corners, double inertia, double angle, double spin)
      : corners_(std::move(corners)), inertia_(inertia), angle_(angle), spin_(spin) {
    for (std::size_t k = 0; k < corners_.size(); ++k)
      if (turned(k).y() < turned(pivot_).y()) pivot_ = k;
  }

  double spin() const { return spin_; }
  double angle() const { return angle_; }
  /// By mass, m²/s², from the floor.
  double energy(double gravity) const {
    return 0.5 * (inertia_ + corners_[pivot_].squaredNorm()) * spin_ * spin_ - gravity * turned(pivot_).y();
  }

  void go_on(double seconds, double gravity) {
    constexpr double kStep = 2e-6;
    for (double t = 0.0; t < seconds; t += kStep) {
      spin_ += kStep * gravity * turned(pivot_).x() / (inertia_ + corners_[pivot_].squaredNorm());
      angle_ += kStep * spin_;
      const std::size_t n = corners_.size();
      for (const std::size_t next : {(pivot_ + 1) % n, (pivot_ + n - 1) % n}) {
        if (turned(next).y() >= turned(pivot_).y() || !comes_down(next)) continue;
        spin_ *= (inertia_ + turned(next).dot(turned(pivot_))) / (inertia_ + corners_[next].squaredNorm());
        pivot_ = next;
      }
    }
  }

 private:
  Eigen::Vector2d turned(std::size_t k) const { return Eigen::Rotation2Dd(angle_) * corners_[k]; }
  bool comes_down(std::size_t k) const { return spin_ * (turned(k) - turned(pivot_)).x() < 0.0; }

  Profile corners_;
  double inertia_, angle_, spin_;
  std::size_t pivot_ = 0;
};

}  // namespace impinge::test
