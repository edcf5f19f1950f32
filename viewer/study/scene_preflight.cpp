#include "viewer/study/scene_preflight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/memory.hpp"
#include "engine/core/units.hpp"

namespace impinge {
namespace {

constexpr double kMostSeconds = 60.0;
constexpr double kAheadSeconds = 12.0;  // more than a frame may take
constexpr int kAheadFrames = 120;
constexpr double kShortestFrame = 1e-6;  // s, that the parameter takes

}  // namespace

Preflight preflight_of(const Session& session, const Trial* trial) {
  const SceneAtStart scene{session.scene(), session.world(), session.rows(), find_enclosures(session.world().bodies()),
                           trial};
  const bool camera_given = scene.scene.has("view.camera.eye") || scene.scene.has("view.camera.target");
  return preflight(scene, {session.world(), session.view().settings(), camera_given}, session.silenced());
}

Trial try_scene(const Session& session, const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                const std::filesystem::path& script) {
  const Parameters::Simulation& p = session.world().parameters.simulation;
  const int made = std::clamp(static_cast<int>(std::ceil(kShortestFrame / p.time_step())), 1, p.substeps);
  std::vector<std::string> all = overrides;
  all.push_back("simulation.frame_time=" + shortest(made * p.time_step()));
  all.push_back(fmt::format("simulation.substeps={}", made));
  Session once(scene, all, script, {.pictures_may_be_missing = true});
  once.advance();
  const auto step = [&]() -> const FrameStats& {
    once.advance();
    return once.record().stats;
  };
  Trial trial = try_sub_steps(step, made, kMostSeconds);
  trial.substeps = p.substeps;
  if (!trial.ended || !trial.diverged.empty()) return trial;
  once.change(SetCommand{"simulation.frame_time", p.frame_time});
  once.change(SetCommand{"simulation.substeps", std::int64_t{p.substeps}});
  trial.ahead = look_ahead(step, std::min(kAheadFrames, session.default_last_frame()), kAheadSeconds);
  return trial;
}

std::string trial_line(const Trial& trial, int frames) {
  if (!trial.diverged.empty()) return "trial: diverged: " + trial.diverged;
  const std::string memory = describe_bytes(trial.bytes);
  if (!trial.ended)
    return fmt::format("trial: a sub-step was given up after {}; {} in use", time_text(trial.seconds), memory);
  const std::string line = fmt::format(
      "trial: a sub-step takes {} ({:.0f} % {}), so a frame of {} about {}, frames 0 to {} about {} without pictures, "
      "if it stays as it starts; {} in use",
      time_text(trial.seconds), 100.0 * trial.share, trial.stage, trial.substeps, time_text(trial.frame_seconds()),
      frames, time_text(frames * trial.frame_seconds()), memory);
  const Ahead& ahead = trial.ahead;
  std::string more;
  if (ahead.frames > 0)
    more += fmt::format("\nahead: {} frame{} in {}, the dearest, {}, in {} ({:.0f} % {})", ahead.frames,
                        ahead.frames == 1 ? "" : "s", time_text(ahead.seconds), ahead.dearest,
                        time_text(ahead.dearest_seconds), 100.0 * ahead.share, ahead.stage);
  if (ahead.given_up > 0.0)
    more += fmt::format("{}frame {} was given up after {}", more.empty() ? "\nahead: " : "; ", ahead.frames + 1,
                        time_text(ahead.given_up));
  return line + more;
}

}  // namespace impinge
