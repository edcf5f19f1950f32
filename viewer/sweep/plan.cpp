#include "viewer/sweep/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "engine/core/error.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/sweep/reference.hpp"

namespace impinge {

namespace {

constexpr std::size_t kMostUnasked = 10'000, kMost = 10'000'000;

using Load = std::function<void(const std::string&)>;

struct Planned {
  std::vector<std::string> changes, reference, perturbed;  ///< the latter two empty for none
};

double window_of(const SweepSetting& setting) {
  const std::string& text = setting.text;
  if (text.empty() || text == "automatic") return -1.0;
  if (text == "all") return std::numeric_limits<double>::infinity();
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (*end != 0 || !std::isfinite(seconds) || seconds <= 0.0)
    refuse(setting.where("--window"), fmt::format("'{}'", text),
           "seconds greater than 0, 'all' or 'automatic' are wanted", "change it");
  return seconds;
}

// sets the kind of reference; for settings, returns PATH=VALUE of each
std::vector<std::string> read_reference(const SweepOptions& options, const SweepBase& base, const Load& load,
                                        Sweep& sweep) {
  std::vector<std::string> settings;
  for (const SweepSetting& setting : options.reference) {
    const std::string where = setting.where("--reference");
    if (setting.text == "finest" || setting.text.rfind("case:", 0) == 0) {
      if (options.reference.size() > 1)
        refuse(where, fmt::format("'{}' beside another reference", setting.text), "one reference is wanted",
               "leave out the others");
      sweep.reference = setting.text == "finest" ? SweepReferenceKind::finest : SweepReferenceKind::analytic;
      if (sweep.reference == SweepReferenceKind::analytic) {
        sweep.analytic_case = setting.text.substr(5);
        try {
          analytic_motion(sweep.analytic_case, base.session());
        } catch (const InputError& error) {
          throw InputError(where + ": " + error.what());
        }
      }
      continue;
    }
    if (setting.text.find('=') == std::string::npos)
      refuse(where, setting.place.empty() ? "no PATH=VALUE" : fmt::format("'{}' is no PATH=VALUE", setting.text),
             fmt::format("PATH=VALUE, finest or case:NAME ({}) is wanted", analytic_case_names()), "change it");
    const SweepAxis axis = read_sweep_axis("--reference", setting, base.session(), load);
    if (axis.values.size() != 1)
      refuse(where, fmt::format("{} values", axis.values.size()), "one is wanted", "leave the others out");
    settings.push_back(axis.path + "=" + axis.values.front());
    sweep.reference = SweepReferenceKind::settings;
  }
  if (sweep.reference == SweepReferenceKind::settings)
    for (const std::string& method : scene_methods(sweep.axes, settings, base.session())) settings.push_back(method);
  return settings;
}

// the methods that a job was varied to, in words; "" if none was varied
std::string methods_of(const Sweep& sweep, const SweepRow& row, const Session& session) {
  std::vector<std::string> methods;
  for (std::size_t k = 0; k < sweep.axes.size(); ++k)
    if (const Parameter* of = session.rows().find(sweep.paths[k]); of != nullptr && chooses_method(*of))
      methods.push_back(sweep.paths[k] + "=" + row.values[k]);
  return fmt::format("{}", fmt::join(methods, " "));
}

// indices of the combinations that the filter lets through
std::vector<std::size_t> filtered(const SweepOptions& options, const Sweep& sweep, std::size_t count) {
  std::vector<std::size_t> kept;
  if (options.filter.text.empty()) {
    kept.resize(count);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const SweepWords words(sweep.axes);
  const PlacedSetting placed(options.filter, "--filter", 0);
  const Expression filter(placed.text(), words.expression_words());
  for (std::size_t i = 0; i < count; ++i)
    if (filter.holds(words.values(sweep_job_values(sweep.axes, options.zip, i)))) kept.push_back(i);
  const std::string where = options.filter.where("--filter");
  if (kept.empty())
    refuse(where, fmt::format("none of {} combinations is left", count), "at least one is wanted", "widen the filter");
  if (kept.size() > kMostUnasked && !options.yes)
    refuse(where, fmt::format("{} jobs are left", kept.size()), fmt::format("at most {} are taken", kMostUnasked),
           "filter more, or say --yes");
  return kept;
}

}  // namespace

Sweep plan_sweep(const SweepOptions& options, const RunOptions& run, const SweepBase& base) {
  const Load load = [&](const std::string& text) {
    std::vector<std::string> overrides = run.overrides;
    overrides.push_back(text);
    const Session tried(run.scene, overrides, run.script, sweep_session_options(run));
  };
  Sweep sweep;
  for (const SweepSetting& setting : options.vary) {
    sweep.axes.push_back(read_sweep_axis("--vary", setting, base.session(), load));
    sweep.paths.push_back(sweep.axes.back().path);
    for (const std::string& set : run.overrides)
      if (set.rfind(sweep.paths.back() + "=", 0) == 0)
        refuse(setting.where("--vary"), fmt::format("{}, a path that --set gives too", sweep.paths.back()),
               "one of them is wanted", "leave one out");
  }
  const bool asks = !options.yes && options.filter.text.empty();
  const std::size_t count = count_sweep_jobs(sweep.axes, options.vary, options.zip, asks ? kMostUnasked : kMost);
  const std::vector<std::string> settings = read_reference(options, base, load, sweep);
  sweep.window = window_of(options.window);
  if (!options.window.text.empty() && sweep.reference == SweepReferenceKind::none)
    refuse(options.window.where("--window"), "a window without a reference", "errors to take over it are wanted",
           "add --reference, or leave it out");
  sweep.columns = SweepColumns(options.columns, sweep.axes, base.session().stats_shape());

  std::vector<std::size_t> order = filtered(options, sweep, count);
  std::vector<Planned> planned;
  for (const std::size_t i : order) {
    SweepRow& row = sweep.rows.emplace_back();
    row.values = sweep_job_values(sweep.axes, options.zip, i);
    Planned& job = planned.emplace_back();
    for (std::size_t k = 0; k < sweep.axes.size(); ++k) job.changes.push_back(sweep.paths[k] + "=" + row.values[k]);
    if (sweep.reference == SweepReferenceKind::settings) job.reference = with_settings(job.changes, settings);
  }
  sweep.reference_words = settings;
  if (sweep.reference == SweepReferenceKind::analytic) sweep.reference_words = {"case:" + sweep.analytic_case};
  if (sweep.reference == SweepReferenceKind::finest) {
    const std::string where = options.reference.front().where("--reference");
    const std::vector<std::size_t> finest = finest_rows(where, sweep.axes, sweep.rows, options.zip, base.session());
    for (std::size_t i = 0; i < planned.size(); ++i) {
      planned[i].reference = planned[finest[i]].changes;
      const std::string methods = methods_of(sweep, sweep.rows[finest[i]], base.session());
      if (std::find(sweep.reference_methods.begin(), sweep.reference_methods.end(), methods) ==
          sweep.reference_methods.end())
        sweep.reference_methods.push_back(methods);
    }
    for (const std::string& path : sweep.paths)
      if (is_time_step_path(path)) sweep.reference_words.push_back(path + "=finest");
  }

  std::vector<std::size_t> by_run(order.size());
  std::iota(by_run.begin(), by_run.end(), std::size_t{0});
  if (options.coarse_first) {
    std::vector<int> levels;
    levels.reserve(order.size());
    for (const std::size_t i : order) levels.push_back(sweep_job_level(sweep.axes, options.zip, i));
    std::stable_sort(by_run.begin(), by_run.end(), [&](std::size_t l, std::size_t r) { return levels[l] < levels[r]; });
  }
  std::map<std::vector<std::string>, std::string> hashes;  // of changes: a reference serves many
  std::set<std::string> known;
  const auto add = [&](const std::vector<std::string>& changes, const std::string& against) {
    std::string& hash = hashes[changes];
    if (hash.empty()) hash = base.hash(changes);
    if (known.insert(hash).second) sweep.jobs.push_back({run, changes, hash, against});
    return hash;
  };
  const auto add_reference = [&](std::size_t i) {
    if (planned[i].reference.empty()) return;
    sweep.rows[i].reference = add(planned[i].reference, "");
    if (sweep.window < 0.0)
      sweep.rows[i].perturbed = add(perturbed_settings(planned[i].reference, base.session()), sweep.rows[i].reference);
  };
  if (!options.coarse_first)
    for (const std::size_t i : by_run) add_reference(i);
  for (const std::size_t i : by_run) {
    if (options.coarse_first) add_reference(i);
    sweep.rows[i].hash = add(planned[i].changes, sweep.rows[i].reference);
  }
  return sweep;
}

}  // namespace impinge
