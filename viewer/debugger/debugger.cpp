#include "viewer/debugger/debugger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/world/record_parts.hpp"
#include "viewer/bundle/scene.hpp"
#include "viewer/controller/run_folder.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/debugger/session_scopes.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kConsoleLines = 500;

std::string word_of(const std::string& line, int n) {
  std::size_t begin = 0;
  for (; n > 0 && begin < line.size(); --n) begin = std::min(line.find(' ', begin), line.size() - 1) + 1;
  return line.substr(begin, line.find(' ', begin) - begin);
}

}  // namespace

Debugger::Debugger(const fs::path& scene, const std::vector<std::string>& overrides, const fs::path& script,
                   const DebuggerOptions& options)
    : interrupted_(options.interrupted),
      progress_(options.progress),
      session_(scene, overrides, script, options.session),
      ring_(options.most_bytes),
      start_(values_of(session_.rows())),
      run_folder_(options.run_folder),
      conditions_(session_.condition_words()),
      expectations_(session_.script(), session_.is_judged(), false,
                    [this](const std::string& text) { say(ConsoleLine::problem, text); }),
      breaks_(session_.is_judged()) {
  for (const Script::Break& point : session_.script().breaks()) breaks_.add(point.condition, point.place);
  model_.scene = (run_folder_.empty() ? session_.scene().path : run_folder_).filename().string();
  if (!options.name.empty()) model_.scene = options.name;
  if (!run_folder_.empty()) read_run_folder();
  if (!options.against.scene.empty()) against_.emplace(options.against, options.session);
  session_.rows().find("view.panel.figures")->set(false);  // the panels say it
  // a panel, plots and conditions are of it
  if (std::none_of(overrides.begin(), overrides.end(), [](const auto& o) { return o.starts_with("record.ledger"); }))
    session_.rows().find("record.ledger")->set(true);
  if (const std::string note = note_of_former_paths(); !note.empty()) say(ConsoleLine::message, note);
  if (!advance()) return;
  first_ = values_of(session_.rows());
  look_through(0);
  if (const std::optional<BreakHit> hit = breaks_.next(0, 0)) stop_at(0, *hit);
}

void Debugger::read_run_folder() {
  const fs::path file = run_folder_ / "stats.csv";
  const std::string text = read_file(file, std::uint64_t{1} << 32);
  std::vector<StatsLine> rows = whole_rows(text, session_.stats_shape());
  // a run that was cut off may have ended within a line, but not before one
  if (const auto lines = std::count(text.begin(), text.end(), '\n'); rows.empty() || std::ssize(rows) + 1 < lines)
    throw InputError(
        fmt::format("{}:{}: this line is no whole row of a frame; a run's table is wanted; run the scene again",
                    file.string(), rows.empty() ? 1 : rows.size() + 2));
  for (StatsLine& row : rows) {
    hashes_.push_back(std::stoull(row.state_hash, nullptr, 16));
    history_.push_back(std::move(row.figures));
    own_.push_back(std::move(row.own));
  }
  folder_last_ = static_cast<int>(rows.size()) - 1;
}

void Debugger::check_hash(int frame) {
  const std::uint64_t before = hashes_[static_cast<std::size_t>(frame)], now = session_.record().stats.state_hash;
  if (before == now || told_of_hash_) return;
  told_of_hash_ = true;  // what follows differs too
  if (frame <= folder_last_)
    say(ConsoleLine::problem,
        fmt::format("frame {} came out as {:016x}; stats.csv has {:016x}: another program, machine or mesh made it",
                    frame, now, before));
  else
    say(ConsoleLine::problem,
        fmt::format("frame {} came out as {:016x}, not {:016x} as before: a bug of impinge", frame, now, before));
}

