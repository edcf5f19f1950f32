#include "engine/world/step_record.hpp"

namespace impinge {

void count_unsolved(std::vector<UnsolvedGroups>& all, const UnsolvedGroups& more) {
  for (UnsolvedGroups& known : all)
    if (known.reason == more.reason && known.limit == more.limit) {
      known.solves += more.solves;
      return;
    }
  all.push_back(more);
}

}  // namespace impinge
