#include "viewer/report/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "viewer/sweep/reference.hpp"

namespace impinge {

namespace {

struct Known {
  const char *name, *label, *doc;
  bool is_main;
};

constexpr std::array kKnown = {
    Known{"frames", "frames", "the last frame that was made", false},
    Known{"penetration_last_m", "penetration, last frame",
          "deepest overlap at the end of the last frame, as contacts measure it", false},
    Known{"penetration_max_m", "penetration, largest",
          "deepest overlap at the end of any frame, as contacts measure it", true},
    Known{"residual_last", "residual, last frame",
          "how far the last frame's contact impulses are from the law of contact: the judge's natural map", false},
    Known{"residual_max", "residual, largest", "the same of the worst frame", true},
    Known{"contacts_last", "contacts, last frame", "contacts handed to the solver in the last frame", false},
    Known{"contacts_max", "contacts, most", "contacts handed to the solver in the frame that had most", true},
    Known{
        "unconverged", "unconverged solves",
        "solves of a collision group that ended without an answer, at a limit of iterations or stalled, in all frames",
        true},
    Known{"energy_drift_last_J", "energy drift, last frame",
          "kinetic, potential and elastic energy of the last frame less that of frame 0; contact and damping take "
          "energy away",
          false},
    Known{"energy_drift_max_J", "energy drift, largest",
          "the largest size of the change of kinetic, potential and elastic energy since frame 0, in any frame", true},
    Known{"state_hash", "state hash", "equal hashes are equal states, bit for bit", false},
    Known{"step_ms", "simulation time, by the clock",
          "sum over all frames, without pictures; what else runs on the machine is in it", false},
    Known{
        "step_cpu_ms", "simulation time",
        "of the processor, sum over all frames, without pictures; what else runs on the machine has little part in it",
        true},
    Known{"render_ms", "drawing time", "pictures of all frames", false},
    Known{"wall_ms", "wall time", "of the whole process, with loading and files; of the attempt that ended the job",
          false},
    Known{"reference", "reference", "the job that this one is measured against", false},
    Known{"error_rms_m", "error",
          "root of the mean square of the distance to the reference, over surface points and frames", true},
    Known{"error_relative", "error, relative", "the same in sizes of the scene", true},
    Known{"error_force_N", "force error",
          "root of the mean square difference of the contact force from the reference's", false},
    Known{"error_force_relative", "force error, relative", "the same as a part of the reference's force", false},
    Known{"error_penetration_m", "penetration error", "difference of the deepest overlap from the reference's", false},
    Known{"error_energy_J", "energy error", "difference of the energy from the reference's", false},
    Known{"error_momentum_Ns", "momentum error", "difference of the momentum from the reference's", false},
    Known{"window_s", "window of the errors", "simulated time over which the errors are taken", false},
    Known{"window_reason", "why this window", "", false},
    Known{"momentum_drift_max_Ns", "momentum drift, largest",
          "the largest change of the momentum since frame 0; gravity and the floor change it", false},
    Known{"spread_step_cpu_ms", "spread of the time", "largest less smallest simulation time of a job's repeated runs",
          true},
    Known{"spread_step_ms", "spread of the time by the clock", "largest less smallest of the repeated runs", false},
    Known{"spread_render_ms", "spread of the drawing time", "largest less smallest of the repeated runs", false},
    Known{"spread_wall_ms", "spread of the wall time", "largest less smallest of the repeated runs", false},
    Known{"unsafe_motions", "unsafe motions",
          "motions of bodies that were not safe against passing others, in all frames", true},
    Known{"doubts", "in doubt", "what the run found wrong with its own answer: such jobs take no part in what is best",
          true},
    Known{"status", "status", "", true},
    Known{"reason", "reason", "what the run said", true},
};

constexpr std::array<std::pair<const char*, const char*>, 12> kUnits = {{{"_m_per_s", "m/s"},
                                                                         {"_kg_m_per_s", "kg m/s"},
                                                                         {"_percent", "%"},
                                                                         {"_ms", "ms"},
                                                                         {"_Ns", "N·s"},
                                                                         {"_Pa", "Pa"},
                                                                         {"_m", "m"},
                                                                         {"_J", "J"},
                                                                         {"_s", "s"},
                                                                         {"_N", "N"},
                                                                         {"_kg", "kg"},
                                                                         {"_deg", "°"}}};

bool parses(const std::string& text, double& value) {
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == 0 && std::isfinite(value);
}

ReportColumn::Kind kind_of(const std::string& name) {
  if (name == "hash") return ReportColumn::hash;
  if (name == "status") return ReportColumn::status;
  if (name == "reason") return ReportColumn::reason;
  if (name == "doubts") return ReportColumn::doubts;
  if (name == "reference") return ReportColumn::reference;
  if (name == "state_hash" || name == "window_reason") return ReportColumn::text;
  if (name.rfind("spread_", 0) == 0) return ReportColumn::spread;
  if (name.ends_with("_ms")) return ReportColumn::time;
  return name.rfind("error_", 0) == 0 ? ReportColumn::error : ReportColumn::figure;
}

void describe(ReportColumn& column) {
  std::string stem = column.name;
  for (const auto& [suffix, unit] : kUnits)
    if (stem.ends_with(suffix) && stem.size() > std::string_view(suffix).size()) {
      column.unit = unit;
      stem = stem.substr(0, stem.size() - std::string_view(suffix).size());
      break;
    }
  if (column.name.rfind("residual_", 0) == 0) column.unit = "m/s";
  for (const Known& known : kKnown)
    if (column.name == known.name) {
      column.label = known.label, column.doc = known.doc, column.is_main = known.is_main;
      return;
    }
  std::replace(stem.begin(), stem.end(), '_', ' ');
  column.label = stem;
  column.is_main = column.kind != ReportColumn::text && column.kind != ReportColumn::hash;
}

/// Whether each value of the one goes with a single value of the other, as of two that --zip varies.
bool is_told_by(const ReportTable& table, std::size_t one, std::size_t other) {
  std::map<std::string, std::string> value_of;
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const std::vector<std::string>& row) {
    return value_of.try_emplace(row[one], row[other]).first->second == row[other];
  });
}