/// To a frame whose state is kept, with what the script has for it that is of the view.
bool Debugger::bring_back(int frame) {
  if (frame >= static_cast<int>(hashes_.size())) return false;
  if (!ring_.has(frame) && !(frame <= folder_last_ && is_valid_snapshot(snapshot_file(frame)))) return false;
  restore_before(frame);
  const std::vector<Command> commands = session_.script().commands_at(frame);
  if (!commands.empty()) changed_frames_.insert(frame);
  for (const Command& command : commands)
    if (!changes_model(command)) session_.change(command);
  return true;
}

bool Debugger::advance() {
  const int next = session_.frame() + 1;
  const bool looks = next > 0 && !breaks_.empty() && !breaks_.know(next);
  if (next > 0 && !looks && bring_back(next)) {
    note_frame();
    return true;
  }
  if (!do_by_hand(next)) return false;
  if (looks) breaks_.forget_begun();
  const WatchScope watch(session_, looks ? &breaks_ : nullptr);
  try {
    if (!session_.advance().empty()) changed_frames_.insert(next);
  } catch (const Interrupted&) {
    if (next == 0) throw;  // there is no state yet
    playing_ = false;
    was_ended_ = true;
    const InterruptScope finish(nullptr);
    restore_before(next - 1);
    return false;
  } catch (const DivergenceError& error) {
    playing_ = false;
    say(ConsoleLine::problem, fmt::format("diverged: {}", error.what()));
    restore_before(next - 1);
    while (session_.frame() < next - 1 && advance()) {
    }
    return false;
  }
  note_frame();
  if (looks) breaks_.end(next, history_[static_cast<std::size_t>(next)], session_.record(), session_.bodies());
  return true;
}

void Debugger::note_frame() {
  const StepRecord& record = session_.record();
  const auto frame = static_cast<std::size_t>(session_.frame());
  tracks_.note(record);
  std::vector<double> figures = figure_values(record.stats, session_.is_judged());
  if (frame < hashes_.size()) {
    check_hash(session_.frame());
  } else {
    own_.push_back(session_.own_values(figures));
    history_.push_back(std::move(figures));
    hashes_.push_back(record.stats.state_hash);
    expectations_.check(
        session_.frame(), [this](const Expression& condition) { return values_here(condition); }, session_.bodies(),
        [] { return fs::path(); });
    tell_of_acts(session_.frame());
  }
  if (!ring_.has(session_.frame())) {
    ByteWriter state;
    session_.save(state);
    ring_.put(session_.frame(), state.bytes());
    ++puts_;
  }
  reach_against();
  follow_selection();
}

void Debugger::restore_before(int frame) {
  within_.reset();
  const KeptView view(session_);
  const std::optional<int> in_memory = ring_.at_or_before(frame);
  // which reads files
  const std::optional<int> in_folder = in_memory == frame ? std::nullopt : last_snapshot_before(frame);
  if (in_folder && (!in_memory || *in_folder > *in_memory)) {
    restore_snapshot(snapshot_file(*in_folder), session_);
  } else {
    ByteReader state(ring_.state(*in_memory));
    session_.restore(state);
  }
}

fs::path Debugger::snapshot_file(int frame) const {
  return run_folder_ / "snapshots" / fmt::format("{:06}.bin", frame);
}

std::optional<int> Debugger::last_snapshot_before(int frame) const {
  for (int k = std::min(frame, folder_last_); k >= 0; --k)
    if (is_valid_snapshot(snapshot_file(k))) return k;
  return std::nullopt;
}

void Debugger::do_transport(const TransportLine& line) {
  switch (line.verb) {
    case TransportLine::play:
      playing_ = true;
      break;
    case TransportLine::pause:
      playing_ = false;
      break;
    case TransportLine::step:
      if (line.unit != TransportLine::frame) return step_within(line.unit, line.frames);
      go_on(frame() + line.frames);
      break;
    case TransportLine::back:
      if (line.unit != TransportLine::frame) return back_within(line.unit, line.frames);
      seek(std::max(0, frame() - line.frames));
      break;
    case TransportLine::seek:
      seek(line.frames);
  }
}

