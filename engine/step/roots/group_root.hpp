// The root of a Newton scheme for a group in contact: its deformable bodies' A and b from one iteration to the next.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/bodies/time_integration.hpp"
#include "engine/contact/assemble.hpp"
#include "engine/step/roots/root_search.hpp"

namespace impinge {

class GroupRoot {
 public:
  /// `first`: with A and b as free velocities left them.
  GroupRoot(Bodies& bodies, const DeformableIntegrator& integrator, const NewtonSettings& newton,
            const AssembledGroup& first);

  /// Takes A and b of the bodies at the answer. How far that is from the root by the forces and momenta that make it up, the
  /// largest of a body.
  double residual_of(const AssembledGroup& answer);
  /// A, b and v* for the next solve, from that answer; the last one goes back to the best, where steps aren't full ones.
  void go_on(const AssembledGroup& answer, bool is_last);
  bool is_controlled() const { return search_.is_controlled(); }
  /// What rows ask for hangs on whether free velocities close their gaps, and is not the same at all places. Where steps
  /// aren't full ones it stays as it was with those that were without contact.
  void keep_bounds(GroupSystem& system) const;

 private:
  Bodies& bodies_;
  const DeformableIntegrator& integrator_;
  RootSearch search_;
  RootSearch::Velocities at_, to_;
  double residual_ = 0.0;
  std::vector<double> bounds_;
};

}  // namespace impinge
