// How a pull is drawn, one that acts and one that was only asked for.
#pragma once

#include "viewer/draw/draw_list.hpp"

namespace impinge {

/// A ring where the body is held, and an arrow from there to `target`. Pixels.
void mark_pull(const Vec3& point, const Vec3& target, double size, double width, PickId pick, DrawList& list);

}  // namespace impinge
