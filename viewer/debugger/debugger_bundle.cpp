// A moment of a session as a bundle, and back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "viewer/bundle/scene.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/debugger/debugger.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {
namespace {

std::string as_text(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

std::pair<BundleHead, std::map<std::string, std::string>> Debugger::bundle(const UiPointer& pointer) {
  const int home = frame(), place = within_ ? within_->place : -1;
  std::vector<std::string> by_hand;
  for (const auto& [frame, commands] : by_hand_)
    for (const Command& command : commands)
      if (!is_pending(frame)) by_hand.push_back(fmt::format("at {} {}", frame, format_command(command)));
  std::map<std::string, std::string> parts = bundled_scene(session_, start_, by_hand, home);
  parts["stats.csv"] = bundled_figures();
  parts["recording.script"] = as_text(recording(pointer));
  parts["opening.script"] = as_text(opening_lines());
  const auto add_state = [&] {
    parts[fmt::format("snapshots/{:06}.bin", session_.frame())] = format_snapshot(session_);
  };
  try {
    if (home > 0) {
      reach(home - 1);
      if (session_.frame() == home - 1) add_state();
      FrozenStep frozen;
      remake(home, nullptr, &frozen);
      parts[fmt::format("frozen/{:06}.step", home)] = format_frozen_step(frozen);
    }
    add_state();
    if (place >= 0) stand_in(home, place);
  } catch (const Interrupted&) {
    const InterruptScope finish(nullptr);
    restore_before(home);
    reach(home);
    throw;
  }
  BundleHead head;
  head.scene = std::filesystem::path(session_.run_record().scene).filename().string();
  head.frame = home;
  head.stage = place;
  head.state_hash = state_hash();
  return {std::move(head), std::move(parts)};
}

/// stats.csv up to the moment. A run of an older version may lack some of the columns.
std::string Debugger::bundled_figures() const {
  const bool judged = session_.is_judged();
  std::vector<std::vector<double>> rows;
  for (int k = 0; k <= frame(); ++k) rows.push_back(without_times(history_[static_cast<std::size_t>(k)], judged));
  std::string header;
  for (const Figure& figure : figures()) {
    const bool is_there = figure.is_hash() || std::find(figure_names(judged).begin(), figure_names(judged).end(),
                                                        figure.name) != figure_names(judged).end();
    if (!is_there) continue;
    const std::size_t place = figure.is_hash() ? 0 : figure_index(figure.name, judged);
    if (std::all_of(rows.begin(), rows.end(), [&](const auto& row) { return !std::isnan(row[place]); }))
      header += (header.empty() ? "" : ",") + std::string(figure.name);
  }
  const StatsShape shape = session_.stats_shape();
  for (const std::string& name : *shape.own) header += "," + name;
  const StatsColumns columns(header, shape);
  std::string text = header + "\n";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::vector<double> own = own_[k];
    for (std::size_t c = 0; c < own.size(); ++c)
      if (shape.own->at(c).ends_with("_ms")) own[c] = 0.0;  // as without_times()
    text += columns.row(rows[k], hashes_[k], own) + "\n";
  }
  return text;
}

/// What was set at the moment, and counts from the next frame on.
bool Debugger::is_pending(int by_hand) const { return !within_ && by_hand == session_.frame() + 1; }

/// What shows the same again at the moment: what was set there, the view, the panels, breakpoints and the selection.
std::vector<std::string> Debugger::opening_lines() const {
  std::vector<std::string> lines;
  for (const auto& [frame, commands] : by_hand_)
    for (const Command& command : commands)
      if (is_pending(frame)) lines.push_back(format_command(command));
  for (const Parameter& row : session_.rows().all())
    if (row.path.starts_with("view.") && row.path != "view.camera.distance" &&  // which follows from eye and target
        row.live && row.set && row.get() != first_.find(row.path)->get())
      lines.push_back(format_command(SetCommand{row.path, row.get()}));
  for (const std::vector<std::string>* done : {&opened_, &recorded_})
    for (const std::string& line : *done) {
      if (line == "break off") std::erase_if(lines, [](const std::string& old) { return old.starts_with("break "); });
      if (line.starts_with("panel ") || line.starts_with("break when ")) lines.push_back(line);
    }
  const Selection& s = model_.selection;
  if (s.kind == Selection::contact && s.is_there()) lines.push_back(fmt::format("select contact {}", s.index));
  if (s.kind == Selection::body && s.is_there())
    lines.push_back(fmt::format("select body {}{}", shown().bodies[static_cast<std::size_t>(s.index)].name,
                                s.triangle < 0 ? "" : fmt::format(" {}", s.triangle)));
  return lines;
}

void Debugger::open_at(const BundleHead& moment, const std::vector<std::string>& lines) {
  const bool keeps_states = moment.version == IMPINGE_VERSION;
  if (!keeps_states)
    say(ConsoleLine::message, fmt::format("the bundle is of version {}, this is {}: its frames are made again",
                                          moment.version, IMPINGE_VERSION));
  jump(moment.frame);
  for (int k = 1; k <= frame(); ++k)
    if (!session_.script().commands_at(k).empty()) changed_frames_.insert(k);
  if (moment.stage >= 0 && frame() == moment.frame) stand_in(moment.frame, moment.stage);
  for (const std::string& line : lines)
    if (!line.empty()) try_execute(line);
  opened_ = lines;
  edits_.forget();
  playing_ = false;
  recorded_.clear();
  std::erase_if(model_.console, [](const ConsoleLine& line) { return line.kind == ConsoleLine::command; });
}

}  // namespace impinge
