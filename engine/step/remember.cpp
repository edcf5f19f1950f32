#include "engine/step/remember.hpp"

#include <set>

#include "engine/contact/contact_frame.hpp"

namespace impinge {

namespace {

/// What the contacts are to start from next time.
std::vector<ContactCache::Item> starts_of(std::span<const GroupResult> results) {
  std::vector<ContactCache::Item> items;
  for (const GroupResult& r : results)
    for (std::size_t i = 0; i < r.impulses.size(); ++i)
      items.push_back(r.starts.empty() ? r.impulses[i] : ContactCache::Item{r.impulses[i].key, r.starts[i]});
  return items;
}

/// Adds an impulse, N·s, on A, world axes.
void add_to(SolvedContact& contact, const Vec3& impulse) {
  contact.lambda += contact_axes(contact.collision.normal) * impulse;
}

/// Of the same two bodies as another, the one whose points are nearest to that one's; null: none.
SolvedContact* nearest_of_pair(const Bodies& bodies, const SolvedContact& to, std::vector<GroupResult>& results) {
  const auto place = [&](const SolvedContact& c) { return bodies[c.collision.body_a].position_of(c.point_a); };
  const Vec3 here = place(to);
  SolvedContact* nearest = nullptr;
  double least = INFINITY;
  for (GroupResult& result : results)
    for (SolvedContact& c : result.solved) {
      if (c.collision.body_a != to.collision.body_a || c.collision.body_b != to.collision.body_b) continue;
      const double far = (place(c) - here).squaredNorm();
      if (far < least) least = far, nearest = &c;
    }
  return nearest;
}

}  // namespace

void remember_impulses(const Bodies& bodies, std::span<const GroupResult> results, ContactCache& cache) {
  std::vector<ContactCache::Item> items = starts_of(results);
  std::erase_if(items, [](const ContactCache::Item& item) { return item.impulse.isZero(0.0); });
  cache.renew(std::move(items), bodies.active(),
              [&](BodyIndex b) { return b.is_none() || bodies[b].asleep || !bodies[b].has_freedom(); });
}

ContactCache impulses_of(std::span<const GroupResult> results) {
  ContactCache cache;
  cache.assign(starts_of(results));
  return cache;
}

void EarlierPieces::close(const Bodies& bodies, bool is_last) {
  if (!is_last)
    take();
  else if (!parts_.empty())
    give(bodies);
}

void EarlierPieces::take() {
  for (const GroupResult& result : step_.results) {
    for (const auto& [key, impulse] : result.impulses) parts_[key].impulse += impulse;
    for (const SolvedContact& c : result.solved) parts_[key_of(c.collision)].contact = c;
  }
}

void EarlierPieces::give(const Bodies& bodies) const {
  std::set<ContactKey> here;
  for (GroupResult& result : step_.results) {
    std::set<ContactKey> solved;
    for (auto& [key, impulse] : result.impulses)
      if (const auto part = parts_.find(key); part != parts_.end() && here.insert(key).second)
        impulse += part->second.impulse;
    for (SolvedContact& c : result.solved)
      if (const auto part = parts_.find(key_of(c.collision)); part != parts_.end() && solved.insert(part->first).second)
        add_to(c, part->second.impulse);
  }
  for (const auto& [key, part] : parts_) {
    if (!part.contact || part.impulse.isZero(0.0) || here.contains(key)) continue;
    if (SolvedContact* nearest = nearest_of_pair(bodies, *part.contact, step_.results)) {
      add_to(*nearest, part.impulse);
      continue;
    }
    SolvedContact& parted = step_.parted.emplace_back(*part.contact);
    parted.lambda = contact_axes(parted.collision.normal) * part.impulse;
    parted.group = step_.group_of(key.body_a).is_none() ? step_.group_of(key.body_b) : step_.group_of(key.body_a);
  }
}

std::vector<BodyEnds> find_supports(const Bodies& bodies, std::span<const GroupResult> results) {
  std::vector<BodyEnds> supports;
  for (const GroupResult& result : results)
    for (const auto& [key, impulse] : result.impulses)
      for (const auto& [body, other] : {BodyEnds(key.body_a, key.body_b), BodyEnds(key.body_b, key.body_a)})
        if (!other.is_none() && bodies[other].kind() == BodyKind::scripted) supports.emplace_back(body, other);
  return supports;
}

std::vector<double> push_out_speeds(const Bodies& bodies, std::span<const CollisionGroup> groups,
                                    std::span<const GroupResult> results) {
  std::vector<double> speeds(bodies.size(), 0.0);
  for (std::size_t g = 0; g < results.size(); ++g)
    for (std::size_t i = 0; i < results[g].push_out.size(); ++i)
      speeds[static_cast<std::size_t>(groups[g].bodies[i].value())] = results[g].push_out[i];
  return speeds;
}

}  // namespace impinge