void Debugger::do_select(Selection s) {
  if (s.kind == Selection::body) s.place = s.index;
  if (s.kind == Selection::contact) s.pair_id = shown().contacts[static_cast<std::size_t>(s.index)].pair_id;
  model_.selection = s;
  model_.state.is_selected_sought = s.is_there();
}

void Debugger::follow_selection() {
  model_.state.is_selected_sought = false;  // rows change places with every frame: nobody goes after them
  Selection& s = model_.selection;
  if (s.kind == Selection::body) s.index = s.place < std::ssize(shown().bodies) ? s.place : -1;
  if (s.kind != Selection::contact) return;
  const std::vector<ContactRecord>& contacts = shown().contacts;
  const auto it =
      std::find_if(contacts.begin(), contacts.end(), [&](const ContactRecord& c) { return c.pair_id == s.pair_id; });
  s.index = it == contacts.end() ? -1 : static_cast<int>(it - contacts.begin());
}

void Debugger::do_panel(const PanelLine& line) { take(line, model_.state); }

void Debugger::check(const PlacedText& line) {
  if (line.text.starts_with("select contact")) return;  // how many there are depends on the frame
  // so does who is there of those that lines before this one add
  if (names_one_of(std::string(line.text), announced_)) return;
  const DebugLine parsed =
      parse_debug_line(line, {session_.rows(), shown(), figure_names(session_.is_judged()), conditions_});
  check_added(line, parsed);
  if (line.text.starts_with("add ")) announced_.emplace(split_words(line)[1].text);
}

std::optional<DebugLine> Debugger::execute(const PlacedText& line) {
  DebugLine parsed =
      parse_debug_line(line, {session_.rows(), shown(), figure_names(session_.is_judged()), conditions_});
  if (std::holds_alternative<InputLine>(parsed) || std::holds_alternative<FileLine>(parsed) ||
      std::holds_alternative<FreezeLine>(parsed) || std::holds_alternative<ExportLine>(parsed) ||
      std::holds_alternative<QuitLine>(parsed))
    return parsed;
  check_added(line, parsed);
  check_there(line, parsed);
  known_before_ = static_cast<int>(hashes_.size());
  puts_before_ = puts_;
  stopped_ = was_ended_ = false;
  const int before = frame();
  if (const auto* commands = std::get_if<std::vector<Command>>(&parsed)) {
    for (const Command& command : *commands) do_command(command);
    const std::string path = word_of(std::string(line.text), 1);
    if (session_.rows().renamed(path) != nullptr) {  // recorded as it is written today
      say(ConsoleLine::message, session_.rows().note_of_former({path}));
      for (const Command& command : *commands) record(format_command(command));
      return std::nullopt;
    }
  }
  if (const auto* transport = std::get_if<TransportLine>(&parsed)) do_transport(*transport);
  if (const auto* point = std::get_if<BreakLine>(&parsed)) do_break(*point);
  if (const auto* condition = std::get_if<FindLine>(&parsed)) find(*condition);
  if (const auto* pair = std::get_if<WhyLine>(&parsed)) {
    if (frame() == 0) line.refuse("why at frame 0, which no step made", "a later frame is wanted", "step on first");
    why(*pair);
  }
  if (const auto* select = std::get_if<SelectLine>(&parsed)) do_select(select->selection);
  if (const auto* panel = std::get_if<PanelLine>(&parsed)) do_panel(*panel);
  if (const auto* undo = std::get_if<UndoLine>(&parsed)) take_back(*undo);
  // a line that was cut short is recorded as what it did
  const auto* transport = std::get_if<TransportLine>(&parsed);
  std::string done(line.text);
  const int made = std::max(1, frame() - before);
  const bool by_frames = transport != nullptr && transport->unit == TransportLine::frame;
  if (by_frames && stopped_ && transport->verb == TransportLine::step && made < transport->frames)
    done = fmt::format("step {}", made);
  else if ((by_frames && stopped_ && transport->verb == TransportLine::seek) ||
           ((was_ended_ || is_interrupted()) && (transport != nullptr || std::holds_alternative<FindLine>(parsed))))
    done = fmt::format("seek {}", frame());
  record(done);
  tell_of_against();
  return std::nullopt;
}

