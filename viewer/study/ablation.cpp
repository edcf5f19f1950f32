#include "viewer/study/ablation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"

namespace impinge {

namespace {

constexpr int kFrames = 20;
constexpr double kPatience = 10.0, kLeastSeconds = 5.0;
constexpr int kAblationRuns = 3;
constexpr double kRepeatSeconds = 2.0;  // of one setting; what takes longer isn't repeated

/// Points of each body's surface at one frame; those of exact shapes: where the body's axes leave its ball.
std::vector<std::vector<Vec3>> surface_points(const Session& session) {
  std::vector<std::vector<Vec3>> points;
  for (BodyIndex i(0); i < session.world().bodies().size(); ++i) {
    const Body& body = session.world().bodies()[i];
    std::vector<Vec3>& list = points.emplace_back();
    if (!body.has_freedom()) continue;
    const BodyRecord& record = session.record().bodies[i];
    list.assign(record.vertices.begin(), record.vertices.end());
    if (!list.empty()) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0})
        list.push_back(record.pose.apply(Vec3(side * body.radius * Vec3::Unit(axis))));
  }
  return points;
}

using Trajectory = std::vector<std::vector<std::vector<Vec3>>>;  // frame, body, point

double scene_size(const Trajectory& trajectory) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const auto& body : trajectory.front())
    for (const Vec3& p : body) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return low.x() > high.x() ? 0.0 : (high - low).norm();
}

double largest_distance(const std::vector<std::vector<Vec3>>& a, const std::vector<std::vector<Vec3>>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a[i].size(); ++k) sum += (a[i][k] - b[i][k]).squaredNorm();
    if (!a[i].empty()) largest = std::max(largest, std::sqrt(sum / static_cast<double>(a[i].size())));
  }
  return largest;
}

struct Run {
  /// processor time of frames 1, 2, …: what else runs on the machine has little part in it
  std::vector<double> frame_ms;
  double difference = 0.0;  ///< metres, from the trajectory given
  std::string ended;
  std::size_t frames_without_contact = 0, frames_with_sleepers = 0;
  int contacts_at_start = 0;
};

// `against`: compared with, or filled where it is empty
Run run_once(const RunOptions& options, const std::vector<std::string>& changes, int last_frame, double seconds,
             Trajectory& against, bool fills) {
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), changes.begin(), changes.end());
  Session session(options.scene, overrides, options.script);
  Run run;
  const auto begin = std::chrono::steady_clock::now();
  for (int frame = 0; frame <= last_frame; ++frame) {
    const std::clock_t started = std::clock();
    try {
      session.advance();
    } catch (const DivergenceError& error) {
      run.ended = error.what();
      break;
    }
    const double frame_ms = 1e3 * static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    const auto points = surface_points(session);
    if (fills)
      against.push_back(points);
    else
      run.difference = std::max(run.difference, largest_distance(points, against[static_cast<std::size_t>(frame)]));
    const FrameStats& stats = session.record().stats;
    if (frame == 0) run.contacts_at_start = static_cast<int>(stats.contacts);
    if (frame == 0) continue;
    run.frame_ms.push_back(frame_ms);
    run.frames_without_contact += stats.contacts == 0 ? 1 : 0;
    run.frames_with_sleepers += stats.asleep > 0 ? 1 : 0;
    if (frame < last_frame &&
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds) {
      run.ended = fmt::format("stopped after frame {}: too slow", frame);
      break;
    }
  }
  return run;
}

// a short run several times: of each frame the shortest time counts
Run run_repeatedly(const RunOptions& options, const std::vector<std::string>& changes, int last_frame, double seconds,
                   Trajectory& against) {
  const auto begin = std::chrono::steady_clock::now();
  Run run = run_once(options, changes, last_frame, seconds, against, false);
  const auto spent = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  for (int k = 1; k < kAblationRuns && spent() * (k + 1) / k < kRepeatSeconds; ++k) {
    const Run again = run_once(options, changes, last_frame, seconds, against, false);
    for (std::size_t i = 0; i < std::min(run.frame_ms.size(), again.frame_ms.size()); ++i)
      run.frame_ms[i] = std::min(run.frame_ms[i], again.frame_ms[i]);
  }
  return run;
}

double mean_of(const std::vector<double>& values, std::size_t first) {
  double sum = 0.0;
  for (std::size_t i = 0; i < first; ++i) sum += values[i];
  return first == 0 ? 0.0 : sum / static_cast<double>(first);
}

std::vector<std::string> all_overrides(const std::vector<Economy>& list) {
  std::vector<std::string> all;
  for (const Economy& economy : list)
    for (const std::string& text : economy.overrides) {
      const std::string path = text.substr(0, text.find('=') + 1);
      if (std::none_of(all.begin(), all.end(), [&](const std::string& known) { return known.rfind(path, 0) == 0; }))
        all.push_back(text);
    }
  return all;
}

