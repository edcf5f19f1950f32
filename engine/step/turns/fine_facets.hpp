// A ball or wheel made of triangles rolls over more than one of them in a sub-step. Their corners that come down on the way
// have rows of their own, ahead of the one that it stands on, and what these push holds it back: a body of 384 sides lost half
// of its energy in a second. But what is finer than the turn can't be told from what is round. So the row that touches now
// answers for the corner that touches then, as that of a round body does (end_rows), also round the rim of a coin; and where a
// ball rolls in a hollow of triangles, for the face that it comes to, which looks at its end bring (step/end_pose).
#pragma once

#include <span>

#include "engine/step/turns/end_rows.hpp"
#include "engine/step/turns/row_end.hpp"

namespace impinge {

/// `rows`: by contact of the group; those of one pair follow each other.
void roll_over_facets(const Bodies& bodies, const AssembledGroup& group, const ContactSettings& settings,
                      double time_step, std::span<const RowEnd> rows, EndRows& ends);

}  // namespace impinge
