#include "engine/step/sub_step.hpp"

#include <algorithm>

namespace impinge {

bool SubStep::is_flight(BodyIndex a, BodyIndex b) const {
  const auto ends = [](const Collision& c) { return std::pair(c.body_a, c.body_b); };
  const auto own = std::ranges::lower_bound(collisions, std::pair(a, b), std::less(), ends);
  return own != collisions.end() && ends(*own) == std::pair(a, b) && own->meeting != nullptr;
}

GroupIndex SubStep::group_of(BodyIndex body) const {
  for (GroupIndex g(0); g < groups.size(); ++g)
    if (std::binary_search(groups[g].bodies.begin(), groups[g].bodies.end(), body)) return g;
  return {};
}

void SubStep::begin_later(const Bodies& bodies) {
  const std::span<const BodyIndex> whose = bodies.to_renew(later.size() == colliders.size());
  later.resize(colliders.size());
  for (const BodyIndex b : whose) later[b] = colliders[b];
}

}  // namespace impinge
