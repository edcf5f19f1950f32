// Whether every two bodies that can meet have a contact test.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "engine/bodies/rigid_body.hpp"

namespace impinge {

/// The first two bodies (i < j, i as small as can be, then j), one of them free to move, whose kinds of shape have no
/// test. `has_test` is asked once for two kinds, not for two bodies: it must not look further than the kind.
std::optional<std::pair<int, int>> first_untested_pair(std::span<const RigidBody> bodies,
                                                       const std::function<bool(const Shape&, const Shape&)>& has_test);

}  // namespace impinge
