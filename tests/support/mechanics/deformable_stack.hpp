// Group systems with deformable bodies, made without a world: lattice cubes on top of each other that don't match, at
// the first sub-step of a fall or a push, with contacts from every node of a touching face to the other face.
#pragma once

#include <memory>

#include "engine/contact/group_system.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

struct StackOptions {
  double young = 1e5, poisson = 0.4, density = 1000.0;
  double time_step = 0.01;  ///< s
  double friction = 0.0;
  std::vector<int> cells = {4, 3};  ///< lattice cells a side of each cube, from below
  bool rigid_on_top = false;        ///< a rigid cube's four lower corners on the uppermost face
};

/// Owns what the group refers to.
struct SoftStack {
  struct Body {
    std::unique_ptr<DeformableBody> body;
    DeformableStep step;
    std::unique_ptr<LinearSolver> solver;
  };
  std::vector<std::unique_ptr<Body>> bodies;
  GroupSystem group;
};

/// Two 0.2 m cubes or more, each 5 % to the side of the one below, on a fixed floor; sheared and falling at some 0.5
/// m/s.
SoftStack make_soft_stack(const StackOptions& options);

}  // namespace impinge::test
