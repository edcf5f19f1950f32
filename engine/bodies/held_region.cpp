#include "engine/bodies/held_region.hpp"

#include <algorithm>

namespace impinge {

bool NodeRegion::contains(int node, const Vec3& x) const {
  switch (kind) {
    case box:
      return (x.array() >= min.array()).all() && (x.array() <= max.array()).all();
    case sphere:
      return (x - center).norm() <= radius;
    case list:
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  }
  return false;
}

Vec3 HeldRegion::at(std::size_t k, double time) const {
  if (motion.is_empty()) return start[k] + displacement;
  const Pose now = motion.at(time);
  return pivot + displacement + now.position + now.rotation * (start[k] - pivot);
}

}  // namespace impinge
