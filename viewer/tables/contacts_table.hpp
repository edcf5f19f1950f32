// contacts.csv.
#pragma once

#include <string>

#include "engine/world/step_record.hpp"

namespace impinge {

std::string contacts_header();
/// All lines of a frame, each with its line end; bodies by name.
std::string contacts_rows(const StepRecord& record);

}  // namespace impinge
