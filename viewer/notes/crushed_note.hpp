// What a run must not keep to its pictures: deformable bodies that ended crushed.
#pragma once

#include <span>
#include <string_view>

#include "engine/bodies/crushed.hpp"

namespace impinge {

/// How its lines are known in a run's output.
inline constexpr std::string_view kCrushedMark = "ended crushed";

/// A line a body, with its end; "" for none.
std::string crushed_note(std::span<const CrushedBody> bodies);

}  // namespace impinge
