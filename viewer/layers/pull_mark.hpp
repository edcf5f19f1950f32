// How a pull is drawn, one that acts and one that was only asked for.
#pragma once

#include "viewer/draw/draw_list.hpp"
#include "viewer/draw/view_settings.hpp"

namespace impinge {

/// A ring where the body is held, and an arrow from there to `target`; finer by `scale`.
void mark_pull(const Vec3& point, const Vec3& target, const ViewSettings& settings, double scale, PickId pick,
               DrawList& list);

}  // namespace impinge
