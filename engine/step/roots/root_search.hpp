// Where Newton iterations with contact take A and b next. Contact solved with the A and b of a place v leads to a place T(v),
// and the root is where T(v) = v. Full steps, v ← T(v), are the quickest as long as they get on; where A is not the derivative
// (energy_momentum has a symmetric one that is near it) or contacts open and close in turn, they creep or go round.
//
// Then v goes a part of the way, and what the last places tell of T is made use of: of all combinations of theirs the one is
// taken whose way f = T(v) − v comes out shortest, as if T were linear there [Anderson65]. Lengths are those that A gives,
// √(fᵀA f): the nearest to a potential that there is, f being −A⁻¹ times what contact leaves of the forces. Where ways grow
// longer it starts anew from the place of the shortest, with half of the part. Friction has more than one answer at times, and
// T jumps from one to another: shorter steps end at the jump, be the root elsewhere. Where they don't get on either, full
// ones go on from where they were left, and so by turns.
#pragma once

#include <span>
#include <vector>

#include "engine/algebra/block_matrix.hpp"

namespace impinge {

class RootSearch {
 public:
  /// Of the deformable bodies of a group, over their free nodes, m/s.
  using Velocities = std::vector<VecX>;

  /// `most`: how many places are tried.
  RootSearch(double tolerance, int most) : tolerance_(tolerance), most_(most) {}
  /// Where to go on: `to`, or elsewhere. A and b taken at `at` led to `to`, with this residual; `a`: by body.
  Velocities next(const Velocities& at, const Velocities& to, double residual, std::span<const BlockMatrix* const> a);
  /// Whether full steps did not get on; then also, of the places since, from which one the smallest residual came.
  bool is_controlled() const { return is_controlled_; }
  const Velocities& best() const { return best_; }

 private:
  bool gets_on() const;
  void take_turns(const Velocities& to);
  Velocities shorter(const Velocities& at, const Velocities& way, std::span<const BlockMatrix* const> a);
  Velocities start_again(const Velocities& at, const Velocities& way);
  void remember(const Velocities& at, const Velocities& way);
  void combine(Velocities& v, const Velocities& way, std::span<const BlockMatrix* const> a) const;

  double tolerance_;
  int most_;
  bool is_controlled_ = false, is_full_ = true;
  int made_ = 0;
  std::vector<double> residuals_;  // since turns were taken
  Velocities left_;                // where full steps would have gone
  Velocities best_;
  double best_residual_ = 0.0;

  double part_ = 1.0;           // of the way
  Velocities near_, near_way_;  // the place of the shortest way
  double shortest_ = 0.0;
  int longer_ = 0;  // ways since that were no shorter
  Velocities last_, last_way_;
  std::vector<Velocities> from_last_, way_from_last_;  // how the places since the start differ, and their ways
};

}  // namespace impinge
