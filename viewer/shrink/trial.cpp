#include "viewer/shrink/trial.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/io/file.hpp"
#include "engine/step/watcher_list.hpp"
#include "engine/world/frame_judge.hpp"
#include "viewer/bundle/scene.hpp"
#include "viewer/controller/breakpoints.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/present/png_sequence.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

std::size_t triangles_of(const Scene& scene) {
  std::size_t sum = 0;
  for (const SurfaceFile& file : scene.surfaces) sum += file.triangles;
  return sum;
}

/// The condition, at its place in the command line.
Expression read_condition(const std::string& text, const ExpressionWords& words) {
  static const std::string kOption = "--when";
  return Expression({text, &kOption, 1, 1}, words);
}

}  // namespace

Trials::Trials(fs::path folder, std::string condition, std::vector<std::string> opening)
    : folder_(std::move(folder)), condition_(std::move(condition)), opening_(std::move(opening)) {
  std::erase_if(opening_,
                [](const std::string& line) { return line.starts_with("break ") || line.starts_with("select "); });
}

std::unique_ptr<Session> Trials::load(const SmallScene& scene) {
  write_file(folder_ / "run.toml", scene.run_toml());
  return std::make_unique<Session>(folder_ / "run.toml", std::vector<std::string>(), fs::path());
}

std::optional<Trial> Trials::run(Session& session, const SmallScene& scene, int last_frame) {
  ++tried_;
  const ParameterSet start = values_of(session.rows());
  const bool judged = session.is_judged();
  FrameJudge overlap(session.is_judged_by_substep() ? FrameJudge::each_substep : FrameJudge::each_frame);
  Breakpoints breaks(judged);
  breaks.add(read_condition(condition_, session.condition_words()), "--when");
  WatcherList watchers;
  if (judged) watchers.add(&overlap);
  watchers.add(&breaks);
  session.watch(&watchers);
  const StatsColumns columns(session.stats_shape());
  std::string table = columns.header() + "\n";
  for (int frame = 0; frame <= last_frame; ++frame) {
    session.advance();
    FrameStats stats = session.record().stats;
    if (judged) overlap.judge(session.world().bodies(), stats);
    const std::vector<double> figures = figure_values(stats, judged);
    const std::vector<double> timeless = without_times(figures, judged);
    table += columns.row(timeless, stats.state_hash, session.own_values(timeless)) + "\n";
    breaks.end(frame, figures, session.record(), session.bodies());
    if (!breaks.next(frame, 0)) continue;
    session.watch(nullptr);
    Trial trial{scene, frame, triangles_of(session.scene()), {}, bundled_scene(session, start, {}, frame)};
    trial.scene.scene.surfaces = session.scene().surfaces;  // of bodies that are left
    trial.parts["stats.csv"] = std::move(table);
    trial.parts[fmt::format("snapshots/{:06}.bin", frame)] = format_snapshot(session);
    std::string opening;
    for (const std::string& line : opening_)
      if (!names_one_of(line, scene.gone)) opening += line + "\n";
    trial.parts["opening.script"] = opening;
    trial.head.scene = scene.run.scene;
    trial.head.frame = frame;
    trial.head.state_hash = stats.state_hash;
    return trial;
  }
  return std::nullopt;
}

std::optional<Trial> Trials::run(const SmallScene& scene, int last_frame) {
  try {
    const std::unique_ptr<Session> session = load(scene);
    return run(*session, scene, last_frame);
  } catch (const OutputError&) {
    throw;
  } catch (const InputError&) {
    return std::nullopt;  // what is left is no scene
  } catch (const DivergenceError&) {
    return std::nullopt;
  }
}

Trial Trials::first(const fs::path& run_toml, int last_frame) {
  Session session(run_toml, {}, {});
  const SmallScene scene(session);
  const auto trial = run(session, scene, last_frame);
  if (!trial)
    throw InputError(
        fmt::format("--when: {} doesn't come true in frames 0 to {} of the bundle; a condition that does is wanted; "
                    "debug the bundle and look, or change it",
                    condition_, last_frame));
  return *trial;
}

std::optional<SmallScene> Trials::begun_at(const SmallScene& scene, int frame) {
  const std::unique_ptr<Session> session = load(scene);
  session->advance();
  std::vector<Pose> start;
  for (const BodyRecord& body : session->record().bodies) start.push_back(body.file_pose);
  while (session->frame() < frame) session->advance();
  return scene.begun_at(frame, session->record(), start);
}

std::optional<SmallScene> Trials::begun_with(const SmallScene& scene, int frame) {
  const std::unique_ptr<Session> session = load(scene);
  while (session->frame() < frame) session->advance();
  const fs::path state = folder_ / fmt::format("start_{}.bin", frame);
  write_snapshot(state, *session);
  return scene.begun_with(frame, state.string());
}

std::optional<SmallScene> Trials::with_bodies(const SmallScene& scene, const std::vector<std::string>& names) {
  return with_state_of(scene, scene.with_bodies(names));
}

std::optional<SmallScene> Trials::without_added(const SmallScene& scene, const std::string& name) {
  return with_state_of(scene, scene.without({name}));
}

std::optional<SmallScene> Trials::with_state_of(const SmallScene& scene, const SmallScene& less) {
  if (scene.run.start.empty()) return less;
  try {
    const std::unique_ptr<Session> all = load(scene);
    // what lines do comes after it, but for bodies that they add and that the state has
    SmallScene bare = less.begun_anew(all->world().time(), all->record(), "");
    bare.run.script = bare.additions_at_start();
    const std::unique_ptr<Session> left = load(bare);
    left->take_over(*all);
    left->advance();
    const fs::path state = folder_ / fmt::format("left_{}.bin", ++states_);
    write_snapshot(state, *left);
    return less.begun_anew(all->world().time(), all->record(), state.string());
  } catch (const OutputError&) {
    throw;
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const DivergenceError&) {
    return std::nullopt;
  }
}

void Trials::complete(Trial& trial) {
  const std::unique_ptr<Session> session = load(trial.scene);
  while (session->frame() < trial.frame - 1) session->advance();
  FrozenStep frozen;
  if (trial.frame > 0) {
    trial.parts[fmt::format("snapshots/{:06}.bin", trial.frame - 1)] = format_snapshot(*session);
    session->advance(&frozen);
    trial.parts[fmt::format("frozen/{:06}.step", trial.frame)] = format_frozen_step(frozen);
  } else {
    session->advance();
  }
  try {
    session->view().open(trial.scene.run.scene);
  } catch (const InputError&) {
    return;  // nothing draws here
  }
  session->view().draw(session->record(), {}, folder_);
  session->view().finish();
  trial.parts["picture.png"] = read_file(folder_ / "frames" / PngSequence::file_name(trial.frame), 1u << 28);
}

}  // namespace impinge
