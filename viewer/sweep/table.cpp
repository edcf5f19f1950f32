#include "viewer/sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/controller/run_folder.hpp"
#include "viewer/sweep/doubts.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

namespace {

constexpr std::uint64_t kMostOfTable = std::uint64_t{1} << 32;

// comma-separated values: quoted where they hold a comma, a quote or a line end
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string number(double value) { return shortest(value); }
std::string three_digits(const std::string& text) {
  return text.empty() ? "-" : impinge::three_digits(std::strtod(text.c_str(), nullptr));
}

std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string out;
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i)
      text += fmt::format("{:<{}}", line[i], i + 1 < line.size() ? widths[i] + 2 : 0);
    out += text + "\n";
  }
  return out;
}

double sum(const std::vector<StatsLine>& lines, const char* name) {
  double total = 0.0;
  for (const StatsLine& line : lines) total += line.figures[sweep_figure(name)];
  return total;
}

std::string spread(const std::vector<double>& values) {
  if (values.empty()) return "";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return number(*high - *low);
}

}  // namespace

const std::vector<std::string>& sweep_figure_columns() {
  static const std::vector<std::string> kColumns = {"frames",
                                                    "penetration_last_m",
                                                    "penetration_max_m",
                                                    "residual_last",
                                                    "residual_max",
                                                    "contacts_last",
                                                    "contacts_max",
                                                    "unconverged",
                                                    "energy_drift_last_J",
                                                    "energy_drift_max_J",
                                                    "momentum_drift_max_Ns",
                                                    "state_hash",
                                                    "step_ms",
                                                    "render_ms"};
  return kColumns;
}

const std::vector<std::string>& sweep_error_columns() {
  static const std::vector<std::string> kColumns = {"error_force_N",  "error_force_relative", "error_penetration_m",
                                                    "error_energy_J", "error_momentum_Ns",    "window_s",
                                                    "window_reason"};
  return kColumns;
}

const std::vector<std::string>& sweep_spread_columns() {
  static const std::vector<std::string> kColumns = {"spread_step_ms", "spread_render_ms", "spread_wall_ms",
                                                    "spread_step_cpu_ms"};
  return kColumns;
}

bool is_sweep_column(const std::string& name) {
  static const std::vector<std::string> kOthers = {"hash",        "status",         "reason",  "reference",
                                                   "error_rms_m", "error_relative", "wall_ms", "unsafe_motions",
                                                   "doubts",      "step_cpu_ms"};
  for (const std::vector<std::string>* list :
       {&sweep_figure_columns(), &sweep_error_columns(), &sweep_spread_columns(), &kOthers})
    if (std::find(list->begin(), list->end(), name) != list->end()) return true;
  return false;
}

