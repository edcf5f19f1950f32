// What a contact shows beside its state, for colours, sizes and tables.
#pragma once

#include "engine/world/step_record.hpp"

namespace impinge {

/// How fast its two points slide along each other at the end of the frame, m/s.
double slip_speed(const StepRecord& record, const ContactRecord& contact);

}  // namespace impinge
