// What a frame's record holds that the state at its end does not: contacts with their impulses, pairs, groups, figures.
// Kept with a snapshot, so that a frame that is gone back to shows what it showed, without a step.
#pragma once

#include "engine/core/archive.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

void put_record(ByteWriter& out, const StepRecord& record);
/// Into a record whose bodies are already those of the state. Throws InputError if the bytes are not such a record's.
void get_record(ByteReader& in, StepRecord& record);

}  // namespace impinge
