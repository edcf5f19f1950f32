// J and M of a group's rigid bodies, as methods that go by bodies take them.
#pragma once

#include "engine/contact/group_system.hpp"
#include "engine/lcp/body_space.hpp"

namespace impinge {

/// Every contact has an entry; what it has on deformable bodies is left out.
BodySpace rigid_space(const GroupSystem& group);

}  // namespace impinge