std::optional<DebugLine> Debugger::try_execute(const std::string& line) {
  static const std::string kConsole = "console";
  try {
    return execute({line, &kConsole, 1, 1});
  } catch (const InputError& error) {
    say(ConsoleLine::problem, error.what());
    return std::nullopt;
  }
}

bool Debugger::execute_meanwhile(const std::string& line) {
  static const std::string kConsole = "console";
  const auto leaves_model_alone = [](const DebugLine& parsed) {
    if (const auto* commands = std::get_if<std::vector<Command>>(&parsed))
      return std::none_of(commands->begin(), commands->end(), changes_model);
    const auto* transport = std::get_if<TransportLine>(&parsed);
    return std::holds_alternative<SelectLine>(parsed) || std::holds_alternative<PanelLine>(parsed) ||
           (transport != nullptr && transport->verb == TransportLine::pause);
  };
  try {
    const DebugLine parsed = parse_debug_line(
        {line, &kConsole, 1, 1}, {session_.rows(), shown(), figure_names(session_.is_judged()), conditions_});
    if (!leaves_model_alone(parsed)) return false;
  } catch (const InputError&) {
    return false;  // said when its turn comes
  }
  const auto outer = std::tuple(known_before_, puts_before_, stopped_, was_ended_);
  try_execute(line);
  std::tie(known_before_, puts_before_, stopped_, was_ended_) = outer;
  return true;
}

bool Debugger::play_on() {
  if (!playing_) return false;
  known_before_ = static_cast<int>(hashes_.size());
  puts_before_ = puts_;
  stopped_ = false;
  const int before = frame();
  go_on(before + 1);
  if (frame() > before || stopped_) record("step");
  tell_of_against();
  return true;
}

void Debugger::say(ConsoleLine::Kind kind, const std::string& text) {
  may_merge_ = kind == ConsoleLine::command;
  model_.console.push_back({kind, text});
  if (model_.console.size() > kConsoleLines) model_.console.erase(model_.console.begin());
}

void Debugger::add_recorded(const std::string& line) {
  recorded_.push_back(line);
  say(ConsoleLine::command, line);
}

void Debugger::replace_recorded(const std::string& line) {
  recorded_.back() = line;
  model_.console.back().text = line;
}

/// Of lines that follow each other only the sum or the last is kept, but only where that comes to the same to the last
/// bit: the frames that are known and the states that are kept show too.
void Debugger::record(const std::string& line) {
  const std::string verb = word_of(line, 0);
  if (verb == "play" || verb == "pause") return;  // what counts is how many frames were made
  const std::string unit = word_of(line, 1);
  if (verb == "seek" || (verb == "step" && unit != "stage" && unit != "substep")) return record_transport(line);
  trace_ = other;
  if (verb == "camera" && word_of(line, 1) != "fov") return record_camera();
  if (may_merge_ && !recorded_.empty() && word_of(recorded_.back(), 0) == verb &&
      word_of(recorded_.back(), 1) == word_of(line, 1)) {
    const std::string what = verb == "panel" ? word_of(line, 1) : "";
    if (verb == "set") edits_.merge_last();
    if (verb == "set" || verb == "pull" || what == "filter" || what == "search" ||
        (what == "scroll" && word_of(recorded_.back(), 2) == word_of(line, 2)))
      return replace_recorded(line);
  }
  add_recorded(line);
}

