#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/units.hpp"
#include "engine/shapes/shape.hpp"
#include "engine/world/figures.hpp"
#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {
namespace {

constexpr Color kLabel = hex(0xa7b0bd), kValue = hex(0xf2f4f7), kWarning = hex(0xffb000);
constexpr float kBetween = 18.0f;

struct Row {
  std::string label, value;
  bool brief = false;  ///< shown in small pictures too
  Color ink = kValue;
};

/// 12 345 678: groups of three are read at a glance.
std::string grouped(std::int64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

void add_deformable(std::vector<Row>& rows, const StepRecord& record) {
  std::int64_t tetrahedra = 0, unknowns = 0;
  for (const BodyRecord& body : record.bodies) {
    if (body.deformable == nullptr) continue;
    tetrahedra += static_cast<std::int64_t>(body.deformable->fem.rest().tets.size());
    unknowns += body.deformable->dofs();
  }
  if (tetrahedra == 0) return;
  const double energy = std::abs(record.stats.elastic);
  rows.push_back({"tetrahedra", grouped(tetrahedra)});
  rows.push_back({"their unknowns", grouped(unknowns)});
  rows.push_back({"elastic energy", energy > 0.0 && energy < 0.1 ? fmt::format("{:.3g} mJ", 1e3 * record.stats.elastic)
                                                                 : fmt::format("{:.4g} J", record.stats.elastic)});
}

/// A figure of the table in the panel's words.
struct Shown {
  const char* figure;
  const char* label;
  bool brief;
  std::string (*text)(double value, const Unit& length);
};

/// What overlaps are said in: millimetres, unless the bodies are so small, or so large, that these would be all zeros or
/// all digits. By what doesn't change while they move.
Unit length_of(const StepRecord& record) {
  double smallest = INFINITY;
  for (const BodyRecord& body : record.bodies)
    if (body.shape != nullptr && (body.kind == BodyKind::dynamic || body.kind == BodyKind::deformable))
      smallest = std::min(smallest, body.shape->size());
  if (smallest < 1e-5) return {"nm", 1e-9};
  if (smallest < 1e-2) return {"µm", 1e-6};
  if (smallest > 1e2 && std::isfinite(smallest)) return {"m", 1.0};
  return {"mm", 1e-3};
}

std::string number(double value, const Unit&) { return grouped(static_cast<std::int64_t>(value)); }

constexpr Shown kShown[] = {
    {"frame", "frame", true, number},
    {"time_s", "time", true, [](double s, const Unit&) { return fmt::format("{:.4f} s", s); }},
    {"broad_pairs", "body pairs", false, number},
    {"triangle_pairs", "triangle pairs", false, number},
    {"contacts", "contacts", true, number},
    {"groups", "groups", false, number},
    {"max_penetration_m", "penetration", true,
     [](double m, const Unit& length) { return fmt::format("{:.4f} {}", m / length.size, length.name); }},
    {"lcp_iterations", "iterations", false, number},
    {"residual", "residual", true,
     [](double v, const Unit&) { return v > 0.0 ? fmt::format("{:.1e} m/s", v) : "0 m/s"; }},
};

/// Of a column of milliseconds. The picture's own time is not known while it is drawn.
bool is_stage(const Figure& figure) { return figure.kind == FigureKind::time && figure.name != "render_ms"; }

std::vector<Row> rows_of(const StepRecord& record, bool timings) {
  const FrameStats& s = record.stats;
  const auto dynamic = std::count_if(record.bodies.begin(), record.bodies.end(), [](const BodyRecord& b) {
    return !b.deleted && (b.kind == BodyKind::dynamic || b.kind == BodyKind::deformable);
  });
  const Unit length = length_of(record);
  std::vector<Row> rows;
  for (const Shown& shown : kShown)
    rows.push_back({shown.label, shown.text(find_figure(shown.figure)->value(s), length), shown.brief});
  rows.push_back({"asleep", fmt::format("{} of {}", s.asleep, dynamic)});
  const auto deleted =
      std::count_if(record.bodies.begin(), record.bodies.end(), [](const BodyRecord& b) { return b.deleted; });
  if (deleted > 0) rows.push_back({"deleted", grouped(deleted)});
  add_deformable(rows, record);
  if (s.unconverged > 0) rows.push_back({"not converged", grouped(s.unconverged), true, kWarning});
  if (s.unsafe_motions > 0) rows.push_back({"unsafe motions", grouped(s.unsafe_motions), true, kWarning});
  if (timings)
    for (const Figure& figure : figures())
      if (is_stage(figure))
        rows.push_back({std::string(figure.name.substr(0, figure.name.size() - 3)),
                        fmt::format("{:.2f} ms", figure.value(s)), true});
  return rows;
}

}  // namespace

bool panels_meet(const PanelArea& a, const PanelArea& b) {
  return a.width > 0.0f && b.width > 0.0f && a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height &&
         b.y < a.y + a.height;
}

PanelArea draw_figures(const Pen& pen, const StepRecord& record, const ViewSettings& settings) {
  if (!settings.show_figures) return {};
  std::vector<Row> rows = rows_of(record, settings.show_timings);
  if (pen.is_small()) std::erase_if(rows, [](const Row& row) { return !row.brief; });
  float labels = 0.0f,
        values = pen.text_width("0.0000000 mm");  // wide enough that it seldom changes from frame to frame
  for (const Row& row : rows) {
    labels = std::max(labels, pen.text_width(row.label));
    values = std::max(values, pen.text_width(row.value));
  }
  const float pad = pen.padding();
  PanelArea area{pen.margin(), pen.margin(),
                 labels + values + 2.0f * pad + (pen.is_small() ? 0.5f : 1.0f) * kBetween * pen.unit,
                 static_cast<float>(rows.size()) * pen.row() + 2.0f * pad - (pen.row() - pen.text_size)};
  if (area.width > 0.5f * pen.picture_width || area.height + 2.0f * pen.margin() > pen.picture_height) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  float y = area.y + pad;
  for (const Row& row : rows) {
    pen.text(area.x + pad, y, kLabel, row.label);
    pen.text(area.x + area.width - pad - pen.text_width(row.value), y, row.ink, row.value);
    y += pen.row();
  }
  return area;
}

}  // namespace impinge
