// The judge of a solved group, independent of response and solver: it sees A, J, the bounds, λ and Δv, nothing else.
#pragma once

#include <span>

#include "engine/contact/group_system.hpp"
#include "engine/core/finite.hpp"

namespace impinge {

struct GroupVerdict {
  double natural_map = 0.0;  ///< m/s, as in lcp/residual.hpp, with u = J (v* + Δv) - bound
  double momentum = 0.0;     ///< max |Δv - A⁻¹ J^T λ| over rigid bodies, |D⁻¹ (A Δv - J^T λ)| over nodes, m/s
  double relative = 0.0;     ///< the natural map by max |J v* - bound|; of a map that is rounding, 0
  int worst = -1;            ///< contact of the largest natural map
  std::vector<double> of_contacts = {};  ///< each one's own natural map, relative likewise
  double residual() const { return larger(natural_map, momentum); }
};

/// `w_diagonal`: the diagonal blocks of W, by which natural maps are then scaled as lcp/residual.hpp scales them;
/// otherwise a deformable body enters by its nodes' own blocks. `rounding`: m/s, where somebody knows it by positions, too
/// (step/group_result.hpp); 0: that of the bodies' speeds.
GroupVerdict judge_group(const GroupSystem& group, const std::vector<Mat3>* w_diagonal = nullptr,
                         double rounding = 0.0);

/// What the velocities of its bodies' points are known to, m/s.
double rounding_of_speeds(const GroupSystem& group);

/// The velocity that rows ask for, max |J v* - bound|, m/s.
double most_asked(const GroupSystem& group);

/// Whether that is no start for λ: nothing is asked for beyond rounding, or so much less than it gives to rigid bodies that
/// it would leave rounding of its own size. So it is with what a blow gave, in bodies that fly on together.
bool starts_too_high(const GroupSystem& group, std::span<const Vec3> start);

}  // namespace impinge