std::vector<StatsLine> sweep_stats(const std::filesystem::path& run) {
  if (!is_file(run / "stats.csv")) return {};
  const std::string text = read_file(run / "stats.csv", kMostOfTable);
  const bool judged = text.substr(0, text.find('\n')).find(",judged_") != std::string::npos;
  std::vector<StatsLine> lines = whole_rows(text, {judged, std::nullopt});
  const std::vector<std::string>& names = figure_names(judged);
  for (StatsLine& line : lines) {
    std::vector<double> all(figure_names(true).size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < names.size(); ++i) all[sweep_figure(names[i])] = line.figures[i];
    all.insert(all.end(), line.own.begin(), line.own.end());
    line.figures = std::move(all);
  }
  return lines;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

SweepMeasure measure_sweep_job(const std::filesystem::path& folder, int repeats, SweepRow& row) {
  row.outcome = read_sweep_outcome(folder);
  if (row.outcome.is_final()) row.doubts = sweep_doubts(folder / "output.txt");
  row.cells.assign(sweep_figure_columns().size(), "");
  SweepMeasure measure;
  measure.spreads.assign(sweep_spread_columns().size(), "");
  measure.runs.reserve(static_cast<std::size_t>(repeats));  // `lines` refers to the first
  measure.runs.push_back(sweep_stats(folder / "run"));
  const std::vector<StatsLine>& lines = measure.runs.front();
  if (lines.empty()) return measure;
  std::vector<double> walls, cpu;
  if (const auto ms = recorded_step_cpu_ms(folder / "run")) cpu.push_back(*ms);
  if (row.outcome.wall_ms > 0.0) walls.push_back(row.outcome.wall_ms);
  for (int k = 2; k <= repeats; ++k) {
    const SweepOutcome outcome = read_sweep_outcome(repeat_folder(folder, k));
    if (!outcome.is_final()) continue;
    std::vector<StatsLine> again = sweep_stats(repeat_folder(folder, k) / "run");
    std::size_t frame = 0;
    while (frame < again.size() && frame < lines.size() && again[frame].state_hash == lines[frame].state_hash) ++frame;
    if (row.outcome.is_final() && (again.size() != lines.size() || frame < lines.size()) &&
        row.outcome.status != SweepOutcome::unequal) {
      row.outcome.status = SweepOutcome::unequal;
      row.outcome.reason =
          frame < lines.size() && frame < again.size()
              ? fmt::format("repeat {} has another state in frame {} than the first run", k, frame)
              : fmt::format("repeat {} has {} frames and the first run {}", k, again.size(), lines.size());
    }
    walls.push_back(outcome.wall_ms);
    measure.runs.push_back(std::move(again));
    if (const auto ms = recorded_step_cpu_ms(repeat_folder(folder, k) / "run")) cpu.push_back(*ms);
  }
  std::vector<double> steps, renders;
  for (const std::vector<StatsLine>& run : measure.runs)
    steps.push_back(sum(run, "step_ms")), renders.push_back(sum(run, "render_ms"));
  if (repeats > 1) measure.spreads = {spread(steps), spread(renders), spread(walls), spread(cpu)};
  if (!cpu.empty()) row.step_cpu_ms = number(median(cpu));
  if (!walls.empty()) row.outcome.wall_ms = median(walls);

  const auto largest = [&](const char* name) {
    double most = 0.0;
    for (const StatsLine& line : lines) most = std::max(most, line.figures[sweep_figure(name)]);
    return most;
  };
  const auto energy = [&](const StatsLine& line) {
    return line.figures[sweep_figure("kinetic_J")] + line.figures[sweep_figure("potential_J")] +
           line.figures[sweep_figure("elastic_J")];
  };
  const auto momentum = [&](const StatsLine& line) {
    return Vec3(line.figures[sweep_figure("momentum_x")], line.figures[sweep_figure("momentum_y")],
                line.figures[sweep_figure("momentum_z")]);
  };
  const auto last = [&](const char* name) { return lines.back().figures[sweep_figure(name)]; };
  double drift = 0.0, push = 0.0;
  for (const StatsLine& line : lines) {
    drift = std::max(drift, std::abs(energy(line) - energy(lines.front())));
    push = std::max(push, (momentum(line) - momentum(lines.front())).norm());
  }
  row.work_ms = median(steps);
  row.unsafe_motions = number(sum(lines, "unsafe_motions"));
  row.cells = {number(last("frame")),
               number(last("max_penetration_m")),
               number(largest("max_penetration_m")),
               number(last("residual")),
               number(largest("residual")),
               number(last("contacts")),
               number(largest("contacts")),
               number(sum(lines, "unconverged")),
               number(energy(lines.back()) - energy(lines.front())),
               number(drift),
               number(push),
               lines.back().state_hash,
               number(row.work_ms),
               number(median(renders))};
  return measure;
}

std::string sweep_csv(const SweepTable& table, const std::vector<SweepRow>& rows) {
  std::string out = "hash";
  for (const std::string& path : table.paths) out += "," + cell(path);
  out += ",status,reason";
  for (const std::string& name : sweep_figure_columns()) out += "," + name;
  if (table.has_reference) out += ",reference,error_rms_m,error_relative";
  for (const std::string& name : table.more) out += "," + name;
  out += ",wall_ms,step_cpu_ms,unsafe_motions,doubts\n";
  for (const SweepRow& row : rows) {
    out += row.hash;
    for (const std::string& value : row.values) out += "," + cell(value);
    out += fmt::format(",{},{}", status_name(row.outcome.status), cell(row.outcome.reason));
    for (const std::string& figure : row.cells) out += "," + figure;
    if (table.has_reference)
      out += fmt::format(",{},{},{}", row.reference, row.error < 0 ? "" : number(row.error),
                         row.relative_error < 0 ? "" : number(row.relative_error));
    for (const std::string& value : row.more) out += "," + cell(value);
    out += fmt::format(",{},{},{},{}\n", row.outcome.wall_ms > 0 ? fmt::format("{:.3f}", row.outcome.wall_ms) : "",
                       row.step_cpu_ms, row.unsafe_motions, cell(row.doubts));
  }
  return out;
}

std::string three_digits(double value) {
  const double size = std::abs(value);
  if (size < 1e6 && value == std::round(value)) return fmt::format("{:.0f}", value);
  if (size < 1e3 || size >= 1e5) return fmt::format("{:.3g}", value);
  const double unit = size < 1e4 ? 10.0 : 100.0;
  return fmt::format("{:.0f}", std::round(value / unit) * unit);
}

std::string sweep_summary(const SweepTable& table, const std::vector<SweepRow>& rows) {
  const std::vector<std::string>& paths = table.paths;
  std::vector<std::vector<std::string>> lines(1);
  lines[0] = {"job"};
  lines[0].insert(lines[0].end(), paths.begin(), paths.end());
  for (const char* name : {"status", "frames", "penetration max (m)", "residual max", "contacts max",
                           "energy drift (J)", "all steps (ms)"})
    lines[0].push_back(name);
  if (table.has_reference) lines[0].push_back("error (m)");
  const std::vector<std::string>& names = sweep_figure_columns();
  const auto figure = [&](const SweepRow& row, const char* name) {
    return row.cells[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())];
  };
  std::string reasons;
  for (const SweepRow& row : rows) {
    std::vector<std::string>& line = lines.emplace_back();
    line.push_back(row.hash.substr(0, 8));
    line.insert(line.end(), row.values.begin(), row.values.end());
    line.push_back(status_name(row.outcome.status) + std::string(row.doubts.empty() ? "" : ", in doubt"));
    line.push_back(figure(row, "frames").empty() ? "-" : figure(row, "frames"));
    for (const char* name : {"penetration_max_m", "residual_max", "contacts_max", "energy_drift_last_J", "step_ms"})
      line.push_back(three_digits(figure(row, name)));
    if (table.has_reference)
      line.push_back(row.error < 0 ? "-" : row.reference == row.hash ? "reference" : impinge::three_digits(row.error));
    if (!row.outcome.reason.empty())
      reasons +=
          fmt::format("{}: {}: {}\n", row.hash.substr(0, 8), status_name(row.outcome.status), row.outcome.reason);
    if (!row.doubts.empty()) reasons += fmt::format("{}: in doubt: {}\n", row.hash.substr(0, 8), row.doubts);
  }
  return aligned(lines) + reasons;
}

}  // namespace impinge