std::string csv_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::vector<AblationRow> ablate(const RunOptions& options, int last_frame,
                                const std::function<void(const AblationRow&)>& ready) {
  std::vector<Economy> list;
  {
    const Session session(options.scene, options.overrides, options.script);
    list = economies(session);
  }
  Trajectory trajectory;
  const auto begin = std::chrono::steady_clock::now();
  const Run first = run_once(options, {}, last_frame, 1e9, trajectory, true);  // its times are those of cold caches
  const double seconds = std::max(
      kLeastSeconds, kPatience * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  const int last = static_cast<int>(trajectory.size()) - 1;
  const double size = scene_size(trajectory);
  if (last < 1) throw DivergenceError(first.ended);
  const Run base = run_repeatedly(options, {}, last, 1e9, trajectory);

  std::vector<AblationRow> rows;
  const auto add = [&](AblationRow row) {
    ready(row);
    rows.push_back(std::move(row));
  };
  const auto measured = [&](Economy economy) {
    const Run run = run_repeatedly(options, economy.overrides, last, seconds, trajectory);
    if (run.contacts_at_start > base.contacts_at_start)
      economy.instead += fmt::format(" ({} contacts more at frame 0)", run.contacts_at_start - base.contacts_at_start);
    AblationRow row{economy, static_cast<int>(run.frame_ms.size()),    mean_of(run.frame_ms, run.frame_ms.size()),
                    -1.0,    size > 0.0 ? run.difference / size : 0.0, run.ended};
    const double own = mean_of(base.frame_ms, run.frame_ms.size());
    if (own > 0.0) row.ratio = row.frame_ms / own;
    return row;
  };
  add({{"as it is", "", {}, ""},
       static_cast<int>(base.frame_ms.size()),
       mean_of(base.frame_ms, base.frame_ms.size()),
       1.0,
       0.0,
       first.ended});
  add(measured({"as it is, once more", "shows the noise of the timings", {}, ""}));
  std::vector<Economy> together;
  std::string without;
  for (Economy& economy : list) {
    if (economy.name == "sleeping" && !economy.overrides.empty())
      economy.instead +=
          fmt::format(" (something slept in {} of {} frames)", base.frames_with_sleepers, base.frame_ms.size());
    if (economy.name == "frames without contact")
      economy.instead += fmt::format(" ({} of {} frames)", base.frames_without_contact, base.frame_ms.size());
    if (economy.overrides.empty()) continue;
    add(measured(economy));
    if (rows.back().ended.empty())
      together.push_back(economy);  // what didn't get through alone won't with the others
    else
      without += (without.empty() ? " but for " : ", ") + economy.name;
  }
  add(measured(
      {"all of these at once", "everything that can be modelled instead" + without, all_overrides(together), ""}));
  for (const Economy& economy : list)
    if (economy.overrides.empty()) add({economy, 0, -1.0, -1.0, -1.0, ""});
  return rows;
}

void check_ablation(const RunOptions& options, const Session& session) {
  if (options.frames.value_or(kFrames) < 1)
    throw InputError("command line: --frames is 0; at least one frame of simulation is wanted; change it");
  if (session.record().stats.dofs == 0)
    throw InputError(fmt::format(
        "{}: nothing in it can move; a scene with dynamic or deformable bodies is wanted; leave out --ablation",
        options.scene.string()));
}

void print_ablation(const RunOptions& options, const std::filesystem::path& out) {
  const int frames = options.frames.value_or(kFrames);
  fmt::print(
      "\nablation:     {} frames; difference: largest distance of a body (root mean square over its surface), in sizes "
      "of the scene;\n              times: of the processor, smallest of up to three runs; ratio and difference: to "
      "the scene as it is over the same frames\n",
      frames);
  fmt::print("{:<30}{:>7}{:>13}{:>9}{:>13}  {}\n", "left out", "frames", "ms a frame", "ratio", "difference",
             "modelled instead");
  std::string csv = "left_out,modelled_instead,settings,frames,ratio,difference,ended,frame_ms\n";
  ablate(options, frames, [&](const AblationRow& row) {
    const bool was_run = row.frame_ms >= 0.0;
    fmt::print("{:<30}{:>7}{:>13}{:>9}{:>13}  {}{}\n", row.economy.name, was_run ? fmt::format("{}", row.frames) : "",
               was_run ? fmt::format("{:.2f}", row.frame_ms) : row.economy.without,
               row.ratio < 0.0 ? "" : fmt::format("{:.2f}", row.ratio),
               was_run ? fmt::format("{:.2g}", row.difference) : "", row.economy.instead,
               row.ended.empty() ? "" : "; " + row.ended);
    std::fflush(stdout);
    std::string settings;
    for (const std::string& text : row.economy.overrides) settings += (settings.empty() ? "" : " ") + text;
    csv += fmt::format("{},{},{},{},{},{},{},{}\n", csv_text(row.economy.name), csv_text(row.economy.instead),
                       csv_text(settings), row.frames, row.ratio < 0.0 ? "" : fmt::format("{}", row.ratio),
                       was_run ? fmt::format("{}", row.difference) : "",
                       csv_text(was_run ? row.ended : row.economy.without),
                       was_run ? fmt::format("{}", row.frame_ms) : "");
  });
  if (out.empty()) return;
  make_folder(out);
  write_file(out / "ablation.csv", csv);
  fmt::print("table:        {}{}\n", (out / "ablation.csv").string(),
             is_there(out / "sweep.toml") ? "; the same impinge sweep once more shows it in its report" : "");
}

}  // namespace impinge
