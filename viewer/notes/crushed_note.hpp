// What a run must not keep to its pictures: deformable bodies that ended crushed.
#pragma once

#include <span>

#include "engine/bodies/crushed.hpp"

namespace impinge {

/// A line a body, with its end; "" for none.
std::string crushed_note(std::span<const CrushedBody> bodies);

}  // namespace impinge
