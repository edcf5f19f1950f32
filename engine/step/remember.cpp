#include "engine/step/remember.hpp"

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
