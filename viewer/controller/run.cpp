#include "viewer/controller/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/io/paths.hpp"
#include "engine/step/watcher_list.hpp"
#include "engine/world/frame_judge.hpp"
#include "viewer/controller/act_command.hpp"
#include "viewer/controller/breakpoints.hpp"
#include "viewer/controller/expectations.hpp"
#include "viewer/controller/recorded_run.hpp"
#include "viewer/controller/run_folder.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/export/exports.hpp"
#include "viewer/image/label.hpp"

namespace impinge {

namespace {

RunRecord record_of(const RunOptions& options, const Session& session, int last_frame) {
  RunRecord record = session.run_record();
  record.frames = last_frame;
  record.images = options.images;
  record.ids = options.ids;
  record.contacts = options.contacts;
  record.export_ply = options.export_ply;
  record.width = options.width;
  record.height = options.height;
  return record;
}

SessionOptions session_options(const RunOptions& options) {
  SessionOptions session;
  session.width = options.width, session.height = options.height;
  session.judge = options.judge, session.judge_substeps = options.judge_substeps;
  session.pictures_may_be_missing = !options.compares_pictures;
  return session;
}

bool asks_the_ledger(const Expression& condition) {
  return std::any_of(condition.terms().begin(), condition.terms().end(),
                     [](const BodyTerm& term) { return term.function == BodyFunction::energy_from; });
}

/// What would be no number in every frame, and never hold.
void check_ledger(const Session& session) {
  if (session.world().parameters.record.ledger) return;
  const Script& script = session.script();
  for (int frame = 0; frame <= script.last_frame(); ++frame)
    for (const Command& command : script.commands_at(frame))
      if (const auto* set = std::get_if<SetCommand>(&command); set != nullptr && set->path == "record.ledger") return;
  const auto check = [](const Expression& condition, const std::string& place) {
    if (asks_the_ledger(condition))
      throw InputError(place + ": energy_from, and no books of energy are kept; record.ledger = true is wanted; add " +
                       "--set record.ledger=true, or at 0 set record.ledger true");
  };
  for (const Script::Expectation& expectation : script.expectations()) check(expectation.condition, expectation.place);
  for (const Script::Break& point : script.breaks()) check(point.condition, point.place);
  for (const Expression& column : session.own_columns().expressions()) check(column, session.place_of_columns());
}

/// A run that goes on from its own run.toml writes what it wrote so far, without being asked again.
RunOptions as_begun(RunOptions options, const Session& session) {
  if (!options.resume || !session.scene().run) return options;
  std::error_code error;
  if (!std::filesystem::equivalent(options.scene, options.out / "run.toml", error)) return options;
  const RunRecord& begun = *session.scene().run;
  options.ids |= begun.ids, options.contacts |= begun.contacts, options.export_ply |= begun.export_ply;
  options.images &= begun.images;
  return options;
}

RunStart start_of(const RunOptions& options) {
  return options.resume ? RunStart::resume : options.force ? RunStart::force : RunStart::anew;
}

/// Processor time of this thread so far, milliseconds.
double thread_cpu_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Makes the next frame, and adds what it took.
std::vector<Command> timed_advance(Session& session, FrozenStep* frozen, double& step_cpu_ms) {
  const double begin = thread_cpu_ms();
  std::vector<Command> commands = session.advance(frozen);
  step_cpu_ms += thread_cpu_ms() - begin;
  return commands;
}

void tell_of_former_paths(const RunWatcher& watcher, const Session& session) {
  const std::string note = session.note_of_former_paths();
  if (!note.empty() && watcher.message) watcher.message("note: " + note);
}

/// Of captions of the scene and of its script.
void tell_of_letters(const RunWatcher& watcher, const Session& session) {
  std::string texts = session.view().settings().caption;
  for (const Command* command : session.script().commands())
    if (const auto* set = std::get_if<SetCommand>(command); set != nullptr && set->path == "view.caption.text")
      if (const auto* text = std::get_if<std::string>(&set->value)) texts += *text;
  if (texts.empty()) return;  // and no letters are made
  const std::string missing = missing_letters(texts);
  if (!missing.empty() && watcher.message)
    watcher.message(
        fmt::format("note: view.caption.text has '{}', for which there are no letters: pictures show '?'", missing));
}

void tell_of_scene(const RunOptions& options, const RunWatcher& watcher, const Session& session) {
  tell_of_former_paths(watcher, session);
  if (options.images) tell_of_letters(watcher, session);
}

/// What the command line asks and the scene cannot give.
void check_options(const RunOptions& options, const Session& session, int last_frame) {
  if (!options.images && !session.script().images().empty())
    throw InputError(session.script().images().front().place +
                     ": 'expect image' in a run without pictures; pictures are wanted; leave out --no-images");
  if (!options.images && options.ids)
    throw InputError("command line: --ids in a run without pictures; pictures are wanted; leave out --no-images");
  if (options.freeze && (*options.freeze < 1 || *options.freeze > last_frame))
    throw InputError(
        fmt::format("command line: --freeze is {}; a frame from 1 to {} is wanted, since frame 0 has no response; "
                    "change it, or --frames",
                    *options.freeze, last_frame));
  check_ledger(session);
}

Exports open_exports(const RunOptions& options, const Session& session, int last_frame) {
  ExportJob job = session.export_job();
  job.folder = options.out / "export";
  job.option = "--export";
  job.frames = last_frame + 1;
  return {options.exports, job, session.world().record_of_all()};
}

/// Of a run that goes on the frame to be frozen is not behind it, unless it was frozen then.
void check_freeze(const RunOptions& options, const RunFolder& folder) {
  if (options.freeze && *options.freeze <= folder.resume_frame() && !is_there(folder.frozen_step(*options.freeze)))
    throw InputError(
        fmt::format("command line: --freeze is {}; the run goes on after frame {}, and a later frame is wanted; choose "
                    "one, or another --out",
                    *options.freeze, folder.resume_frame()));
}

void tell_of_acts(const RunWatcher& watcher, int frame, std::span<const Command> commands, const StepRecord& record) {
  for (const std::string& note : {overlap_note(commands, record), far_push_note(commands, record)})
    if (!note.empty() && watcher.note) watcher.note(fmt::format("note: frame {}: {}", frame, note));
}

/// What the script expects of frames, and what ends the run.
class Conditions {
 public:
  Conditions(const RunOptions& options, const RunWatcher& watcher, const RunFolder& folder, const Session& session)
      : folder_(folder),
        watcher_(watcher),
        expectations_(session.script(), session.is_judged(), options.compares_pictures, watcher.message),
        breaks_(session.is_judged()) {
    for (const Script::Break& point : session.script().breaks()) breaks_.add(point.condition, point.place);
  }

