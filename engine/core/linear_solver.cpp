#include "engine/core/linear_solver.hpp"

#include "engine/core/error.hpp"

namespace impinge {

Entry<LinearSolver> conjugate_gradient_solver();
Entry<LinearSolver> simplicial_llt_solver();
#ifdef IMPINGE_CHOLMOD
Entry<LinearSolver> cholmod_solver();
#endif

const Registry<LinearSolver>& linear_solvers() {
  static const Registry<LinearSolver> list = {
      conjugate_gradient_solver(),
      simplicial_llt_solver(),
#ifdef IMPINGE_CHOLMOD
      cholmod_solver(),
#endif
  };
  return list;
}

std::string_view automatic_linear_solver(int, int right_hand_sides) {
  if (right_hand_sides <= 1) return "conjugate_gradient";
#ifdef IMPINGE_CHOLMOD
  return "cholmod";
#else
  return "simplicial_llt";
#endif
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name, int unknowns, int right_hand_sides) {
  if (name == "automatic") name = automatic_linear_solver(unknowns, right_hand_sides);
  const Entry<LinearSolver>* found = find_entry(linear_solvers(), name);
  IMPINGE_ASSERT(found != nullptr);
  return found->make();
}

}  // namespace impinge
