#include "viewer/panels/debug/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/parameter.hpp"
#include "engine/world/figures.hpp"

namespace impinge {

NumberText Series::text(double value) const {
  if (std::isnan(value)) return {"-", ""};
  if (unit.empty()) return {fmt::format("{:.6g}", value), ""};
  if (unit == "ms") return number_text(1e-3 * value, "s", 4);
  return number_text(value, unit, 4);
}

Series series_of(const DebugModel& model, const std::string& name) {
  if (const std::optional<Quantity> quantity = parse_quantity(name, model.bodies()))
    return {name, std::string(quantity->unit()),
            [&model, q = *quantity](int frame) { return model.tracks->value(frame, q); }};
  const auto column = static_cast<std::size_t>(std::find(model.figure_names->begin(), model.figure_names->end(), name) -
                                               model.figure_names->begin());
  const Figure* figure = find_figure(name);
  return {name, figure == nullptr ? "" : std::string(figure->unit), [&model, column](int frame) {
            const auto row = static_cast<std::size_t>(frame);
            return row < model.history->size() && column < (*model.history)[row].size()
                       ? (*model.history)[row][column]
                       : std::numeric_limits<double>::quiet_NaN();
          }};
}

std::string plots_csv(const DebugModel& model) {
  std::vector<Series> all = {series_of(model, "time_s")};
  for (const std::string& name : model.state.plots) all.push_back(series_of(model, name));
  std::string text = "frame";
  for (const Series& series : all)
    text += series.name.find(',') == std::string::npos ? "," + series.name : ",\"" + series.name + "\"";
  text += '\n';
  for (int frame = 0; frame <= model.known_last; ++frame) {
    text += std::to_string(frame);
    for (const Series& series : all) {
      const double value = series.value(frame);
      text += ',' + (std::isnan(value) ? "" : shortest(value));
    }
    text += '\n';
  }
  return text;
}

}  // namespace impinge
