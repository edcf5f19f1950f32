// What the debugger draws over a picture beside the layers: the selection, trails and the ghost of another frame.
#pragma once

#include "viewer/draw/draw_list.hpp"
#include "viewer/state/debug_model.hpp"

namespace impinge {

/// A box around the selected body, its triangle; a ring and an arrow of a selected contact.
void mark_selection(const DebugModel& model, DrawList& list);
/// Where bodies' centres were in the frames before that were seen: of those selected, else of all that move.
void draw_trails(const DebugModel& model, DrawList& list);
/// Pulls that were asked for, and act from the next frame on; and those that act, where their layer is off.
void mark_pulls(const DebugModel& model, DrawList& list);
/// Rigid bodies where they were in another frame, and all where they are in what is made beside them; see-through, as far
/// as that was seen.
void draw_ghost(const DebugModel& model, DrawList& list);
/// Bodies that are added with the next frame, see-through, where their pattern is in the picture.
void draw_coming(const DebugModel& model, DrawList& list);
/// World box of what is selected; empty of nothing, and of a plane.
Aabb bounds_of_selection(const DebugModel& model);

}  // namespace impinge
