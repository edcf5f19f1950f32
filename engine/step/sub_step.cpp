#include "engine/step/sub_step.hpp"

#include <algorithm>

namespace impinge {

GroupIndex SubStep::group_of(BodyIndex body) const {
  for (GroupIndex g(0); g < groups.size(); ++g)
    if (std::binary_search(groups[g].bodies.begin(), groups[g].bodies.end(), body)) return g;
  return {};
}

}  // namespace impinge
