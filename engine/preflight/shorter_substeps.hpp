#pragma once

#include <string>

#include "engine/world/parameters.hpp"

namespace impinge {

/// What makes sub-steps at least `times` as short, as a user would set it.
std::string shorter_substeps(const Parameters& parameters, double times);

}  // namespace impinge
