// When a factorization of the deformable bodies of a group is the quicker way, in steps of gradients over all of them.
#pragma once

#include <optional>

#include "engine/contact/group_system.hpp"

namespace impinge {

struct FactorWorth {
  double steps = 0.0;     ///< that take as long as the factorizations
  double at_least = 0.0;  ///< that a system with A takes, as a rule
};

/// None where a body's A can't be factorized, or is block diagonal in all of them.
std::optional<FactorWorth> factor_worth(const GroupSystem& group);

/// Steps that take as long as so many operations on dense blocks.
double steps_of_work(double operations, const GroupSystem& group);

}  // namespace impinge
