#include "viewer/controller/stats_table.hpp"

#include <fmt/format.h>

#include <charconv>

#include "engine/core/archive.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

struct Column {
  const char* name;
  double (*value)(const FrameStats&, double render_ms);
  bool whole;
};

// the order is a contract; new columns go to the end
constexpr Column kColumns[] = {
    {"frame", [](const FrameStats& s, double) { return double(s.frame); }, true},
    {"time_s", [](const FrameStats& s, double) { return s.time; }, false},
    {"substeps", [](const FrameStats& s, double) { return double(s.substeps); }, true},
    {"bodies", [](const FrameStats& s, double) { return double(s.bodies); }, true},
    {"dofs", [](const FrameStats& s, double) { return double(s.dofs); }, true},
    {"broad_pairs", [](const FrameStats& s, double) { return double(s.broad_pairs); }, true},
    {"triangle_pairs", [](const FrameStats& s, double) { return double(s.triangle_pairs); }, true},
    {"contacts", [](const FrameStats& s, double) { return double(s.contacts); }, true},
    {"groups", [](const FrameStats& s, double) { return double(s.groups); }, true},
    {"max_penetration_m", [](const FrameStats& s, double) { return s.max_penetration; }, false},
    {"residual", [](const FrameStats& s, double) { return s.residual; }, false},
    {"lcp_iterations", [](const FrameStats& s, double) { return double(s.lcp_iterations); }, true},
    {"outer_iterations", [](const FrameStats& s, double) { return double(s.outer_iterations); }, true},
    {"kinetic_J", [](const FrameStats& s, double) { return s.kinetic; }, false},
    {"potential_J", [](const FrameStats& s, double) { return s.potential; }, false},
    {"elastic_J", [](const FrameStats& s, double) { return s.elastic; }, false},
    {"momentum_x", [](const FrameStats& s, double) { return s.momentum.x(); }, false},
    {"momentum_y", [](const FrameStats& s, double) { return s.momentum.y(); }, false},
    {"momentum_z", [](const FrameStats& s, double) { return s.momentum.z(); }, false},
    {"angular_momentum_x", [](const FrameStats& s, double) { return s.angular_momentum.x(); }, false},
    {"angular_momentum_y", [](const FrameStats& s, double) { return s.angular_momentum.y(); }, false},
    {"angular_momentum_z", [](const FrameStats& s, double) { return s.angular_momentum.z(); }, false},
    {"broad_ms", [](const FrameStats& s, double) { return s.times.broad_ms; }, false},
    {"narrow_ms", [](const FrameStats& s, double) { return s.times.narrow_ms; }, false},
    {"assemble_ms", [](const FrameStats& s, double) { return s.times.assemble_ms; }, false},
    {"response_ms", [](const FrameStats& s, double) { return s.times.response_ms; }, false},
    {"integrate_ms", [](const FrameStats& s, double) { return s.times.integrate_ms; }, false},
    {"step_ms", [](const FrameStats& s, double) { return s.times.step_ms; }, false},
    {"render_ms", [](const FrameStats&, double render_ms) { return render_ms; }, false},
    {"state_hash", nullptr, false},
    {"unconverged", [](const FrameStats& s, double) { return double(s.unconverged); }, true},
    {"asleep", [](const FrameStats& s, double) { return double(s.asleep); }, true},
};

}  // namespace

std::string stats_header() {
  std::string line;
  for (const Column& column : kColumns) line += (line.empty() ? "" : ",") + std::string(column.name);
  return line;
}

std::string stats_row(const FrameStats& stats, double render_ms) {
  std::string line;
  for (const Column& column : kColumns) {
    if (&column != kColumns) line += ',';
    if (column.value == nullptr) line += hex64(stats.state_hash);
    else if (column.whole) line += std::to_string(static_cast<std::int64_t>(column.value(stats, render_ms)));
    else line += shortest(column.value(stats, render_ms));
  }
  return line;
}

const std::vector<std::string>& figure_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Column& column : kColumns)
      if (column.value != nullptr) list.emplace_back(column.name);
    return list;
  }();
  return names;
}

std::vector<double> figure_values(const FrameStats& stats, double render_ms) {
  std::vector<double> values;
  for (const Column& column : kColumns)
    if (column.value != nullptr) values.push_back(column.value(stats, render_ms));
  return values;
}

StatsLine parse_stats_row(std::string_view line) {
  StatsLine row;
  for (const Column& column : kColumns) {
    const std::size_t end = std::min(line.find(','), line.size());
    const std::string_view word = line.substr(0, end);
    if (column.value == nullptr) {
      row.state_hash = word;
    } else {
      double value = 0.0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || stop != word.data() + word.size())
        throw InputError(fmt::format("stats.csv: '{}' in column {}; a number is wanted; run the scene again", word, column.name));
      row.figures.push_back(value);
    }
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return row;
}

}  // namespace impinge
