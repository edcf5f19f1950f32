#include "engine/contact/collision_groups.hpp"

#include <numeric>

namespace impinge {

std::vector<CollisionGroup> make_groups(std::span<const std::pair<int, int>> contacts, const std::vector<char>& joins) {
  std::vector<int> parent(joins.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];  // path halving
    return i;
  };
  std::vector<char> touched(joins.size(), 0);
  for (const auto& [a, b] : contacts) {
    if (a < 0 || b < 0) continue;
    if (joins[a]) touched[a] = 1;
    if (joins[b]) touched[b] = 1;
    if (!joins[a] || !joins[b]) continue;
    const int ra = root(a), rb = root(b);
    if (ra != rb) parent[std::max(ra, rb)] = std::min(ra, rb);  // the lowest body stands for its group
  }

  std::vector<CollisionGroup> groups;
  std::vector<int> group_of(joins.size(), -1);
  for (int i = 0; i < static_cast<int>(joins.size()); ++i) {
    if (!touched[i]) continue;
    const int r = root(i);
    if (group_of[r] < 0) {
      group_of[r] = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[group_of[r]].bodies.push_back(i);
  }
  for (int c = 0; c < static_cast<int>(contacts.size()); ++c) {
    const auto& [a, b] = contacts[c];
    if (a < 0 || b < 0) continue;
    const int body = joins[a] ? a : (joins[b] ? b : -1);
    if (body >= 0) groups[group_of[root(body)]].contacts.push_back(c);
  }
  return groups;
}

}  // namespace impinge