void Debugger::record_transport(const std::string& line) {
  const std::string verb = word_of(line, 0);
  const int known = static_cast<int>(hashes_.size()), made = known - known_before_;
  const auto frames = [](const std::string& text) {
    return text.find(' ') == std::string::npos ? 1 : std::stoi(word_of(text, 1));
  };
  // a `break` would cut the sum of two lines short where it did the first
  const Trace trace = stopped_                                          ? other
                      : known == known_before_ && puts_ == puts_before_ ? none
                      : verb == "step" && made == frames(line)          ? new_frames
                                                                        : other;
  const bool same = may_merge_ && !recorded_.empty() && word_of(recorded_.back(), 0) == verb;
  if (same && verb == "step" && trace == trace_ && trace != other)
    return replace_recorded(fmt::format("step {}", frames(recorded_.back()) + frames(line)));
  const bool replaces = same && verb == "seek" && trace_ == none;
  trace_ = trace;
  if (replaces)
    replace_recorded(line);
  else
    add_recorded(line);
}

/// Where the camera is, whatever moved it there.
void Debugger::record_camera() {
  const Camera& camera = view().camera;
  const auto line = [](const char* what, const Vec3& v) {
    return fmt::format("camera {} {} {} {}", what, shortest(v.x()), shortest(v.y()), shortest(v.z()));
  };
  const std::string eye = line("eye", camera.eye), target = line("target", camera.target);
  const std::size_t n = recorded_.size(), shown = model_.console.size();
  if (may_merge_ && n >= 2 && shown >= 2 && recorded_[n - 1].starts_with("camera target") &&
      recorded_[n - 2].starts_with("camera eye") && model_.console[shown - 2].text == recorded_[n - 2]) {
    recorded_[n - 2] = model_.console[shown - 2].text = eye;
    return replace_recorded(target);
  }
  add_recorded(eye);
  add_recorded(target);
}

void Debugger::record_picture(const std::string& line, const UiPointer& pointer) {
  if (pointer.is_there()) add_recorded(pointer.line());
  if (playing_) add_recorded("play");  // the button shows it
  add_recorded(line);
  if (playing_) add_recorded("pause");
}

std::vector<std::string> Debugger::recording(const UiPointer& pointer) const {
  std::vector<std::string> lines = recorded_;
  if (pointer.is_there()) lines.push_back(pointer.line());
  if (playing_) lines.push_back("play");
  return lines;
}

const DebugModel& Debugger::model() {
  model_.record = &shown();
  model_.rows = &session_.rows();
  model_.rows_present = session_.rows_present();
  model_.view = &view();
  model_.frame = frame();
  model_.stages = within_ ? &*stages_ : nullptr;
  model_.place = within_ ? within_->place : 0;
  model_.known_last = static_cast<int>(hashes_.size()) - 1;
  model_.playing = playing_;
  model_.figure_names = &figure_names(session_.is_judged());
  model_.asked.clear(), model_.coming.clear();
  if (const auto it = by_hand_.find(session_.frame() + 1); it != by_hand_.end() && !within_)
    for (const Command& command : it->second)
      if (const auto* act = std::get_if<Act>(&command)) model_.asked.push_back(*act);
  const Bodies& bodies = session_.world().bodies();
  for (const Act& act : model_.asked)
    if (act.verb == Act::add) model_.coming.push_back({record_of(bodies[bodies.find(act.body)]), act.like});
  model_.history = &history_;
  model_.tracks = &tracks_;
  model_.against = against_ ? &against_->model() : nullptr;
  model_.changed_frames = &changed_frames_;
  model_.commands_of = [this](int frame) {
    std::vector<std::string> lines;
    for (const Command& command : commands_at(frame)) lines.push_back(format_command(command));
    return lines;
  };
  model_.snapshots = ring_.count();
  model_.snapshot_bytes = ring_.bytes();
  model_.most_snapshot_bytes = ring_.most();
  return model_;
}

}  // namespace impinge
