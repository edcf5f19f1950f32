// The factors of a Delassus operator of rigid bodies, W = J M⁻¹ Jᵀ: six velocities a body, whatever the contacts are.
#pragma once

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

}  // namespace impinge
