#include "viewer/notes/watchdog_note.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/notes/note_archive.hpp"

namespace impinge {
namespace {

constexpr double kDeep = 0.1;    // of a thickness: an overlap that is worth a word
constexpr double kSunk = 0.5;    // of a thickness: from there on contacts no longer know the way out
constexpr double kStood = 0.01;  // of how far two approached: what moved less stood still beside the other
constexpr std::size_t kNamed = 4;

constexpr double kMostSubsteps = 1000;  // that the parameter takes

/// It passed on a way on which contacts are mostly seen: its length tells nothing of what would help.
bool is_within_safe(const UnsafeBody& body) { return body.approach <= body.safe; }

/// What makes sub-steps so short that the two approach by no more than is safe in each.
std::string enough_substeps(const UnsafeBody& body, int substeps) {
  if (is_within_safe(body)) return "take more simulation.substeps";
  const double wanted = std::ceil(substeps * body.approach / body.safe);
  if (wanted <= kMostSubsteps) return fmt::format("simulation.substeps = {:.0f}", wanted);
  return fmt::format("divide simulation.frame_time by {:.0f}", std::ceil(body.approach / body.safe));
}

std::string remedy(const UnsafeBody& body, int substeps) {
  switch (body.cause) {
    case UnsafeBody::unwatched:
      return "set narrow_phase.continuous = \"auto\", or " + enough_substeps(body, substeps);
    case UnsafeBody::soft_contact:
      return "choose a response.method that lets nothing overlap, or " + enough_substeps(body, substeps);
    case UnsafeBody::held_back:
    case UnsafeBody::cut_limit:
      return "the sub-step was cut as often as it may be: take more simulation.substeps";
  }
  return "";
}

std::string place_of(int frame, int substep) {
  return substep > 0 ? fmt::format("in frame {}, sub-step {}", frame, substep) : fmt::format("in frame {}", frame);
}

/// The other body, in quotes; of a body that met itself, that.
std::string other_of(const UnsafeBody& body) {
  return body.other == body.name ? "itself" : fmt::format("'{}'", body.other);
}

std::string and_more(std::size_t count) {
  return count == 0 ? "" : fmt::format(" (and {} more bod{})", count, count == 1 ? "y" : "ies");
}

}  // namespace

void WatchdogNote::add(const FrameStats& stats) {
  if (stats.crossing.share() > deepest_.share()) deepest_ = stats.crossing, deepest_frame_ = stats.frame;
  if (stats.unsafe_motions == 0) return;
  for (const UnsafeBody& body : stats.unsafe) {
    Seen& seen = bodies_.try_emplace(body.name, Seen{body, stats.frame, stats.substeps}).first->second;
    if (body.has_passed && !seen.what.has_passed) seen = {body, stats.frame, stats.substeps};
  }
  if (frames_++ == 0) first_frame_ = stats.frame;
}

void WatchdogNote::add_earlier(int frame, double unsafe_motions) {
  if (!(unsafe_motions > 0.0)) return;  // a table of an older version has no such number
  if (frames_++ == 0) first_frame_ = frame;
}

void WatchdogNote::keep(NoteArchive& archive) {
  archive.map(bodies_, [&](Seen& seen) {
    UnsafeBody& what = seen.what;
    archive.keep(what.name, what.other, what.cause, what.substep, what.displacement, what.approach, what.safe,
                 what.has_passed, seen.frame, seen.substeps);
  });
  archive.keep(frames_, first_frame_);
  archive.keep(deepest_.a, deepest_.b, deepest_.depth, deepest_.thickness, deepest_.substep, deepest_frame_);
}

bool WatchdogNote::is_deep() const { return judged_ && deepest_.share() > kDeep; }

bool WatchdogNote::is_sunk() const { return !judged_ && deepest_.share() > kSunk; }

/// Those that passed first, then by time; what stood still is named as the other one.
std::vector<const WatchdogNote::Seen*> WatchdogNote::worth_naming() const {
  std::vector<const Seen*> list;
  for (const auto& [name, seen] : bodies_)
    if (seen.what.displacement > kStood * seen.what.approach) list.push_back(&seen);
  std::stable_sort(list.begin(), list.end(), [](const Seen* l, const Seen* r) {
    return std::tuple(!l->what.has_passed, l->frame, l->what.substep) <
           std::tuple(!r->what.has_passed, r->frame, r->what.substep);
  });
  return list;
}

std::string WatchdogNote::how_deep() const {
  return fmt::format("'{}' and '{}' {} {:.3g} m, {:.0f} % of {:.3g} m, {}", deepest_.a, deepest_.b, kDeepMark,
                     deepest_.depth, 100.0 * deepest_.share(), deepest_.thickness,
                     place_of(deepest_frame_, deepest_.substep));
}

std::string WatchdogNote::text() const {
  std::string lines;
  const std::vector<const Seen*> named = worth_naming();
  for (std::size_t i = 0; i < std::min(named.size(), kNamed); ++i) {
    const UnsafeBody& body = named[i]->what;
    const std::string where = place_of(named[i]->frame, body.substep), way = fmt::format("{:.3g} m", body.displacement);
    if (body.has_passed)
      lines += fmt::format("note:     '{}' passed through {} {}: it moved {}", body.name, other_of(body), where, way);
    else if (body.cause == UnsafeBody::held_back)
      lines += fmt::format("note:     '{}' stood still before {} {}, where it would have moved {} and through",
                           body.name, other_of(body), where, way);
    else
      lines += fmt::format("note:     '{}' moved {} beside {} {} and may have passed it", body.name, way,
                           other_of(body), where);
    if (!is_within_safe(body)) lines += fmt::format(", {:.3g} m are safe", body.safe);
    lines += fmt::format("; {}\n", remedy(body, named[i]->substeps));
  }
  if (named.size() > kNamed)
    lines += fmt::format("note:     so did {} more, in {} frame{} in all; unsafe_motions in stats.csv counts them\n",
                         named.size() - kNamed, frames_, frames_ == 1 ? "" : "s");
  if (is_sunk() && frames_ > 0) lines += fmt::format("note:     {} by their contacts\n", how_deep());
  return lines;
}

std::string WatchdogNote::closing_line() const {
  if (!judged_ && !has_barked()) return "";
  if (!judged_ && frames_ == 0) return fmt::format("watch:    {} by their contacts; --judge measures it\n", how_deep());
  std::vector<const Seen*> named = worth_naming();
  const bool has_passed = !named.empty() && named.front()->what.has_passed;
  if (has_passed) std::erase_if(named, [](const Seen* seen) { return !seen->what.has_passed; });
  const bool was_held = !has_passed && !named.empty() && named.front()->what.cause == UnsafeBody::held_back;
  std::string passes = "nothing passed";
  if (has_passed || was_held || (!judged_ && !named.empty())) {
    const Seen& first = *named.front();
    const std::string_view did = has_passed ? kPassedMark : was_held ? "was held back from" : "may have passed";
    passes = fmt::format("'{}' {} {} {}{}", first.what.name, did, other_of(first.what),
                         place_of(first.frame, first.what.substep), and_more(named.size() - 1));
  } else if (named.empty() && frames_ > 0) {
    passes = fmt::format("{} in {} frame{} before the run was resumed, the first {}", kUnseenMark, frames_,
                         frames_ == 1 ? "" : "s", first_frame_);
  }
  if (!judged_) return fmt::format("watch:    {}{}\n", passes, has_passed || was_held ? "" : "; --judge tells whether");
  if (!is_deep())
    return fmt::format("judge:    {}, nothing overlaps by more than {:.0f} % of a thickness\n", passes, 100.0 * kDeep);
  return fmt::format("judge:    {}{}{}\n", has_passed ? passes : "", has_passed ? "; " : "", how_deep());
}

}  // namespace impinge