// A line goes along one value that the reference sets: the time step where it is one of them, else the one with the most
// values; and along those that only change with it. All others tell lines apart: one through both would jump from the end of
// what the first one's value gives to the beginning of what its next does. A formula is one truth for everything.
void mark_joined(ReportTable& table) {
  const auto rank = [&](const ReportColumn& c) { return std::pair(is_time_step_path(c.name), c.distinct); };
  const auto may_join = [](const ReportColumn& c) {
    return c.kind == ReportColumn::varied && c.is_numeric && c.in_reference;
  };
  const ReportColumn* along = nullptr;
  for (const ReportColumn& column : table.columns)
    if (may_join(column) && (along == nullptr || rank(column) > rank(*along))) along = &column;
  if (along == nullptr) return;
  const auto place = static_cast<std::size_t>(along - table.columns.data());
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    table.columns[c].is_joined = may_join(table.columns[c]) && is_told_by(table, place, c);
}

}  // namespace

const char* kind_name(ReportColumn::Kind kind) {
  constexpr const char* kNames[] = {"hash", "varied", "status", "reason", "doubts", "reference",
                                    "text", "figure", "error",  "time",   "spread"};
  return kNames[kind];
}

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  bool quoted = false, begins = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (begins) lines.emplace_back(1), begins = false;
    std::string& cell = lines.back().back();
    if (quoted) {
      if (c != '"')
        cell += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        cell += text[++i];
      else
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      lines.back().emplace_back();
    } else if (c == '\n') {
      begins = true;
    } else {
      cell += c;
    }
  }
  return lines;
}

int ReportTable::column(const std::string& name) const {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].name == name) return static_cast<int>(i);
  return -1;
}

