// W of a group: of rigid bodies by its factors, with deformable ones by contacts or by the nodes that they touch,
// whichever are fewer.
#pragma once

#include <memory>

#include "engine/contact/group_system.hpp"
#include "engine/lcp/cone_problem.hpp"

namespace impinge {

/// Refers to `group`. Factorizes its deformable bodies unless their W is kept in it; throws DivergenceError where A is not
/// positive definite.
std::unique_ptr<Delassus> delassus_of(GroupSystem& group);

}  // namespace impinge
