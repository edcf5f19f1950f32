#include "engine/step/sub_step.hpp"

namespace impinge {

std::vector<GroupIndex> SubStep::group_of(const Bodies& bodies) const {
  std::vector<GroupIndex> group(static_cast<std::size_t>(bodies.size().value()));
  for (GroupIndex g(0); g < groups.size(); ++g)
    for (const BodyIndex b : groups[g].bodies) group[b] = g;
  return group;
}

}  // namespace impinge