double ReportTable::number(std::size_t row, int column) const {
  double value = 0.0;
  if (column < 0 || !parses(rows[row][static_cast<std::size_t>(column)], value))
    return std::numeric_limits<double>::quiet_NaN();
  return value;
}

const std::string& ReportTable::cell(std::size_t row, const std::string& name) const {
  static const std::string kNone;
  const int at = column(name);
  return at < 0 ? kNone : rows[row][static_cast<std::size_t>(at)];
}

bool ReportTable::has_positive(int column) const {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (number(i, column) > 0.0) return true;
  return false;
}

std::vector<bool> ReportTable::best(int x, int y) const {
  std::vector<bool> is_best(rows.size(), false);
  const auto counts = [&](std::size_t i) {
    return number(i, x) > 0.0 && number(i, y) > 0.0 && cell(i, "doubts").empty();
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!counts(i)) continue;
    is_best[i] = true;
    for (std::size_t k = 0; k < rows.size() && is_best[i]; ++k)
      if (counts(k) && number(k, x) <= number(i, x) && number(k, y) <= number(i, y) &&
          (number(k, x) < number(i, x) || number(k, y) < number(i, y)))
        is_best[i] = false;
  }
  return is_best;
}

std::string ReportTable::job_name(std::size_t row, const std::vector<int>& by) const {
  std::string name;
  for (const int c : by) {
    const ReportColumn& column = columns[static_cast<std::size_t>(c)];
    const std::string& value = rows[row][static_cast<std::size_t>(c)];
    name += (name.empty() ? "" : ", ") +
            (column.is_numeric ? column.name.substr(column.name.rfind('.') + 1) + " " : "") + value;
  }
  return name.empty() ? "all jobs" : name;
}

ReportTable read_report_table(const std::string& csv, const std::vector<std::string>& paths,
                              const std::vector<std::string>& reference, const ParameterSet& rows) {
  ReportTable table;
  const bool is_formula = reference.size() == 1 && reference.front().starts_with("case:");
  std::vector<std::vector<std::string>> lines = parse_csv(csv);
  if (lines.empty()) return table;
  for (const std::string& name : lines.front()) {
    ReportColumn column;
    column.name = name;
    // a path of a parameter has a point in it, and no figure has
    if (std::find(paths.begin(), paths.end(), name) != paths.end()) {
      column.kind = ReportColumn::varied;
      column.label = name;
      column.is_main = true;
      if (const Parameter* row = rows.find(name)) column.unit = row->unit, column.doc = row->doc;
      column.in_reference = std::any_of(reference.begin(), reference.end(),
                                        [&](const std::string& text) { return text.rfind(name + "=", 0) == 0; }) ||
                            is_formula;
    } else {
      column.kind = kind_of(name);
      describe(column);
    }
    table.columns.push_back(column);
  }
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i].size() == table.columns.size()) table.rows.push_back(lines[i]);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    ReportColumn& column = table.columns[c];
    std::set<std::string> values;
    bool all = true;
    double value = 0.0;
    for (const auto& row : table.rows) {
      values.insert(row[c]);
      all = all && (row[c].empty() || parses(row[c], value));
    }
    column.distinct = static_cast<int>(values.size());
    const bool only_empty = values.empty() || (values.size() == 1 && values.begin()->empty());
    const bool may = column.kind == ReportColumn::varied || column.kind >= ReportColumn::figure;
    column.is_numeric = may && all && !only_empty;
    if (only_empty) column.is_main = false;
    // what is the same nothing in every job has no place among the main figures
    if (column.kind == ReportColumn::figure && values == std::set<std::string>{"0"}) column.is_main = false;
  }
  mark_joined(table);
  if (const int cpu = table.column("step_cpu_ms"); cpu < 0 || !table.columns[static_cast<std::size_t>(cpu)].is_main)
    for (ReportColumn& column : table.columns) column.is_main |= column.name == "step_ms";
  return table;
}

}  // namespace impinge
