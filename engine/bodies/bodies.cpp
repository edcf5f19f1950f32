#include "engine/bodies/bodies.hpp"

#include <algorithm>

namespace impinge {

Body& Bodies::add(std::unique_ptr<Body> body) {
  index_.emplace(body->name, size());
  const BodyIndex last(bodies_.size());
  if (!all_active()) activate_all();
  all_.push_back(last), active_.push_back(last), frames_left_.push_back(kFramesActive);
  bodies_.push_back(std::move(body));
  return *bodies_.back();
}

void Bodies::remove_last() {
  index_.erase(back().name);
  bodies_.pop_back(), all_.pop_back(), frames_left_.pop_back();
  activate_all();
}

BodyIndex Bodies::present() const {
  std::size_t count = bodies_.size();
  while (count > 0 && bodies_[count - 1]->absent) --count;
  return BodyIndex(count);
}

void Bodies::activate(std::span<const BodyIndex> more) {
  if (more.empty()) return;
  for (const BodyIndex b : more) frames_left_[static_cast<std::size_t>(b.value())] = kFramesActive;
  std::vector<BodyIndex> all;
  std::set_union(active_.begin(), active_.end(), more.begin(), more.end(), std::back_inserter(all));
  active_ = std::move(all);
}

void Bodies::activate_all() {
  std::fill(frames_left_.begin(), frames_left_.end(), kFramesActive);
  active_ = all_;
}

void Bodies::keep_from_touching(BodyIndex a, BodyIndex b) {
  const std::pair<BodyIndex, BodyIndex> pair(std::min(a, b), std::max(a, b));
  const auto at = std::lower_bound(never_touch_.begin(), never_touch_.end(), pair);
  if (at == never_touch_.end() || *at != pair) never_touch_.insert(at, pair);
}

bool Bodies::never_touch(BodyIndex a, BodyIndex b) const {
  if (never_touch_.empty()) return false;
  return std::binary_search(never_touch_.begin(), never_touch_.end(), std::pair(std::min(a, b), std::max(a, b)));
}

BodyIndex Bodies::find(std::string_view name) const {
  const auto it = index_.find(name);
  return it == index_.end() ? BodyIndex() : it->second;
}

std::vector<std::string> Bodies::names() const {
  std::vector<std::string> names;
  for (const Body& body : *this) names.push_back(body.name);
  return names;
}

}  // namespace impinge
