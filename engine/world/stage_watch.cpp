#include "engine/world/stage_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

StageKind kind_of(StepStage stage) {
  switch (stage) {
    case StepStage::free_motion:
      return StageKind::free_motion;
    case StepStage::broad_phase:
      return StageKind::broad_phase;
    case StepStage::narrow_phase:
      return StageKind::narrow_phase;
    case StepStage::reduction:
      return StageKind::reduction;
    case StepStage::groups:
      return StageKind::groups;
    case StepStage::response:
      return StageKind::response;
    case StepStage::second_look:
      return StageKind::second_look;
    case StepStage::push_out:
      return StageKind::push_out;
    case StepStage::integration:
      break;
  }
  return StageKind::integration;
}

/// In words.
std::string looked_back(const SubStep& step, const std::optional<UnsafeMotion>& unsafe, bool is_kept) {
  if (!unsafe) return "nothing has passed";
  double first = INFINITY;
  for (const UnsafeMotion::Pair& pair : unsafe->pairs)
    for (const Passage& p : pair.passages) first = std::min(first, step.time + p.time * step.time_step);
  const std::size_t pairs = unsafe->pairs.size();
  if (first == INFINITY)
    return fmt::format("{} moved farther than contacts see", pairs == 1 ? "a pair" : fmt::format("{} pairs", pairs));
  return fmt::format("{} at {:.6g} s: {}",
                     pairs == 1 ? "a pair passes" : fmt::format("{} pairs pass, the first", pairs), first,
                     is_kept ? "stays, or is let go" : "goes back");
}

}  // namespace

StageEntry StageWatch::entry(StageKind kind, const SubStep& step) const {
  StageEntry e;
  e.kind = kind;
  e.substep = substep_, e.piece = piece_, e.motion = motion_;
  e.time = step.time, e.time_step = step.time_step;
  return e;
}

void StageWatch::reached(StepStage stage, const Bodies&, const SubStep& step) {
  const auto hand_on = [&](StageKind kind) {
    StageEntry e = entry(kind, step);
    e.words = stage_words(world_, step, kind, tape_);
    if (kind == StageKind::iteration) {
      e.count = tape_.looks();
      e.first_iteration = tape_.starts_at_zero() ? 0 : 1;
    }
    at(std::move(e), step, nullptr);
  };
  if (stage == StepStage::response) {
    if (step.groups.empty()) return;  // nothing was solved
    hand_on(StageKind::assembly);
    if (!wants_solves() || tape_.looks() > 0) hand_on(StageKind::iteration);
  }
  if (stage == StepStage::push_out && step.groups.empty()) return;
  hand_on(kind_of(stage));
}

SolveWatcher* StageWatch::solve_watcher(const SubStep& step) {
  if (!wants_solves()) return nullptr;
  tape_.begin(world_.bodies(), step.contacts(world_.attachments()), step.groups, wanted_look());
  return &tape_;
}

void StageWatch::struck(const Bodies&, const SubStep& step, double share) {
  StageEntry e = entry(StageKind::impact, step);
  e.words = fmt::format("after {:.3g} % of it: goes back", 100.0 * share);
  at(std::move(e), step, nullptr);
  ++motion_;
}

void StageWatch::moved(const Bodies&, const SubStep& step, MotionGuard&, const std::optional<UnsafeMotion>& unsafe,
                       bool is_kept) {
  StageEntry e = entry(StageKind::look_back, step);
  e.words = looked_back(step, unsafe, is_kept);
  at(std::move(e), step, unsafe ? &*unsafe : nullptr);
  if (is_kept)
    ++piece_, motion_ = 1;
  else
    ++motion_;
}

void StageList::at(StageEntry entry, const SubStep&, const UnsafeMotion*) {
  stages_.entries.push_back(std::move(entry));
}

void StageList::recorded(Bodies&, const StepRecord& so_far, int substep, int) {
  StageEntry e;
  e.kind = StageKind::end;
  e.substep = substep, e.piece = piece_;
  e.time = so_far.stats.time;
  e.words = fmt::format("{:.6g} s", so_far.stats.time);
  stages_.entries.push_back(std::move(e));
  stages_.figures.push_back(so_far.stats);
  stages_.frame = so_far.stats.frame;
  end_substep();
}

FrameStages StageList::take() {
  stages_.substeps = static_cast<int>(stages_.figures.size());
  return std::move(stages_);
}

StageStop::StageStop(const World& world, const FrameStages& stages, int place) : StageWatch(world), stages_(stages) {
  const auto [index, first] = stages.entry_at(place);
  IMPINGE_ASSERT(index < stages.entries.size());
  stop_ = index;
  within_ = place - first;
}

void StageStop::at(StageEntry entry, const SubStep& step, const UnsafeMotion* unsafe) {
  // nobody has counted the looks of solves on the way: whether there are any the list says
  if (entry.kind == StageKind::iteration && stages_.entries[next_].kind != StageKind::iteration) return;
  IMPINGE_ASSERT(stages_.entries[next_].kind == entry.kind);  // a frame is made the same each time
  if (next_++ != stop_) return;
  record_ = stage_record(world_, step, entry, tape_);
  if (unsafe != nullptr) show_passages(*unsafe, record_);
  throw StageReached();
}

bool StageStop::wants_solves() const {
  return stop_ == next_ || (stop_ == next_ + 1 && stages_.entries[stop_].kind == StageKind::iteration);
}

std::optional<int> StageStop::wanted_look() const {
  return stages_.entries[stop_].kind == StageKind::iteration ? std::optional(within_) : std::nullopt;
}

void StageStop::finished(const Bodies&, int) {
  IMPINGE_ASSERT(stages_.entries[next_].kind == StageKind::end);
  if (next_ == stop_) return;
  ++next_;
  end_substep();
}

bool StageStop::wants_record(int substep, int) const {
  return stages_.entries[stop_].kind == StageKind::end && stages_.entries[stop_].substep == substep;
}

void StageStop::recorded(Bodies&, const StepRecord& so_far, int, int) {
  record_ = so_far;
  throw StageReached();
}

}  // namespace impinge
