#include <fmt/format.h>

#include <algorithm>

#include "viewer/panels/panels.hpp"

namespace impinge {
namespace {

constexpr Color kLabel = hex(0xa7b0bd), kValue = hex(0xf2f4f7), kWarning = hex(0xffb000);
constexpr float kMargin = 10.0f, kPadding = 9.0f, kRow = 16.0f, kBetween = 18.0f;

struct Row {
  std::string label, value;
  Color ink = kValue;
};

/// 12 345 678: groups of three are read at a glance.
std::string grouped(std::int64_t number) {
  std::string text = std::to_string(number);
  for (int i = static_cast<int>(text.size()) - 3; i > 0; i -= 3) text.insert(static_cast<std::size_t>(i), " ");
  return text;
}

std::vector<Row> rows_of(const StepRecord& record, bool timings) {
  const FrameStats& s = record.stats;
  const auto dynamic = std::count_if(record.bodies.begin(), record.bodies.end(), [](const BodyRecord& b) { return b.kind == BodyKind::dynamic; });
  std::vector<Row> rows = {
      {"frame", grouped(s.frame)},
      {"time", fmt::format("{:.4f} s", s.time)},
      {"body pairs", grouped(s.broad_pairs)},
      {"triangle pairs", grouped(s.triangle_pairs)},
      {"contacts", grouped(s.contacts)},
      {"groups", grouped(s.groups)},
      {"penetration", fmt::format("{:.4f} mm", 1e3 * s.max_penetration)},
      {"iterations", grouped(s.lcp_iterations)},
      {"residual", s.residual > 0.0 ? fmt::format("{:.1e} m/s", s.residual) : "0 m/s"},
      {"asleep", fmt::format("{} of {}", s.asleep, dynamic)},
  };
  if (s.unconverged > 0) rows.push_back({"not converged", grouped(s.unconverged), kWarning});
  if (timings)
    for (const auto& [name, ms] : {std::pair{"broad", s.times.broad_ms},
                                   {"narrow", s.times.narrow_ms},
                                   {"assemble", s.times.assemble_ms},
                                   {"response", s.times.response_ms},
                                   {"integrate", s.times.integrate_ms},
                                   {"step", s.times.step_ms}})
      rows.push_back({name, fmt::format("{:.2f} ms", ms)});
  return rows;
}

}  // namespace

PanelArea draw_figures(const Pen& pen, const StepRecord& record, const ViewSettings& settings) {
  if (!settings.show_figures) return {};
  const std::vector<Row> rows = rows_of(record, settings.show_timings);
  const float u = pen.unit;
  float labels = 0.0f,
        values = pen.text_width("0.0000000 mm");  // wide enough that it seldom changes from frame to frame
  for (const Row& row : rows) {
    labels = std::max(labels, pen.text_width(row.label));
    values = std::max(values, pen.text_width(row.value));
  }
  PanelArea area{kMargin * u, kMargin * u, labels + values + (2.0f * kPadding + kBetween) * u,
                 (static_cast<float>(rows.size()) * kRow + 2.0f * kPadding - (kRow - 13.0f)) * u};
  if (area.width > 0.5f * pen.picture_width || area.height + 2.0f * kMargin * u > pen.picture_height) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  float y = area.y + kPadding * u;
  for (const Row& row : rows) {
    pen.text(area.x + kPadding * u, y, kLabel, row.label);
    pen.text(area.x + area.width - kPadding * u - pen.text_width(row.value), y, row.ink, row.value);
    y += kRow * u;
  }
  return area;
}

}  // namespace impinge