  Breakpoints& breaks() { return breaks_; }
  Expectations& expectations() { return expectations_; }

  void check(int frame, std::span<const double> figures, Session& made) {
    expectations_.check(
        frame,
        [&](const Expression& condition) { return reader_.values(condition, figures, made.record(), made.bodies()); },
        made.bodies(), [&] { return folder_.picture(frame); });
  }
  /// The first that is true ends the run.
  bool stop(int frame, std::span<const double> figures, Session& made) {
    breaks_.end(frame, figures, made.record(), made.bodies());
    const std::optional<BreakHit> hit = breaks_.next(frame, 0);
    if (hit && watcher_.message) watcher_.message(breaks_.tell(frame, *hit));
    breaks_.forget_before(frame);
    return hit.has_value();
  }

 private:
  const RunFolder& folder_;
  const RunWatcher& watcher_;
  Expectations expectations_;
  Breakpoints breaks_;
  ConditionReader reader_;
};

/// Whether it may give energy to a scene by itself: what is done to bodies, and parameters of gravity and of bodies but
/// those that only take.
bool may_give_energy(const Command& command) {
  if (std::holds_alternative<Act>(command)) return true;
  const auto* set = std::get_if<SetCommand>(&command);
  if (set == nullptr) return false;
  if (set->path == "simulation.gravity") return true;
  constexpr std::string_view kTaking[] = {".friction", ".restitution", ".material.damping_alpha",
                                          ".material.damping_beta"};
  return set->path.starts_with("body.") &&
         std::none_of(std::begin(kTaking), std::end(kTaking), [&](auto ending) { return set->path.ends_with(ending); });
}

bool any_gives_energy(std::span<const Command> commands) {
  return std::any_of(commands.begin(), commands.end(), may_give_energy);
}

void tell_of_frame(const RunWatcher& watcher, const FrameStats& stats, int last_frame,
                   std::span<const Command> commands, const World& world) {
  if (watcher.frame) watcher.frame(stats, last_frame);
  if (watcher.world) watcher.world(world, any_gives_energy(commands));
}

void tell_of_picture(const RunWatcher& watcher, const StepRecord& record, const FrameView& view) {
  if (watcher.picture) watcher.picture(record, view.settings(), view.width(), view.height());
}

EarlierFrame earlier_frame(int frame, std::span<const double> figures, const Session& session) {
  const auto figure = [&](const char* name) { return figures[figure_index(name, session.is_judged())]; };
  return {frame,
          figure("unsafe_motions"),
          figure("kinetic_J"),
          figure("elastic_J"),
          figure("potential_J"),
          any_gives_energy(session.script().commands_at(frame))};
}

/// Goes on where an earlier process was interrupted: the figures of its frames are kept, and what asks for more of them
/// gets them made again.
void take_up(const RunFolder& folder, const RunWatcher& watcher, Session& session, Conditions& conditions,
             Exports& exports) {
  const std::string notes = restore_snapshot(folder.snapshot(folder.resume_frame()), session);
  std::optional<RecordedRun> earlier;
  for (int frame = 0; frame <= folder.resume_frame(); ++frame) {
    check_interrupt();
    const std::vector<double>& figures = folder.kept()[frame].figures;
    if (watcher.earlier_frame) watcher.earlier_frame(earlier_frame(frame, figures, session));
    const bool is_made = !exports.is_empty() || conditions.expectations().asks_of_bodies(frame);
    if (is_made) {
      if (!earlier) earlier.emplace(folder.path());
      earlier->go_to(frame);
    }
    if (!exports.is_empty()) exports.add(earlier->record());
    conditions.check(frame, figures, is_made ? earlier->session() : session);
  }
  if (watcher.restore) watcher.restore(notes);
}

}  // namespace

int RunResult::exit_code() const {
  if (!diverged.empty()) return 3;
  if (interrupted) return 130;
  return failures > 0 || stopped_by_break ? 1 : 0;
}

RunResult run(const RunOptions& given, const RunWatcher& watcher) {
  FolderLock::check_free(given.out);  // at once, however long the scene takes to read
  Session session(given.scene, given.overrides, given.script, session_options(given));
  const RunOptions options = as_begun(given, session);
  const int last_frame = options.frames.value_or(session.default_last_frame());
  check_options(options, session, last_frame);
  const RunRecord record = record_of(options, session, last_frame);
  Exports exports = open_exports(options, session, last_frame);
  FrameView& view = session.view();
  if (options.images) view.open(session.scene_file().filename().string(), options.ids);
  RunFolder folder(options.out, record, format_run(session.scene(), session.rows(), record), start_of(options),
                   options.snapshot_megabytes << 20, session.stats_shape());

  tell_of_scene(options, watcher, session);
  RunResult result;
  result.frames_per_second = 1.0 / session.world().parameters.simulation.frame_time;
  const bool judged = result.is_judged = session.is_judged();
  Conditions conditions(options, watcher, folder, session);
  FrameJudge overlap(session.is_judged_by_substep() ? FrameJudge::each_substep : FrameJudge::each_frame);
  WatcherList watchers;
  if (judged) watchers.add(&overlap);
  if (!conditions.breaks().empty()) watchers.add(&conditions.breaks());
  if (!watchers.empty()) session.watch(&watchers);
  bool stop = false;
  check_freeze(options, folder);
  if (folder.resume_frame() >= 0) {
    result.resumed_from = result.last_frame = folder.resume_frame();
    take_up(folder, watcher, session, conditions, exports);
  }
  const auto make_frame = [&] {
    FrozenStep frozen;
    const bool freezes = options.freeze && session.frame() + 1 == *options.freeze;
    const std::vector<Command> commands = timed_advance(session, freezes ? &frozen : nullptr, result.step_cpu_ms);
    FrameStats stats = session.record().stats;
    if (judged) overlap.judge(session.world().bodies(), stats);
    check_figures(stats, judged);
    const int frame = session.frame();
    tell_of_acts(watcher, frame, commands, session.record());
    stats.times.render_ms = options.images ? view.draw(session.record(), commands, folder.path()) : 0.0;
    if (options.images) tell_of_picture(watcher, session.record(), view);
    if (freezes) {
      folder.add_frozen_step(frozen);
      result.frozen_step = folder.frozen_step(frame);
      result.frozen_contacts = frozen.contacts(), result.frozen_groups = frozen.groups.size();
    }
    const std::vector<double> figures = figure_values(stats, judged);
    folder.add_frame(session.record(), commands, stats, session.own_values(figures));
    exports.add(session.record());
    result.last_frame = frame;
    tell_of_frame(watcher, stats, last_frame, commands, session.world());
    if (options.images && conditions.expectations().needs_picture(frame)) view.finish();
    conditions.check(frame, figures, session);
    result.stopped_by_break = stop = conditions.stop(frame, figures, session);
    if (!stop)  // a run that is resumed makes this frame again, and stops again
      folder.add_snapshot(session, watcher.save ? watcher.save() : "");
  };
  try {
    while (!stop && result.last_frame < last_frame) {
      check_interrupt();
      make_frame();
    }
  } catch (const Interrupted&) {
    result.interrupted = true;
  } catch (const DivergenceError& error) {
    result.diverged = error.what();
  }
  if (thread_count() != 1 || result.resumed_from >= 0) result.step_cpu_ms = -1.0;
  view.finish();
  exports.finish();
  result.exported = exports.results();
  result.failures = conditions.expectations().failures();
  if (result.diverged.empty()) result.crushed = find_crushed(session.world().bodies());
  if (result.diverged.empty() && !result.interrupted) {
    conditions.expectations().tell_rest(result.last_frame);
    if (watcher.whole) watcher.whole(result);
    folder.finish(result.step_cpu_ms);
  }
  result.lock = folder.hand_over_lock();
  return result;
}

}  // namespace impinge
