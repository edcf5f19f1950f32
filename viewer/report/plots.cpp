// What the report's two pictures show, and the page's plots before anybody chooses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "viewer/report/parts.hpp"

namespace impinge {

namespace {

std::string heading(const ReportColumn& column) {
  return column.unit.empty() ? column.label : fmt::format("{} ({})", column.label, column.unit);
}

std::vector<std::string> values_of(const ReportTable& table, int column) {
  std::vector<std::string> values;
  for (const auto& row : table.rows)
    if (std::find(values.begin(), values.end(), row[static_cast<std::size_t>(column)]) == values.end())
      values.push_back(row[static_cast<std::size_t>(column)]);
  return values;
}

std::vector<int> varied_columns(const ReportTable& table) {
  std::vector<int> list;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].kind == ReportColumn::varied) list.push_back(static_cast<int>(c));
  return list;
}

/// Whether every job that ended well has a number there.
bool has_in_all_done(const ReportTable& table, int column) {
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.cell(i, "status") == "done" && !std::isfinite(table.number(i, column))) return false;
  return true;
}

}  // namespace

ReportChoice choose_columns(const ReportTable& table) {
  ReportChoice choice;
  const auto first_of = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (table.has_positive(table.column(name))) return table.column(name);
    return -1;
  };
  // times of one kind: a job that was stopped and went on has none of the processor's
  const bool all_have_cpu = has_in_all_done(table, table.column("step_cpu_ms"));
  choice.x = all_have_cpu ? first_of({"step_cpu_ms", "step_ms", "wall_ms"}) : first_of({"step_ms", "wall_ms"});
  choice.y = first_of({"error_rms_m", "penetration_max_m", "residual_max", "contacts_max"});
  choice.measure = first_of({"error_rms_m", "step_ms", "wall_ms"});
  if (choice.measure == table.column("step_ms")) choice.measure = choice.x;
  choice.has_errors =
      choice.y >= 0 && table.columns[static_cast<std::size_t>(choice.y)].kind == ReportColumn::error && choice.x >= 0;
  return choice;
}

Plot work_precision_plot(const ReportTable& table, const ReportChoice& choice, const std::string& title) {
  Plot plot;
  plot.title = title + ": error against time";
  plot.x_label = heading(table.columns[static_cast<std::size_t>(choice.x)]);
  plot.y_label = heading(table.columns[static_cast<std::size_t>(choice.y)]);
  plot.marks_all = true;
  plot.best_label = "ringed: nothing is both faster and more exact";
  plot.doubtful_label = "crossed out: in doubt, and no part of the front";
  std::vector<int> keys;
  for (const int c : varied_columns(table)) {
    const ReportColumn& column = table.columns[static_cast<std::size_t>(c)];
    if (!column.is_joined) keys.push_back(c);
  }
  const std::vector<bool> best = table.best(choice.x, choice.y);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Vec2 point(table.number(i, choice.x), table.number(i, choice.y));
    if (!(point.x() > 0.0 && point.y() > 0.0)) continue;
    const std::string name = table.job_name(i, keys);
    auto series =
        std::find_if(plot.series.begin(), plot.series.end(), [&](const PlotSeries& s) { return s.name == name; });
    if (series == plot.series.end()) series = plot.series.insert(plot.series.end(), {name, {}});
    series->points.push_back(point);
    if (best[i]) plot.best.push_back(point);
    if (!table.cell(i, "doubts").empty()) plot.doubtful.push_back(point);
  }
  return plot;
}

bool heat_table_of(const ReportTable& table, const ReportChoice& choice, const std::string& title, HeatTable& heat) {
  std::vector<int> axes;
  for (const int c : varied_columns(table))
    if (table.columns[static_cast<std::size_t>(c)].distinct > 1) axes.push_back(c);
  if (axes.size() < 2 || choice.measure < 0) return false;
  const std::vector<std::string> down = values_of(table, axes[0]), across = values_of(table, axes[1]);
  std::set<std::pair<std::string, std::string>> pairs;
  for (const auto& row : table.rows)
    pairs.emplace(row[static_cast<std::size_t>(axes[0])], row[static_cast<std::size_t>(axes[1])]);
  if (2 * pairs.size() < down.size() * across.size()) return false;  // zipped: a line, and no table
  heat.title = title;
  heat.row_label = table.columns[static_cast<std::size_t>(axes[0])].name;
  heat.column_label = table.columns[static_cast<std::size_t>(axes[1])].name;
  heat.value_label = heading(table.columns[static_cast<std::size_t>(choice.measure)]);
  heat.rows = down, heat.columns = across;
  heat.values.assign(down.size() * across.size(), std::numeric_limits<double>::quiet_NaN());
  heat.notes.assign(heat.values.size(), "not run");
  heat.doubtful.assign(heat.values.size(), false);
  for (std::size_t k = 2; k < axes.size(); ++k) {
    const auto c = static_cast<std::size_t>(axes[k]);
    heat.title += fmt::format("{}{} = {}", k == 2 ? ", at " : ", ", table.columns[c].name, table.rows.front()[c]);
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    bool shown = true;
    for (std::size_t k = 2; k < axes.size(); ++k)
      shown = shown && row[static_cast<std::size_t>(axes[k])] == table.rows.front()[static_cast<std::size_t>(axes[k])];
    if (!shown) continue;
    const auto at = [&](const std::vector<std::string>& list, int axis) {
      return static_cast<std::size_t>(std::find(list.begin(), list.end(), row[static_cast<std::size_t>(axis)]) -
                                      list.begin());
    };
    const std::size_t cell = at(down, axes[0]) * across.size() + at(across, axes[1]);
    heat.values[cell] = table.number(i, choice.measure);
    heat.notes[cell] = table.cell(i, "status") == "done" ? "" : table.cell(i, "status");
    heat.doubtful[cell] = !table.cell(i, "doubts").empty();
  }
  return true;
}

}  // namespace impinge
