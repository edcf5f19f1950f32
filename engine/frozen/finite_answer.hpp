// Whether the answer to a frozen step is one: all of its figures are finite numbers.
#pragma once

#include "engine/frozen/frozen_comparison.hpp"

namespace impinge {

/// Names the body and the figure (a row of solution_METHOD.csv, a change of velocity, or the residual) that is not
/// finite; "" where all are.
std::string not_finite(const FrozenStep& step, const std::vector<GroupAnswer>& answers, const FrozenVerdict& verdict);

}  // namespace impinge
