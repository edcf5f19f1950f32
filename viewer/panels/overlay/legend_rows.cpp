#include "viewer/panels/overlay/legend_rows.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/draw/number_text.hpp"

namespace impinge {
namespace {

constexpr float kDiscShare = 0.25f;  // of the longest arrow's length: a disc stays in its row

const MarkScale* scale_of(const DrawList& list, std::string_view layer, Color color) {
  const auto it = std::find_if(list.scales.begin(), list.scales.end(),
                               [&](const MarkScale& s) { return s.layer == layer && s.color == color; });
  return it == list.scales.end() ? nullptr : &*it;
}

std::string with_quantity(std::string text, const std::string& quantity) {
  const std::size_t at = text.find("{}");
  return at == std::string::npos ? text : text.replace(at, 2, quantity);
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive value.
double rounded_down(double value) {
  const double up = rounded_up(value);
  if (up <= value * (1.0 + 1e-12)) return up;
  const bool is_five = std::abs(up / std::pow(10.0, std::floor(std::log10(up) + 1e-9)) - 5.0) < 0.1;
  return up / (is_five ? 2.5 : 2.0);
}

/// Puts what the mark stands for into the row: the scale's value, or where its size is too large or too small to be
/// shown a round part or multiple of it.
void set_quantity(ShownRow& row, const MarkScale& scale, float pixel_scale, float least, float most) {
  const bool is_disc = row.mark == LegendRow::disc;  // whose area goes with the quantity
  if (is_disc) most *= kDiscShare;
  const double size = static_cast<double>(scale.size_px * pixel_scale);
  const auto amount_of = [&](double wanted) {
    return scale.value * (is_disc ? wanted * wanted / (size * size) : wanted / size);
  };
  double amount = scale.value;
  if (size > most) amount = rounded_down(amount_of(most));
  if (size > 0.0 && size < least)
    if (const double more = rounded_up(amount_of(least)); scale.most <= 0.0 || more <= scale.most) amount = more;
  const double share = amount / scale.value;
  row.size = static_cast<float>(size * (is_disc ? std::sqrt(share) : share));
  row.quantity = round_text(amount, scale.unit);
  row.text = with_quantity(std::move(row.text), row.quantity);
}

/// None: there is nothing to be explained.
std::optional<Color> color_of(const LegendRow& row, const Layer& layer, const StepRecord& record,
                              const DrawList& list) {
  if (row.found != nullptr) return row.found(list);
  const bool is_there = row.present == nullptr ? list.has_color(layer.name, row.color) : row.present(record);
  return is_there ? std::optional(row.color) : std::nullopt;
}

}  // namespace

std::vector<ShownRow> legend_rows(const StepRecord& record, const DrawList& list, const ViewSettings& settings,
                                  float pixel_scale, float least, float most) {
  std::vector<ShownRow> rows;
  for (const Layer& layer : layers()) {
    if (!settings.is_on(layer.name)) continue;
    for (const LegendRow& row : layer.legend) {
      const std::optional<Color> color = color_of(row, layer, record, list);
      if (!color || (row.used != nullptr && !row.used(settings))) continue;
      ShownRow& shown = rows.emplace_back(ShownRow{row.mark, *color, row.text});
      const MarkScale* scale = scale_of(list, layer.name, row.color);
      if (scale == nullptr) continue;
      set_quantity(shown, *scale, pixel_scale, least, most);
      if (!list.has_cut_arrow(layer.name, row.color)) continue;
      const std::string quantity = "over " + round_text(scale->most, scale->unit);
      rows.push_back({row.mark, row.color, quantity, quantity, 0.0f, true});
    }
  }
  return rows;
}

}  // namespace impinge
