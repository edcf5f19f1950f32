// Changes of the model and the view, taken back and done again.
#include <fmt/format.h>
#include <algorithm>

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

}  // namespace

bool changes_model(const Command& command) {
  const auto* set = std::get_if<SetCommand>(&command);
  return set != nullptr && !set->path.starts_with("view.");
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
  exchange_after(frame, hashes_, future.hashes);
  std::swap(folder_last_, future.folder_last);
}

void Debugger::do_command(const Command& command) {
  if (is_look(command)) return session_.change(command);
  Edit edit;
  if (changes_model(command)) {
    if (within_) {
      reach(frame() - 1);
      say(ConsoleLine::message,
          fmt::format("back to the end of frame {}: the change counts from the next on", frame()));
    }
    const int next = session_.frame() + 1;
    edit.future.emplace();
    edit.future->frame = session_.frame();
    edit.future->folder_last = std::min(folder_last_, session_.frame());  // its later frames are of another run now
    std::vector<Command> commands;
    if (const auto it = by_hand_.find(next); it != by_hand_.end()) commands = it->second;
    exchange(*edit.future);
    std::erase_if(commands,
                  [&](const Command& c) { return std::get<SetCommand>(c).path == std::get<SetCommand>(command).path; });
    commands.push_back(command);
    by_hand_[next] = std::move(commands);
    changed_frames_.insert(next);
    session_.change(command);
  } else {
    const std::vector<Parameter>& rows = session_.rows().all();
    std::vector<std::pair<const Parameter*, ParameterValue>> before;
    for (const Parameter& row : rows)
      if (row.path.starts_with("view.")) before.emplace_back(&row, row.get());
    session_.change(command);
    for (auto& [row, value] : before)
      if (row->get() != value) edit.view.emplace_back(row, std::move(value));
    // lines that set the same are merged, so each has its own
    if (edit.view.empty() && !std::holds_alternative<SetCommand>(command)) return;
  }
  edits_.done(std::move(edit));
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
    if (const auto it = by_hand_.find(future.frame + 1); it != by_hand_.end() && session_.frame() == future.frame)
      for (const Command& command : it->second) session_.change(command);
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
