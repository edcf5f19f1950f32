#include "viewer/app/sweep_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/file.hpp"
#include "viewer/controller/stats_table.hpp"

namespace impinge {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;

// comma-separated values: quoted where they hold a comma, a quote or a line end
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

// whole lines only: an interrupted run may end in half a line
std::vector<StatsLine> stats_in(const std::filesystem::path& file) {
  std::vector<StatsLine> lines;
  if (!std::filesystem::is_regular_file(file)) return lines;
  const std::string text = read_file(file, kMostBytes);
  std::size_t begin = text.find('\n');
  if (begin == std::string::npos || text.substr(0, begin) != stats_header(false)) return lines;
  for (++begin; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    try {
      lines.push_back(parse_stats_row(std::string_view(text).substr(begin, end - begin), false));
    } catch (const InputError&) {
      break;
    }
    begin = end + 1;
  }
  return lines;
}

std::string number(double value) { return shortest(value); }
std::string three_digits(const std::string& text) {
  if (text.empty()) return "-";
  return fmt::format("{:.3g}", std::strtod(text.c_str(), nullptr));
}

std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const auto& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string out;
  for (const auto& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) text += fmt::format("{:<{}}", line[i], i + 1 < line.size() ? widths[i] + 2 : 0);
    out += text + "\n";
  }
  return out;
}

}  // namespace

const std::vector<std::string>& sweep_figure_columns() {
  static const std::vector<std::string> kColumns = {"frames", "penetration_last_m", "penetration_max_m", "residual_last", "residual_max", "contacts_last", "contacts_max",
                                                    "unconverged", "energy_drift_last_J", "energy_drift_max_J", "state_hash", "step_ms", "render_ms"};
  return kColumns;
}

void measure_sweep_job(const std::filesystem::path& folder, SweepRow& row) {
  row.outcome = read_sweep_outcome(folder);
  row.cells.assign(sweep_figure_columns().size(), "");
  const std::vector<StatsLine> lines = stats_in(folder / "run" / "stats.csv");
  if (lines.empty()) return;
  const std::vector<std::string>& names = figure_names(false);
  const auto column = [&](const char* name) { return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()); };
  const auto largest = [&](const char* name) {
    double most = 0.0;
    for (const StatsLine& line : lines) most = std::max(most, line.figures[column(name)]);
    return most;
  };
  const auto sum = [&](const char* name) {
    double total = 0.0;
    for (const StatsLine& line : lines) total += line.figures[column(name)];
    return total;
  };
  const auto energy = [&](const StatsLine& line) { return line.figures[column("kinetic_J")] + line.figures[column("potential_J")] + line.figures[column("elastic_J")]; };
  const auto last = [&](const char* name) { return lines.back().figures[column(name)]; };
  double drift = 0.0;
  for (const StatsLine& line : lines) drift = std::max(drift, std::abs(energy(line) - energy(lines.front())));
  row.work_ms = sum("step_ms");
  row.cells = {number(last("frame")), number(last("max_penetration_m")), number(largest("max_penetration_m")), number(last("residual")), number(largest("residual")),
               number(last("contacts")), number(largest("contacts")), number(sum("unconverged")), number(energy(lines.back()) - energy(lines.front())), number(drift),
               lines.back().state_hash, number(row.work_ms), number(sum("render_ms"))};
}

std::string sweep_csv(const std::vector<std::string>& paths, const std::vector<SweepRow>& rows, bool has_reference) {
  std::string out = "hash";
  for (const std::string& path : paths) out += "," + cell(path);
  out += ",status,reason";
  for (const std::string& name : sweep_figure_columns()) out += "," + name;
  if (has_reference) out += ",reference,error_rms_m,error_relative";
  out += ",wall_ms\n";
  for (const SweepRow& row : rows) {
    out += row.hash;
    for (const std::string& value : row.values) out += "," + cell(value);
    out += fmt::format(",{},{}", status_name(row.outcome.status), cell(row.outcome.reason));
    for (const std::string& figure : row.cells) out += "," + figure;
    if (has_reference) out += fmt::format(",{},{},{}", row.reference, row.error < 0 ? "" : number(row.error), row.relative_error < 0 ? "" : number(row.relative_error));
    out += fmt::format(",{}\n", row.outcome.wall_ms > 0 ? fmt::format("{:.3f}", row.outcome.wall_ms) : "");
  }
  return out;
}

std::string sweep_summary(const std::vector<std::string>& paths, const std::vector<SweepRow>& rows, bool has_reference) {
  std::vector<std::vector<std::string>> lines(1);
  lines[0] = {"job"};
  lines[0].insert(lines[0].end(), paths.begin(), paths.end());
  for (const char* name : {"status", "frames", "penetration max (m)", "residual max", "contacts max", "energy drift (J)", "step (ms)"}) lines[0].push_back(name);
  if (has_reference) lines[0].push_back("error (m)");
  const std::vector<std::string>& names = sweep_figure_columns();
  const auto figure = [&](const SweepRow& row, const char* name) { return row.cells[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]; };
  std::string reasons;
  for (const SweepRow& row : rows) {
    std::vector<std::string>& line = lines.emplace_back();
    line.push_back(row.hash.substr(0, 8));
    line.insert(line.end(), row.values.begin(), row.values.end());
    line.push_back(status_name(row.outcome.status));
    line.push_back(figure(row, "frames").empty() ? "-" : figure(row, "frames"));
    for (const char* name : {"penetration_max_m", "residual_max", "contacts_max", "energy_drift_last_J", "step_ms"}) line.push_back(three_digits(figure(row, name)));
    if (has_reference) line.push_back(row.error < 0 ? "-" : fmt::format("{:.3g}", row.error));
    if (!row.outcome.reason.empty()) reasons += fmt::format("{}: {}: {}\n", row.hash.substr(0, 8), status_name(row.outcome.status), row.outcome.reason);
  }
  return aligned(lines) + reasons;
}

}  // namespace impinge
