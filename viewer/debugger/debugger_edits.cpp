// Changes of the model and the view, taken back and done again.
#include <fmt/format.h>
#include <algorithm>

#include "engine/core/error.hpp"
#include "viewer/controller/act_command.hpp"
#include "viewer/debugger/debugger.hpp"

namespace impinge {
namespace {

/// What was moved behind `frame`, and what was there.
template <class T>
void exchange_after(int frame, std::vector<T>& all, std::vector<T>& other) {
  const auto begin = all.begin() + std::min<std::ptrdiff_t>(frame + 1, std::ssize(all));
  std::vector<T> tail(std::make_move_iterator(begin), std::make_move_iterator(all.end()));
  all.erase(begin, all.end());
  all.insert(all.end(), std::make_move_iterator(other.begin()), std::make_move_iterator(other.end()));
  other = std::move(tail);
}
template <class T>
void exchange_after(int frame, T& all, T& other) {
  T tail(all.upper_bound(frame), all.end());
  all.erase(all.upper_bound(frame), all.end());
  all.insert(other.begin(), other.end());
  other = std::move(tail);
}

/// Looking about is nothing that one takes back.
bool is_look(const Command& command) {
  const auto* bodies = std::get_if<BodiesCommand>(&command);
  return std::holds_alternative<CameraCommand>(command) || (bodies != nullptr && bodies->verb == BodiesCommand::frame);
}

bool is_act(const Command& command) { return std::holds_alternative<Act>(command); }

/// Takes out what the new one makes idle: what says the same thing of the same row or body, and nothing was done in between
/// that it may count for.
void leave_out_idle(const Command& now, std::vector<Command>& commands) {
  if (const auto* act = std::get_if<Act>(&now)) {
    if (act->verb == Act::pull)
      std::erase_if(commands, [&](const Command& c) {
        const auto* before = std::get_if<Act>(&c);
        return before != nullptr && before->verb == Act::pull && before->body == act->body;
      });
    return;
  }
  const std::string& path = std::get<SetCommand>(now).path;
  const auto last_act = std::find_if(commands.rbegin(), commands.rend(), is_act).base();
  commands.erase(
      std::remove_if(last_act, commands.end(), [&](const Command& c) { return std::get<SetCommand>(c).path == path; }),
      commands.end());
}

}  // namespace

bool changes_model(const Command& command) {
  const auto* set = std::get_if<SetCommand>(&command);
  return is_act(command) || (set != nullptr && !set->path.starts_with("view."));
}

/// What was asked for by hand for the frame that is made next. Values are set as soon as they are asked for, and set
/// again here: a value set twice is the same value. What is done to a body is done here only; where a frame has both,
/// they count in their order, from the state before the first. False: that can't be had.
bool Debugger::do_by_hand(int frame) {
  const auto it = by_hand_.find(frame);
  if (it == by_hand_.end()) return true;
  const std::vector<Command> commands = it->second;  // the frames before may have to be made
  const auto acts = std::count_if(commands.begin(), commands.end(), is_act);
  if (acts > 0 && acts < std::ssize(commands)) {
    restore_before(frame - 1);
    while (session_.frame() < frame - 1 && advance()) {
    }
    if (session_.frame() < frame - 1) return false;
  }
  for (const Command& command : commands) session_.change(command);
  return true;
}

/// Values that were set by hand for the next frame are seen at once.
void Debugger::show_by_hand() {
  if (const auto it = by_hand_.find(session_.frame() + 1); it != by_hand_.end())
    for (const Command& command : it->second)
      if (!is_act(command)) session_.change(command);
}

/// The frames after it become others: what is known of them, and what they were to do, changes places with `future`.
void Debugger::exchange(Future& future) {
  const int frame = future.frame;
  breaks_.cut(frame + 1);
  if (stages_ && stages_->frame > frame) stages_.reset();
  ring_.cut(frame);
  tracks_.forget_after(frame);
  if (against_) against_->forget_after(frame);
  exchange_after(frame, by_hand_, future.by_hand);
  exchange_after(frame, changed_frames_, future.changed_frames);
  exchange_after(frame, history_, future.history);
  exchange_after(frame, own_, future.own);
  exchange_after(frame, hashes_, future.hashes);
  std::swap(folder_last_, future.folder_last);
}

/// Has the session know, from now on, the bodies that by_hand_ will add, and no others beside the script's.
void Debugger::list_added() {
  std::vector<Addition> added;
  for (const auto& [frame, commands] : by_hand_)
    for (const Command& command : commands)
      if (const auto* act = std::get_if<Act>(&command); act != nullptr && act->verb == Act::add)
        added.push_back({frame, *act});
  if (!session_.list_added(std::move(added))) return;
  if (model_.selection.kind == Selection::body && !model_.selection.is_there()) model_.selection = {};
  conditions_ = session_.condition_words();
  breaks_.read_again(conditions_);
}

/// What can only be said against bodies that a line by hand adds.
void Debugger::check_added(const PlacedText& line, const DebugLine& parsed) const {
  const auto* commands = std::get_if<std::vector<Command>>(&parsed);
  const Act* act = commands == nullptr || commands->empty() ? nullptr : std::get_if<Act>(&commands->front());
  if (act == nullptr || act->verb != Act::add) return;
  const std::vector<PlacedText> words = split_words(line);
  check_new_name(words[1], session_.rows());
  try {
    session_.check_added(*act);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", words[3].place(), error.what()));
  }
}

/// Why nothing that is done now could come to the body, where that is so: "which was deleted in frame 12"; else "". Values
/// may be given to one that is yet to come.
std::string Debugger::absence_of(const std::string& body, bool is_act) const {
  const int next = within_ ? frame() : session_.frame() + 1;
  const auto is_of = [&](const Command& command, Act::Verb verb) {
    const auto* act = std::get_if<Act>(&command);
    return act != nullptr && act->verb == verb && act->body == body;
  };
  const auto any = [&](const std::vector<Command>& commands, Act::Verb verb) {
    return std::any_of(commands.begin(), commands.end(), [&](const Command& c) { return is_of(c, verb); });
  };
  const auto pending = by_hand_.find(next);
  if (pending != by_hand_.end() && any(pending->second, Act::remove)) return "which is deleted by then";
  const auto it =
      std::find_if(shown().bodies.begin(), shown().bodies.end(), [&](const BodyRecord& b) { return b.name == body; });
  if (it != shown().bodies.end()) {
    if (!it->deleted) return "";
    for (int k = 0; k <= frame(); ++k)
      if (any(commands_at(k), Act::remove)) return fmt::format("which was deleted in frame {}", k);
    return "which is deleted";
  }
  if (!is_act || (pending != by_hand_.end() && any(pending->second, Act::add))) return "";
  return "which is added in a later frame only";
}

/// Nothing would come of what is done to a body that isn't there. A hand may let go of it.
void Debugger::check_there(const PlacedText& line, const DebugLine& parsed) const {
  const auto* commands = std::get_if<std::vector<Command>>(&parsed);
  if (commands == nullptr) return;
  for (const Command& command : *commands) {
    const auto* act = std::get_if<Act>(&command);
    if (is_look(command) || (act != nullptr && (act->verb == Act::add || act->verb == Act::release))) continue;
    for (const std::string& body : acted_on(command))
      if (const std::string why = absence_of(body, act != nullptr); !why.empty())
        split_words(line)[1].refuse(fmt::format("'{}', {}", body, why), "a body that is there is wanted",
                                    why.find("deleted") == std::string::npos ? "go on to that frame first"
                                                                             : "undo that, or go back to before it");
  }
}

/// Of a frame, those by hand first.
std::vector<Command> Debugger::commands_at(int frame) const {
  std::vector<Command> commands = session_.script().commands_at(frame);
  if (const auto it = by_hand_.find(frame); it != by_hand_.end())
    commands.insert(commands.begin(), it->second.begin(), it->second.end());
  return commands;
}

/// A body may be added where others are, and pushed where it isn't.
void Debugger::tell_of_acts(int frame) {
  const std::vector<Command> commands = commands_at(frame);
  for (const std::string& note :
       {overlap_note(commands, session_.record()), far_push_note(commands, session_.record())})
    if (!note.empty()) say(ConsoleLine::message, note);
}

void Debugger::do_command(const Command& command) {
  if (is_look(command)) return session_.change(command);
  Edit edit;
  bool is_in_past = false, is_last_of_drag = false;
  if (changes_model(command)) {
    if (within_) {
      reach(frame() - 1);
      say(ConsoleLine::message,
          fmt::format("back to the end of frame {}: the change counts from the next on", frame()));
    }
    const int next = session_.frame() + 1;
    is_in_past = next < static_cast<int>(hashes_.size());
    edit.future.emplace();
    edit.future->frame = session_.frame();
    edit.future->folder_last = std::min(folder_last_, session_.frame());  // its later frames are of another run now
    std::vector<Command> commands;
    if (const auto it = by_hand_.find(next); it != by_hand_.end()) commands = it->second;
    exchange(*edit.future);
    leave_out_idle(command, commands);
    commands.push_back(command);
    by_hand_[next] = std::move(commands);
    changed_frames_.insert(next);
    try {
      list_added();
    } catch (const InputError&) {  // there is no room for it: as it was
      exchange(*edit.future);
      list_added();
      throw;
    }
    if (const auto* act = std::get_if<Act>(&command)) {
      if (act->verb == Act::pull || act->verb == Act::release) edit.dragged = act->body;
      is_last_of_drag = act->verb == Act::release;
    } else {
      session_.change(command);
    }
  } else {
    const std::deque<Parameter>& rows = session_.rows().all();
    std::vector<std::pair<const Parameter*, ParameterValue>> before;
    for (const Parameter& row : rows)
      if (row.path.starts_with("view.")) before.emplace_back(&row, row.get());
    session_.change(command);
    for (auto& [row, value] : before)
      if (row->get() != value) edit.view.emplace_back(row, std::move(value));
    // lines that set the same are merged, so each has its own
    if (edit.view.empty() && !std::holds_alternative<SetCommand>(command)) return;
  }
  // a drag is one change, however many frames it takes
  const bool goes_on = !is_in_past && !edit.dragged.empty() && edits_.dragged() == edit.dragged;
  edits_.done(std::move(edit));
  if (goes_on) edits_.merge_last();
  if (is_last_of_drag) edits_.end_drag();
}

void Debugger::take_back(const UndoLine& line) {
  std::vector<Edit>& from = line.again ? edits_.undone() : edits_.done();
  if (from.empty()) return say(ConsoleLine::message, line.again ? "nothing was undone" : "nothing was changed yet");
  Edit edit = std::move(from.back());
  from.pop_back();
  if (edit.future) {
    Future& future = *edit.future;
    const bool was_later = frame() > future.frame;
    playing_ = false;
    if (frame() >= future.frame) {
      restore_before(future.frame);
      reach(future.frame);
    }
    exchange(future);
    list_added();
    if (session_.frame() == future.frame) show_by_hand();
    if (was_later)
      say(ConsoleLine::message, fmt::format("back to frame {}, after which that was changed", session_.frame()));
  }
  for (auto& [row, value] : edit.view) {
    ParameterValue now = row->get();
    row->set(value);
    value = std::move(now);
  }
  (line.again ? edits_.done() : edits_.undone()).push_back(std::move(edit));
  follow_selection();
}

}  // namespace impinge
