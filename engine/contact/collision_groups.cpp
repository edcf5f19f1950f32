#include "engine/contact/collision_groups.hpp"

#include "engine/geometry/disjoint_sets.hpp"

namespace impinge {

std::vector<CollisionGroup> make_groups(std::span<const std::pair<BodyIndex, BodyIndex>> contacts,
                                        const std::vector<char>& joins) {
  DisjointSets together(joins.size());  // the lowest body stands for its group
  std::vector<char> touched(joins.size(), 0);
  for (const auto& [a, b] : contacts) {
    if (a.is_none() || b.is_none()) continue;
    if (joins[a]) touched[a] = 1;
    if (joins[b]) touched[b] = 1;
    if (joins[a] && joins[b]) together.join(a, b);
  }

  std::vector<CollisionGroup> groups;
  std::vector<GroupIndex> group_of(joins.size());
  for (BodyIndex i(0); i < joins.size(); ++i) {
    if (!touched[i]) continue;
    const int r = together.root(i);
    if (group_of[r].is_none()) {
      group_of[r] = GroupIndex(groups.size());
      groups.emplace_back();
    }
    groups[group_of[r]].bodies.push_back(i);
  }
  for (ContactIndex c(0); c < contacts.size(); ++c) {
    const auto& [a, b] = contacts[c];
    if (a.is_none() || b.is_none()) continue;
    const BodyIndex body = joins[a] ? a : (joins[b] ? b : BodyIndex());
    if (!body.is_none()) groups[group_of[together.root(body)]].contacts.push_back(c);
  }
  return groups;
}

std::vector<CollisionGroup> find_groups(const Bodies& bodies, const ContactList& contacts) {
  std::vector<std::pair<BodyIndex, BodyIndex>> ends;
  for (const Collision& c : contacts.collisions) ends.emplace_back(c.body_a, c.body_b);
  const auto awake = [&](BodyIndex b) { return !b.is_none() && bodies[b].has_freedom() && !bodies[b].asleep; };
  const auto is_deleted = [&](BodyIndex b) { return !b.is_none() && bodies[b].deleted; };
  for (const Attachment& a : contacts.attachments) {
    if (is_deleted(a.a.body) || is_deleted(a.b.body)) {
      ends.emplace_back();
      continue;
    }
    const BodyIndex first = awake(a.a.body) ? a.a.body : a.b.body;
    if (awake(first))
      ends.emplace_back(first, first == a.a.body && !a.b.body.is_none() ? a.b.body : first);
    else
      ends.emplace_back();
  }
  std::vector<char> joins(static_cast<std::size_t>(bodies.size().value()), 0);
  for (const auto& [a, b] : ends)
    for (const BodyIndex body : {a, b})
      if (!body.is_none()) joins[body] = bodies[body].has_freedom();
  return make_groups(ends, joins);
}

}  // namespace impinge
