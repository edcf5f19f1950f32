#include "viewer/debugger/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "viewer/debugger/session_scopes.hpp"
#include "viewer/draw/number_text.hpp"
#include "viewer/state/state_differences.hpp"

namespace impinge {
namespace {

/// The farthest position, or else the first field.
std::string words_of(const std::vector<FieldDifference>& fields) {
  if (fields.empty()) return "in what is kept between frames, no position or velocity yet";
  const auto nearer = [](const FieldDifference& l, const FieldDifference& r) {
    return std::pair(l.unit == "m", l.unit == "m" ? l.largest : 0.0) <
           std::pair(r.unit == "m", r.unit == "m" ? r.largest : 0.0);
  };
  const FieldDifference& most = *std::max_element(fields.begin(), fields.end(), nearer);
  std::string text = fmt::format("{}'s {}", most.body, most.field);
  if (!most.unit.empty()) text += fmt::format(" by {}", number_text(most.largest, most.unit).whole());
  if (!most.where.empty()) text += fmt::format(" ({})", most.where);
  return text;
}

/// The first stage of which not the same is told; "": none.
std::string words_of(const FrameStages& a, const FrameStages& b) {
  const std::size_t both = std::min(a.entries.size(), b.entries.size());
  for (std::size_t i = 0; i < both; ++i) {
    const StageEntry &of_a = a.entries[i], &of_b = b.entries[i];
    if (of_a.kind == of_b.kind && of_a.substep == of_b.substep && of_a.words == of_b.words && of_a.count == of_b.count)
      continue;
    const std::string at = a.substeps == b.substeps ? fmt::format("sub-step {} of {}, ", of_a.substep, a.substeps)
                                                    : fmt::format("sub-step {} of {} in A and {} in B, ", of_a.substep,
                                                                  a.substeps, b.substeps);
    if (of_a.kind != of_b.kind) return at + fmt::format("{} in A, {} in B", name_of(of_a.kind), name_of(of_b.kind));
    if (of_a.words == of_b.words)
      return at + fmt::format("{}: {} steps in A, {} in B", name_of(of_a.kind), of_a.count, of_b.count);
    return at + fmt::format("{}: {} in A, {} in B", name_of(of_a.kind), of_a.words, of_b.words);
  }
  if (a.entries.size() != b.entries.size())
    return fmt::format("{} stages in A, {} in B", a.entries.size(), b.entries.size());
  return "";
}

}  // namespace

Against::Against(const AgainstSource& source, const SessionOptions& options)
    : session_(source.scene, source.overrides, source.script, options) {
  model_.label = source.label;
}

bool Against::advance() {
  ByteWriter before;
  const bool is_begun = session_.frame() >= 0;
  if (is_begun) session_.save(before);
  const auto take_back = [&] {
    const InterruptScope finish(nullptr);
    ByteReader state(before.bytes());
    if (is_begun) session_.restore(state);
  };
  StageList list(session_.world());
  const WatchScope watch(session_, is_begun && first_ < 0 ? &list : nullptr);
  try {
    session_.advance();
  } catch (const DivergenceError& error) {
    take_back();
    model_.ended = fmt::format("B diverged after frame {}: {}", session_.frame(), error.what());
    return false;
  } catch (const Interrupted&) {
    take_back();
    throw;
  }
  if (is_begun && first_ < 0) stages_ = list.take();
  hashes_.push_back(session_.record().stats.state_hash);
  model_.tracks.note(session_.record());
  return true;
}

void Against::compare(const std::vector<std::uint64_t>& hashes, int frame) {
  const int known = static_cast<int>(std::min(hashes.size(), hashes_.size()));
  for (; first_ < 0 && same_ < known && same_ <= frame; ++same_)
    if (hashes[static_cast<std::size_t>(same_)] != hashes_[static_cast<std::size_t>(same_)]) {
      first_ = same_;
      is_news_ = true;
      fields_.clear();
      return;
    }
}

void Against::reach(const StepRecord& a, const std::vector<std::uint64_t>& hashes, int frame) {
  model_.bodies.clear();  // A may have others than before
  for (const BodyRecord& body : a.bodies) model_.bodies.push_back(session_.world().bodies().find(body.name));
  compare(hashes, frame);
  while (model_.ended.empty() && session_.frame() < frame && advance()) compare(hashes, frame);
  if (session_.frame() == frame) compare_places(a, frame);
}

/// In what they differ first; and, where nothing is elsewhere yet, when something is.
void Against::compare_places(const StepRecord& a, int frame) {
  const bool is_first = is_news_ && first_ == frame;
  if (!is_first && (same_place_ < 0 || frame <= same_place_ || apart_ >= 0)) return;
  const std::vector<FieldDifference> fields = field_differences(a, session_.record());
  const bool is_elsewhere =
      std::any_of(fields.begin(), fields.end(), [](const FieldDifference& f) { return f.unit == "m"; });
  if (is_first) {
    fields_ = words_of(fields);
    if (!is_elsewhere) same_place_ = frame;
  } else if (is_elsewhere) {
    apart_ = frame;
    const bool is_next = frame == same_place_ + 1;
    apart_fields_ = fmt::format("positions differ from frame {} on{}: {}", frame, is_next ? "" : " at the latest",
                                words_of(fields));
  } else {
    same_place_ = frame;
  }
}

void Against::forget_after(int frame) {
  same_ = std::min(same_, frame + 1);
  if (first_ > frame) first_ = -1, is_news_ = false, same_place_ = -1, model_.parted.clear();
  if (same_place_ > frame) same_place_ = frame;
  if (apart_ > frame) apart_ = -1, model_.apart.clear();
}

std::optional<int> Against::take_news() {
  if (!is_news_) return std::nullopt;
  is_news_ = false;
  return first_;
}

void Against::take_fields(const StepRecord& a) {
  FieldDifference most{"", "position", "m", 0.0, ""};
  for (const BodyRecord& body : a.bodies) {
    const std::optional<Pose> there = model_.pose(first_, BodyIndex(&body - a.bodies.data()));
    const double apart = there ? (body.pose.position - there->position).norm() : 0.0;
    if (apart > most.largest) most.body = body.name, most.largest = apart;
  }
  if (most.largest > 0.0) fields_ = words_of({most});
}

std::string Against::take_apart() {
  if (apart_fields_.empty()) return "";
  return model_.apart = std::exchange(apart_fields_, {});
}

const std::string& Against::tell(int frame, const FrameStages* stages) {
  std::string& text = model_.parted;
  text = fmt::format("A and B ({}) differ from frame {} on", model_.label, frame);
  if (!fields_.empty()) text += ": " + fields_;
  if (stages == nullptr || stages_.frame != frame) return text;
  const std::string stage = words_of(*stages, stages_);
  text += stage.empty() ? "; as far as is told, all stages did the same work" : "; first in " + stage;
  return text;
}

}  // namespace impinge
