#include "engine/world/stage_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace impinge {

std::string_view name_of(StageKind kind) {
  constexpr std::string_view kNames[] = {"free motion", "broad phase",  "narrow phase", "reduction",   "groups",
                                         "assembly",    "response",     "response",     "second look", "push-out",
                                         "integration", "first impact", "look back",    "end"};
  return kNames[static_cast<std::size_t>(kind)];
}

int FrameStages::places() const {
  int all = 0;
  for (const StageEntry& entry : entries) all += entry.count;
  return all;
}

std::pair<std::size_t, int> FrameStages::entry_at(int place) const {
  int first = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (place < first + entries[i].count) return {i, first};
    first += entries[i].count;
  }
  return {entries.size(), first};
}

int FrameStages::end_of(int substep) const {
  int first = 0;
  for (const StageEntry& entry : entries) {
    if (entry.kind == StageKind::end && entry.substep == substep) return first;
    first += entry.count;
  }
  return first;
}

int FrameStages::ended_at(int place) const {
  int ended = 0, first = 0;
  for (const StageEntry& entry : entries) {
    if (first > place) break;
    if (entry.kind == StageKind::end) ended = entry.substep;
    first += entry.count;
  }
  return ended;
}

std::string FrameStages::words(int place) const {
  const auto [index, first] = entry_at(place);
  if (index == entries.size()) return "end of the frame";
  const StageEntry& entry = entries[index];
  std::string text = fmt::format("sub-step {} of {}", entry.substep, substeps);
  const auto of_substep = [&](const StageEntry& e) { return e.substep == entry.substep; };
  const bool has_pieces =
      std::any_of(entries.begin(), entries.end(), [&](const StageEntry& e) { return of_substep(e) && e.piece > 1; });
  const bool has_motions =
      std::any_of(entries.begin(), entries.end(), [&](const StageEntry& e) { return of_substep(e) && e.motion > 1; });
  if (has_pieces && entry.kind != StageKind::end) text += fmt::format(", piece {}", entry.piece);
  if (has_motions && entry.kind != StageKind::end) text += fmt::format(", attempt {}", entry.motion);
  text += fmt::format(", {}", name_of(entry.kind));
  if (entry.kind == StageKind::iteration)
    text += fmt::format(" iteration {} of {}", place - first + entry.first_iteration,
                        entry.count - 1 + entry.first_iteration);
  return text;
}

}  // namespace impinge
