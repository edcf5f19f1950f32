// Contacts are sought where a sub-step begins, and a surface that deforms is not where it was when it ends: it slides round
// what holds it, folds, and lies with other places on it than those that had contacts. So where the response leads is
// looked at, and an overlap there is a contact of the sub-step that ends so: the same material points, the normal of the end.
#pragma once

#include "engine/step/detect.hpp"

namespace impinge {

/// Of a step that is solved: overlaps at its end of pairs with a deforming body, deeper than they were at its start and
/// than contacts leave. Points and gap are those of the start, in pair order; changes nothing.
std::vector<Collision> overlaps_at_end(const Bodies& bodies, const Detecting& by, const SubStep& step);

}  // namespace impinge
