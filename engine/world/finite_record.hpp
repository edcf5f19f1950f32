// Whether a frame may be published: every figure of it is a finite number.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

/// Throws DivergenceError with frame, body (where one is to blame) and the column of stats.csv or contacts.csv that
/// would hold a figure that is not finite. `bodies`: those that the record is of.
void check_finite(const StepRecord& record, Bodies& bodies);

}  // namespace impinge
