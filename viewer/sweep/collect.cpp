#include "viewer/sweep/collect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "engine/core/error.hpp"
#include "viewer/sweep/error.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> moving_bodies(const Session& session) {
  std::vector<std::string> names;
  for (const Body& body : session.world().bodies())
    if (body.has_freedom()) names.push_back(body.name);
  return names;
}

bool has_ended(const fs::path& out, const std::string& hash) {
  return read_sweep_outcome(job_folder(out, hash)).status <= SweepOutcome::failed;
}

// errors of each row, each reference's window once
class ErrorTaker {
 public:
  ErrorTaker(const fs::path& out, const Sweep& sweep, const SweepBase& base)
      : out_(out), sweep_(sweep), bodies_(moving_bodies(base.session())) {}

  // fills error and relative_error; returns the cells of sweep_error_columns()
  std::vector<std::string> take(SweepRow& row) {
    std::vector<std::string> cells(sweep_error_columns().size());
    const bool is_analytic = sweep_.reference == SweepReferenceKind::analytic;
    if (row.outcome.status > SweepOutcome::failed) return cells;
    if (!is_analytic && !has_ended(out_, row.reference)) {
      const SweepOutcome outcome = read_sweep_outcome(job_folder(out_, row.reference));
      cells[6] = fmt::format("no error: the reference {} is {}{}", row.reference.substr(0, 8),
                             status_name(outcome.status), outcome.reason.empty() ? "" : ": " + outcome.reason);
      return cells;
    }
    const fs::path run = job_folder(out_, row.hash) / "run";
    ErrorWindow window = is_analytic ? given_window() : window_of(row);
    const SweepErrors errors =
        is_analytic ? against_formula(row, run, window)
                    : sweep_errors(run, job_folder(out_, row.reference) / "run", bodies_, window.seconds);
    if (!errors.exist() && window.reason.rfind("all", 0) == 0) window.reason = "no two frames to compare";
    if (!errors.mismatch.empty()) window.reason = errors.mismatch;
    if (errors.exist() && errors.apart >= 0.0)
      window.reason += fmt::format(
          "; surfaces of other triangles: compared with the nearest points at the start, up to "
          "{:.2g} m apart there",
          errors.apart);
    row.error = errors.rms;
    row.relative_error = errors.relative;
    if (errors.exist() && !is_analytic) {
      const auto known = [](double value) { return value < 0.0 ? std::string() : shortest(value); };
      cells = {known(errors.force), known(errors.force_relative), shortest(errors.penetration), known(errors.energy),
               known(errors.momentum)};
      cells.resize(sweep_error_columns().size());
    }
    cells[5] = errors.exist() ? shortest(errors.seconds) : "0";
    cells[6] = window.reason;
    return cells;
  }

 private:
  ErrorWindow given_window() const {
    if (std::isfinite(sweep_.window) && sweep_.window > 0.0) return {sweep_.window, "--window"};
    return {std::numeric_limits<double>::infinity(), "all"};
  }
  ErrorWindow window_of(const SweepRow& row) {
    if (row.perturbed.empty()) return given_window();
    const auto it = windows_.find(row.reference);
    if (it != windows_.end()) return it->second;
    ErrorWindow window{std::numeric_limits<double>::infinity(),
                       "all: the run that starts 1e-9 scene sizes aside did not end well"};
    if (has_ended(out_, row.perturbed))
      window =
          automatic_window(job_folder(out_, row.reference) / "run", job_folder(out_, row.perturbed) / "run", bodies_);
    windows_[row.reference] = window;
    return window;
  }
  SweepErrors against_formula(const SweepRow& row, const fs::path& run, ErrorWindow& window) const {
    const SweepJob job = read_sweep_job(job_folder(out_, row.hash));
    std::vector<std::string> overrides = job.options.overrides;
    overrides.insert(overrides.end(), job.changes.begin(), job.changes.end());
    const Session session(job.options.scene, overrides, job.options.script, sweep_session_options(job.options));
    try {
      return analytic_errors(run, analytic_motion(sweep_.analytic_case, session), bodies_, window);
    } catch (const InputError& error) {
      window.reason = error.what();
      return {};
    }
  }

  const fs::path& out_;
  const Sweep& sweep_;
  std::vector<std::string> bodies_;
  std::map<std::string, ErrorWindow> windows_;
};

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

SweepTable collect_sweep(const fs::path& out, Sweep& sweep, const SweepOptions& options, const SweepBase& base) {
  SweepTable table{sweep.paths, sweep.reference != SweepReferenceKind::none, {}};
  if (table.has_reference) append(table.more, sweep_error_columns());
  append(table.more, sweep.columns.names());
  if (options.repeats() > 1) append(table.more, sweep_spread_columns());
  ErrorTaker errors(out, sweep, base);
  for (SweepRow& row : sweep.rows) {
    const SweepMeasure measure = measure_sweep_job(job_folder(out, row.hash), options.repeats(), row);
    if (table.has_reference) append(row.more, errors.take(row));
    for (std::size_t c = 0; c < sweep.columns.names().size(); ++c) {
      // a time is the median over the repeats; anything else is the same in all of them
      std::vector<double> values;
      const bool is_time = sweep.columns.names()[c].ends_with("_ms");
      for (std::size_t r = 0; r < (is_time ? measure.runs.size() : 1); ++r)
        values.push_back(sweep.columns.evaluate(row.values, measure.runs[r])[c]);
      const double value = median(values);
      row.more.push_back(std::isfinite(value) ? shortest(value) : "");
    }
    if (options.repeats() > 1) append(row.more, measure.spreads);
  }
  return table;
}

std::string reference_caution(const Sweep& sweep) {
  const std::size_t count = sweep.reference_methods.size();
  if (count < 2) return "";
  const auto begin = sweep.reference_methods.begin();
  return fmt::format(
      "the jobs were held against {} different methods ({}{}): an error says how far a job is from its own method at a "
      "small time step, and errors of different methods don't compare. --reference PATH=VALUE holds all jobs against "
      "one method",
      count, fmt::join(begin, begin + static_cast<long>(std::min<std::size_t>(count, 8)), "; "),
      count > 8 ? "; ..." : "");
}

std::string describe_errors(const Sweep& sweep, const SweepTable& table) {
  if (!table.has_reference) return "";
  std::string out =
      sweep.reference == SweepReferenceKind::analytic
          ? fmt::format("errors: against the formula of {}\n", sweep.analytic_case)
      : sweep.reference == SweepReferenceKind::finest
          ? std::string("errors: against the job of the same other settings with the smallest time step\n")
          : fmt::format("errors: against the same job with {}\n", fmt::join(sweep.reference_words, ", "));
  // rows that share a window share a line
  std::map<std::string, std::vector<std::string>> windows;
  for (const SweepRow& row : sweep.rows)
    if (row.more.size() > 6 && !row.more[6].empty())
      windows[fmt::format("{:.6g} s ({})", std::strtod(row.more[5].c_str(), nullptr), row.more[6])].push_back(
          row.hash.substr(0, 8));
  for (const auto& [text, hashes] : windows)
    out += fmt::format(
        "window: {}{}\n", text,
        windows.size() == 1
            ? ""
            : fmt::format(": {}{}",
                          fmt::join(hashes.begin(),
                                    hashes.begin() + static_cast<long>(std::min<std::size_t>(hashes.size(), 8)), " "),
                          hashes.size() > 8 ? fmt::format(" and {} more", hashes.size() - 8) : ""));
  return out;
}

}  // namespace impinge
