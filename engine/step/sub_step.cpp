#include "engine/step/sub_step.hpp"

#include <algorithm>

namespace impinge {

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
