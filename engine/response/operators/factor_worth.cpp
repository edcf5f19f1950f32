#include "engine/response/operators/factor_worth.hpp"

#include "engine/algebra/thrifty_solver.hpp"

namespace impinge {

std::optional<FactorWorth> factor_worth(const GroupSystem& group) {
  double all = 0.0;
  FactorWorth worth;
  for (const DeformableBlock& block : group.deformable) {
    if (block.is_diagonal) continue;
    if (block.solver == nullptr) return std::nullopt;
    const double blocks = block.a->pattern->blocks(), own = iterations_of_factor(*block.solver, *block.a->pattern);
    if (own == 0.0) return std::nullopt;
    all += blocks, worth.steps += blocks * own, worth.at_least += blocks * iterations_at_least(*block.a);
  }
  if (all == 0.0) return std::nullopt;
  worth.steps /= all, worth.at_least /= all;
  return worth;
}

double steps_of_work(double operations, const GroupSystem& group) {
  double rate = 0.0;  // operations a step
  for (const DeformableBlock& block : group.deformable) rate += 1.0 / iterations_of_work(1.0, *block.a->pattern);
  return operations / rate;
}

}  // namespace impinge
