// A point as a convex set: how far a place is from a solid is the gap of the two.
#pragma once

#include "engine/geometry/convex/convex_set.hpp"

namespace impinge {

class ConvexPoint final : public ConvexSet {
 public:
  Vec3 support(const Vec3&) const override { return Vec3::Zero(); }
};

}  // namespace impinge
