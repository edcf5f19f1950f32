#include "viewer/controller/stats_table.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <span>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {

namespace {

struct Column {
  const char* name;
  double (*value)(const FrameStats&, const FrameExtras&);
  bool whole;
};

// the order is a contract; new columns go to the end
constexpr Column kColumns[] = {
    {"frame", [](const FrameStats& s, const FrameExtras&) { return double(s.frame); }, true},
    {"time_s", [](const FrameStats& s, const FrameExtras&) { return s.time; }, false},
    {"substeps", [](const FrameStats& s, const FrameExtras&) { return double(s.substeps); }, true},
    {"bodies", [](const FrameStats& s, const FrameExtras&) { return double(s.bodies); }, true},
    {"dofs", [](const FrameStats& s, const FrameExtras&) { return double(s.dofs); }, true},
    {"broad_pairs", [](const FrameStats& s, const FrameExtras&) { return double(s.broad_pairs); }, true},
    {"triangle_pairs", [](const FrameStats& s, const FrameExtras&) { return double(s.triangle_pairs); }, true},
    {"contacts", [](const FrameStats& s, const FrameExtras&) { return double(s.contacts); }, true},
    {"groups", [](const FrameStats& s, const FrameExtras&) { return double(s.groups); }, true},
    {"max_penetration_m", [](const FrameStats& s, const FrameExtras&) { return s.max_penetration; }, false},
    {"residual", [](const FrameStats& s, const FrameExtras&) { return s.residual; }, false},
    {"lcp_iterations", [](const FrameStats& s, const FrameExtras&) { return double(s.lcp_iterations); }, true},
    {"outer_iterations", [](const FrameStats& s, const FrameExtras&) { return double(s.outer_iterations); }, true},
    {"kinetic_J", [](const FrameStats& s, const FrameExtras&) { return s.kinetic; }, false},
    {"potential_J", [](const FrameStats& s, const FrameExtras&) { return s.potential; }, false},
    {"elastic_J", [](const FrameStats& s, const FrameExtras&) { return s.elastic; }, false},
    {"momentum_x", [](const FrameStats& s, const FrameExtras&) { return s.momentum.x(); }, false},
    {"momentum_y", [](const FrameStats& s, const FrameExtras&) { return s.momentum.y(); }, false},
    {"momentum_z", [](const FrameStats& s, const FrameExtras&) { return s.momentum.z(); }, false},
    {"angular_momentum_x", [](const FrameStats& s, const FrameExtras&) { return s.angular_momentum.x(); }, false},
    {"angular_momentum_y", [](const FrameStats& s, const FrameExtras&) { return s.angular_momentum.y(); }, false},
    {"angular_momentum_z", [](const FrameStats& s, const FrameExtras&) { return s.angular_momentum.z(); }, false},
    {"broad_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.broad_ms; }, false},
    {"narrow_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.narrow_ms; }, false},
    {"assemble_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.assemble_ms; }, false},
    {"response_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.response_ms; }, false},
    {"integrate_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.integrate_ms; }, false},
    {"step_ms", [](const FrameStats& s, const FrameExtras&) { return s.times.step_ms; }, false},
    {"render_ms", [](const FrameStats&, const FrameExtras& e) { return e.render_ms; }, false},
    {"state_hash", nullptr, false},
    {"unconverged", [](const FrameStats& s, const FrameExtras&) { return double(s.unconverged); }, true},
    {"asleep", [](const FrameStats& s, const FrameExtras&) { return double(s.asleep); }, true},
    {"judged_penetration_m", [](const FrameStats&, const FrameExtras& e) { return e.judged_penetration; }, false},
    {"judged_intersections", [](const FrameStats&, const FrameExtras& e) { return double(e.judged_intersections); },
     true},
};

std::span<const Column> columns(bool judged) {
  return std::span(kColumns).first(std::size(kColumns) - (judged ? 0 : 2));
}

}  // namespace

std::string stats_header(bool judged) {
  std::string line;
  for (const Column& column : columns(judged)) line += (line.empty() ? "" : ",") + std::string(column.name);
  return line;
}

std::string stats_row(const FrameStats& stats, const FrameExtras& extras, bool judged) {
  std::string line;
  for (const Column& column : columns(judged)) {
    if (&column != kColumns) line += ',';
    if (column.value == nullptr)
      line += hex64(stats.state_hash);
    else if (column.whole)
      line += std::to_string(static_cast<std::int64_t>(column.value(stats, extras)));
    else
      line += shortest(column.value(stats, extras));
  }
  return line;
}

const std::vector<std::string>& figure_names(bool judged) {
  const auto names = [](bool with) {
    std::vector<std::string> list;
    for (const Column& column : columns(with))
      if (column.value != nullptr) list.emplace_back(column.name);
    return list;
  };
  static const std::vector<std::string> plain = names(false), all = names(true);
  return judged ? all : plain;
}

std::vector<double> figure_values(const FrameStats& stats, const FrameExtras& extras, bool judged) {
  std::vector<double> values;
  for (const Column& column : columns(judged))
    if (column.value != nullptr) values.push_back(column.value(stats, extras));
  return values;
}

void check_figures(const FrameStats& stats, const FrameExtras& extras, bool judged) {
  for (const Column& column : columns(judged))
    if (column.value != nullptr && !std::isfinite(column.value(stats, extras)))
      throw DivergenceError(fmt::format("frame {}: {} is {}, and every figure must be finite; use more sub-steps",
                                        stats.frame, column.name, column.value(stats, extras)));
}

StatsLine parse_stats_row(std::string_view line, bool judged) {
  StatsLine row;
  for (const Column& column : columns(judged)) {
    const std::size_t end = std::min(line.find(','), line.size());
    const std::string_view word = line.substr(0, end);
    if (column.value == nullptr) {
      row.state_hash = std::string(word);
    } else {
      double value = 0.0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || stop != word.data() + word.size())
        throw InputError(
            fmt::format("stats.csv: '{}' in column {}; a number is wanted; run the scene again", word, column.name));
      row.figures.push_back(value);
    }
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return row;
}

}  // namespace impinge
