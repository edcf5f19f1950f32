// How the debugger gets about: frame by frame, into a frame and about in it, and where it is stopped on the way.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/world/pair_watch.hpp"
#include "engine/world/stage_watch.hpp"
#include "viewer/debugger/debugger.hpp"
#include "viewer/debugger/session_scopes.hpp"

namespace impinge {
namespace {

constexpr int kEnd = 1 << 30;  // of a frame: more places, and more sub-steps, than one has

/// Places of a frame that steps of the unit come to.
std::vector<int> stops_of(const FrameStages& stages, TransportLine::Unit unit) {
  std::vector<int> stops;
  if (unit == TransportLine::substep)
    for (int s = 1; s <= stages.substeps; ++s) stops.push_back(stages.end_of(s));
  else
    for (int place = 0; place < stages.places(); ++place) stops.push_back(place);
  return stops;
}

}  // namespace

/// To the end of a frame that is known, or can be made from here.
void Debugger::reach(int frame) {
  if (!within_ && session_.frame() == frame) return;
  if (within_ || session_.frame() > frame) restore_before(frame);
  while (session_.frame() < frame && advance()) {
  }
  follow_selection();
}

/// Without a look at breakpoints.
void Debugger::jump(int to) {
  const int from = frame();
  const bool known = to < static_cast<int>(hashes_.size());
  if (within_ || to < from ||
      (known && std::max(ring_.at_or_before(to).value_or(0), last_snapshot_before(to).value_or(0)) > from)) {
    restore_before(to);
    check_hash(session_.frame());
    tracks_.note(session_.record());
  }
  if (session_.frame() < std::min(to, folder_last_) && !told_of_missing_) {
    told_of_missing_ = true;
    say(ConsoleLine::message,
        fmt::format("the run kept no state of frame {}: made again from frame {}", to, session_.frame()));
  }
  while (session_.frame() < to && !is_interrupted() && advance())
    if (progress_) progress_(session_.frame(), to);
  if (progress_ && session_.frame() < to) progress_(to, to);  // cut short: nothing more to show
  follow_selection();
}

void Debugger::seek(int to) {
  if (to < frame())
    jump(to);
  else
    go_on(to);
}

/// Forward, as far as breakpoints let it.
void Debugger::go_on(int to) {
  if (breaks_.empty()) return jump(to);
  int at = frame(), after = within_ ? stages_->ended_at(within_->place) : kEnd;
  if (within_) look_through(at);
  for (;;) {
    if (const std::optional<BreakHit> hit = breaks_.next(at, after)) {
      if (progress_) progress_(to, to);
      return stop_at(at, *hit);
    }
    if (at >= to || is_interrupted()) break;
    if (!breaks_.know(at + 1)) {
      reach(at);
      if (session_.frame() != at || !advance()) break;
      if (progress_) progress_(session_.frame(), to);
    }
    ++at;
    after = 0;
  }
  if (progress_ && at < to) progress_(to, to);
  reach(at);
}

void Debugger::stop_at(int frame, BreakHit hit) {
  if (hit.is_end())
    reach(frame);
  else
    stand_in(frame, stages_of(frame).end_of(hit.substep));
  if (hit.values.empty()) hit.values = values_here(breaks_.points()[hit.point].condition);
  say(ConsoleLine::problem, breaks_.tell(frame, hit));
  playing_ = false;
  stopped_ = true;
}

/// What a condition's names stand for where the debugger stands.
std::vector<double> Debugger::values_here(const Expression& condition) {
  const bool judged = session_.is_judged();
  if (!within_)
    return reader_.values(condition, history_[static_cast<std::size_t>(session_.frame())], session_.record(),
                          session_.bodies());
  const int ended = stages_->ended_at(within_->place);
  std::vector<double> figures = ended > 0 ? figure_values(stages_->figures[static_cast<std::size_t>(ended) - 1], judged)
                                          : history_[static_cast<std::size_t>(stages_->frame) - 1];
  return reader_.values(condition, figures, shown(), session_.bodies());
}

/// Makes a frame that is known once more, from the one before; afterwards the session is at its end, or where the watcher
/// left it by an exception. The view stays as it is.
void Debugger::remake(int frame, StepWatcher* watcher, FrozenStep* frozen) {
  const KeptView view(session_);
  reach(frame - 1);
  if (session_.frame() != frame - 1) throw Interrupted{};
  if (!do_by_hand(frame)) throw Interrupted{};
  const WatchScope watch(session_, watcher);
  session_.advance(frozen);
  check_hash(frame);
}

const FrameStages& Debugger::stages_of(int frame) {
  if (stages_ && stages_->frame == frame) return *stages_;
  StageList list(session_.world());
  remake(frame, &list);
  stages_ = list.take();
  return *stages_;
}

/// In the middle of a frame that is known; its last place is its end.
void Debugger::stand_in(int frame, int place) {
  try {
    const FrameStages& stages = stages_of(frame);
    if (place >= stages.places() - 1) return reach(frame);
    StageStop stop(session_.world(), stages, place);
    try {
      remake(frame, &stop);
      throw InternalError("a stage of a frame was not come by again");
    } catch (const StageReached&) {
      within_ = Within{place, stop.record()};
    }
    follow_selection();
  } catch (const Interrupted&) {
    const InterruptScope finish(nullptr);
    restore_before(frame);
    reach(frame);
  }
}

/// Has breakpoints that were set since look at a frame that is known.
void Debugger::look_through(int frame) {
  if (breaks_.empty() || breaks_.know(frame)) return;
  const int place = within_ ? within_->place : kEnd;
  breaks_.forget_begun();
  if (frame > 0) remake(frame, &breaks_);
  breaks_.end(frame, history_[static_cast<std::size_t>(frame)], session_.record(), session_.bodies());
  if (place != kEnd) stand_in(frame, place);
}

void Debugger::step_within(TransportLine::Unit unit, int count) {
  int at = frame(), place = within_ ? within_->place : kEnd;
  while (!is_interrupted()) {
    if (place != kEnd) {
      look_through(at);
      const FrameStages& stages = stages_of(at);
      const std::vector<int> stops = stops_of(stages, unit);
      const auto next = std::upper_bound(stops.begin(), stops.end(), place);
      const auto left = stops.end() - next;
      const int to = count <= left ? *(next + count - 1) : stages.places() - 1;
      if (const std::optional<BreakHit> hit = breaks_.next(at, place < 0 ? 0 : stages.ended_at(place));
          hit && stages.end_of(hit->substep) <= to)
        return stop_at(at, *hit);
      if (count <= left) return stand_in(at, to);
      count -= static_cast<int>(left);
    }
    reach(at);
    if (session_.frame() != at || !advance()) return;
    ++at;
    place = -1;
  }
}

void Debugger::back_within(TransportLine::Unit unit, int count) {
  int at = frame(), place = within_ ? within_->place : kEnd;
  while (at > 0 && !is_interrupted()) {
    const FrameStages& stages = stages_of(at);
    const std::vector<int> stops = stops_of(stages, unit);
    const auto left =
        std::lower_bound(stops.begin(), stops.end(), std::min(place, stages.places() - 1)) - stops.begin();
    if (count <= left) return stand_in(at, stops[static_cast<std::size_t>(left - count)]);
    count -= static_cast<int>(left) + 1;  // and the frame's start, which is the end of the one before
    --at;
    place = kEnd;
    if (count == 0) break;
  }
  reach(at);
}

void Debugger::do_break(const BreakLine& line) {
  if (!line.condition) return breaks_.clear();
  breaks_.add(*line.condition, line.place);
  const int ended = within_ ? stages_->ended_at(within_->place) : 0;
  const int looked_at = within_ && ended == 0 ? frame() - 1 : frame();
  const std::optional<BreakHit> hit = breaks_.look_at_last(looked_at, ended, values_here(*line.condition));
  if (!hit) return;
  say(ConsoleLine::problem, breaks_.tell(frame(), *hit));
  playing_ = false;
}

/// Through all that is known, from the first frame on, as far as where the condition holds.
void Debugger::find(const FindLine& line) {
  const int home = frame(), last = static_cast<int>(hashes_.size()) - 1;
  const int place = within_ ? within_->place : kEnd;
  Breakpoints search(session_.is_judged());
  search.add(line.condition, "");
  for (int k = 0; k <= last && !is_interrupted(); ++k) {
    try {
      if (k == 0)
        reach(0);
      else
        remake(k, &search);
    } catch (const Interrupted&) {
      break;
    }
    search.end(k, history_[static_cast<std::size_t>(k)], session_.record(), session_.bodies());
    const std::optional<BreakHit> hit = search.next(k, 0);
    if (progress_) progress_(hit ? last : k, last);
    if (!hit) continue;
    if (hit->is_end())
      reach(k);
    else
      stand_in(k, stages_of(k).end_of(hit->substep));
    say(ConsoleLine::message,
        fmt::format("{} first holds in frame {}{}; {}", line.condition.text(), k,
                    hit->is_end() ? "" : fmt::format(", sub-step {} of {}", hit->substep, hit->substeps),
                    line.condition.describe(hit->values, figure_names(session_.is_judged()))));
    return follow_selection();
  }
  const InterruptScope finish(nullptr);
  within_.reset();
  restore_before(home);
  reach(home);
  if (place != kEnd && !is_interrupted()) stand_in(home, place);
  if (!is_interrupted())
    say(ConsoleLine::message, fmt::format("{} holds in none of frames 0 to {}", line.condition.text(), last));
}

/// What detection made of two bodies in the sub-step in work, or in the last one of the frame.
void Debugger::why(const WhyLine& line) {
  const int home = frame();
  const int place = within_ ? within_->place : kEnd;
  const std::optional<int> substep =
      place != kEnd ? std::optional(stages_->entries[stages_->entry_at(place).first].substep) : std::nullopt;
  PairWatch watch(session_.world(), BodyIndex(line.a), BodyIndex(line.b), PairWatch::Asked{home, substep});
  remake(home, &watch);
  if (const std::optional<PairVerdict>& v = watch.verdict()) {
    const FilterVerdict* stop = v->stopped_by();
    std::string text = fmt::format("{} and {}, frame {}, sub-step {} of {}: ", v->name_a, v->name_b, v->frame,
                                   v->substep, v->substeps);
    if (v->in_contact())
      text += fmt::format("{} contact{}", v->contacts.size(), v->contacts.size() == 1 ? "" : "s");
    else
      text +=
          fmt::format("no contact{}{}", stop != nullptr ? ", because of " : "", stop != nullptr ? stop->filter : "");
    say(ConsoleLine::message, text);
    for (const FilterVerdict& filter : v->filters)
      if (!filter.words.empty())
        say(ConsoleLine::message,
            fmt::format("{}{}: {}", filter.filter, &filter == stop ? " stops it" : "", filter.words));
  }
  if (place != kEnd) stand_in(home, place);
}

void Debugger::reach_against() {
  if (!against_ || within_) return;
  try {
    against_->reach(session_.record(), hashes_, session_.frame());
  } catch (const Interrupted&) {  // B goes on from where it is when A goes on
  }
}

/// What was found on the way of how B differs. The frame is made once more, so that its stages can be told apart.
void Debugger::tell_of_against() {
  reach_against();  // frames that were brought back were not made
  if (!against_) return;
  if (const std::string& ended = against_->model().ended; !ended.empty() && !told_of_b_) {
    told_of_b_ = true;
    say(ConsoleLine::message, ended);
  }
  const std::optional<int> first = against_->take_news();
  if (!first) {
    if (const std::string apart = against_->take_apart(); !apart.empty())
      say(ConsoleLine::message, "A and B: " + apart);
    return;
  }
  const int home = frame();
  const int place = within_ ? within_->place : kEnd;
  const FrameStages* stages = nullptr;
  try {
    if (*first > 0) stages = &stages_of(*first);
    if (against_->lacks_fields()) {
      reach(*first);
      if (session_.frame() == *first) against_->take_fields(session_.record());
    }
  } catch (const Interrupted&) {
    const InterruptScope finish(nullptr);
    restore_before(*first);
  }
  say(ConsoleLine::message, against_->tell(*first, stages));
  if (const std::string apart = against_->take_apart(); !apart.empty()) say(ConsoleLine::message, "A and B: " + apart);
  reach(home);
  if (place != kEnd) stand_in(home, place);
}

void Debugger::freeze(const std::filesystem::path& file) {
  const int home = frame();
  const int place = within_ ? within_->place : kEnd;
  FrozenStep frozen;
  remake(home, nullptr, &frozen);
  write_frozen_step(file, frozen);
  if (place != kEnd) stand_in(home, place);
}

}  // namespace impinge
