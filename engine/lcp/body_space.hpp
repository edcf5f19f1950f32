// The factors of a Delassus operator of rigid bodies, W = J M⁻¹ Jᵀ: six velocities a body, whatever the contacts are.
#pragma once

#include <Eigen/LU>
#include <array>
#include <vector>

#include "engine/core/types.hpp"

namespace impinge {

struct BodySpace {
  using Six = Eigen::Matrix<double, 6, 1>;  ///< of a body: linear, then angular

  /// A body's columns in the rows of one contact; rows that the contact hasn't are 0.
  struct Side {
    int body = -1;  ///< none: a body that doesn't respond
    std::array<Six, 3> row = {Six::Zero(), Six::Zero(), Six::Zero()};
  };
  std::vector<std::array<Side, 2>> sides;  ///< by contact
  std::vector<double> mass;                ///< by body, kg
  std::vector<Mat3> inertia;               ///< kg·m²

  VecX no_velocities() const { return VecX::Zero(static_cast<Eigen::Index>(6 * mass.size())); }

  /// s += J_iᵀ x.
  void push(std::size_t i, const Vec3& x, VecX& s) const {
    for (const Side& side : sides[i])
      if (side.body >= 0)
        s.segment<6>(6 * side.body) += x.x() * side.row[0] + x.y() * side.row[1] + x.z() * side.row[2];
  }
  /// J_i s.
  Vec3 relative(std::size_t i, const VecX& s) const {
    Vec3 u = Vec3::Zero();
    for (const Side& side : sides[i])
      if (side.body >= 0)
        for (int k = 0; k < 3; ++k) u[k] += side.row[k].dot(s.segment<6>(6 * side.body));
    return u;
  }
};

/// M⁻¹ of bodies whose inertias are inverted once.
class InverseMasses {
 public:
  explicit InverseMasses(const BodySpace& bodies) : mass_(bodies.mass) {
    for (const Mat3& inertia : bodies.inertia) inverse_inertia_.push_back(inertia.inverse());
  }
  BodySpace::Six of(int body, const BodySpace::Six& s) const {
    BodySpace::Six v;
    v << s.head<3>() / mass_[body], inverse_inertia_[body] * s.tail<3>();
    return v;
  }
  /// s = M⁻¹ s, in its first six numbers a body.
  void apply(VecX& s) const {
    for (int body = 0; body < static_cast<int>(mass_.size()); ++body)
      s.segment<6>(6 * body) = of(body, s.segment<6>(6 * body));
  }

 private:
  std::vector<double> mass_;
  std::vector<Mat3> inverse_inertia_;
};

}  // namespace impinge
