#include "viewer/debugger/snapshot_ring.hpp"

#include <iterator>

namespace impinge {

void SnapshotRing::put(int frame, std::string state) {
  std::string& place = states_[frame];
  bytes_ += state.size() - place.size();
  place = std::move(state);
  while (bytes_ > most_ && states_.size() > 2) {
    const double now = states_.rbegin()->first;
    auto least = states_.end();
    double least_missed = 0.0;
    for (auto it = std::next(states_.begin()); std::next(it) != states_.end(); ++it) {
      const double missed = (std::next(it)->first - std::prev(it)->first) / (now - it->first + 1.0);
      if (least == states_.end() || missed < least_missed) least = it, least_missed = missed;
    }
    bytes_ -= least->second.size();
    states_.erase(least);
  }
}

std::optional<int> SnapshotRing::at_or_before(int frame) const {
  const auto it = states_.upper_bound(frame);
  if (it == states_.begin()) return std::nullopt;
  return std::prev(it)->first;
}

void SnapshotRing::cut(int frame) {
  for (auto it = states_.upper_bound(frame); it != states_.end(); it = states_.erase(it)) bytes_ -= it->second.size();
}

}  // namespace impinge
