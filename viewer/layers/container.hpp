// Bodies in which others are that the eye doesn't see.
#pragma once

#include "engine/world/step_record.hpp"

namespace impinge {

/// Whether the surface of a body with triangles stands between the eye, outside of it, and the centre of each body that moves
/// within its box.
bool hides_what_is_inside(const StepRecord& record, std::size_t body, const Vec3& eye);

}  // namespace impinge
