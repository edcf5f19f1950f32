// A widget for every parameter row, made from the row alone: kind, range, unit, names, sentence, what it was at first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include <imgui.h>
#include <imgui_internal.h>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {
namespace {

/// A number that a person would write.
double rounded(double v) { return std::stod(fmt::format("{:.4g}", v)); }

/// 0 of a number that is left open.
double number_in(const ParameterValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  const auto* real = std::get_if<double>(&value);
  return real == nullptr ? 0.0 : *real;
}

/// What a slider goes over: the row's range if one can find one's way in it, else what is near the first value, a thousand
/// times less and more where it goes by decades.
Range slider_range(const Parameter& row, double now) {
  Range r = row.range;
  const double first = number_in(row.initial);
  if (r.logarithmic) {
    const double middle = std::abs(first) > 0.0 ? std::abs(first) : row.word.empty() ? 1.0 : 0.01;
    double down = std::log10(middle / std::max(r.low, 1e-3 * middle)),
           upward = std::log10(std::min(r.high, 1e3 * middle) / middle);
    // what it was at first stands in the middle, unless the row's range ends near it
    if (std::min(down, upward) >= 2.0) down = upward = std::min(down, upward);
    const double low = middle * std::pow(10.0, -down), high = middle * std::pow(10.0, upward);
    return {std::max(r.low, std::min(low, now > 0.0 ? now : middle)), std::min(r.high, std::max(high, now)), true};
  }
  // not by the present value: the scale would move under the pointer
  double reach = first != 0.0 ? 4.0 * std::abs(first) : 1.0;
  if (r.high - r.low <= 10.0 * reach) return r;
  if (std::abs(now) > reach) reach = 2.0 * std::abs(now);
  return {std::max(r.low, r.low < 0.0 ? -reach : r.low), std::min(r.high, reach), false};
}

std::string about_parameter(const Parameter& row) {
  std::string text =
      row.path + "\n" + row.doc + "\n" + describe_allowed(row) + "; at first " + format_value(row.initial);
  if (!row.live) text += "\ncan't change while running";
  return text;
}

std::string short_name(const Parameter& row) { return row.path.substr(row.path.rfind('.') + 1); }
std::string group_of(const Parameter& row) { return row.path.substr(0, row.path.rfind('.')); }

/// A slider that can be typed into. `set` takes the text of the new value.
void draw_number(Ui& ui, const Parameter& row, const ParameterValue& value, const std::string& name,
                 const std::function<void(const std::string&)>& set) {
  const bool whole = row.kind == ParameterKind::integer;
  const bool is_open = std::holds_alternative<std::string>(value);
  double now = number_in(value);
  const Range range = slider_range(row, now);
  std::string format = whole ? "%.0f" : "%.4g";
  if (!row.unit.empty()) format += " " + row.unit;
  const double before = now;
  double at = range.logarithmic ? std::log10(std::max(now, range.low)) : now;
  const double low = range.logarithmic ? std::log10(range.low) : range.low,
               high = range.logarithmic ? std::log10(range.high) : range.high;
  // ImGui's own logarithm loses small numbers
  if (range.logarithmic) format = fmt::format("{:.4g} {}", now, row.unit);
  if (is_open) format = row.word;
  // a value that is being typed counts when it is entered, not letter by letter
  UiTyping& typing = ui.typing();
  if (typing.parameter == row.path) {
    if (typing.begins) ImGui::SetKeyboardFocusHere();
    double typed = now;
    if (ImGui::InputDouble("##v", &typed, 0.0, 0.0, "%.6g",
                           ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll))
      set(shortest(typed));
    if (!typing.begins && !ImGui::IsItemActive()) typing.parameter.clear();
    typing.begins = false;
    ui.name(name, {{}, false, true, false, low, high, range.logarithmic});
    return;
  }
  bool changed =
      ImGui::SliderScalar("##v", ImGuiDataType_Double, &at, &low, &high, format.c_str(), ImGuiSliderFlags_NoInput);
  if (ImGui::IsItemActivated() && ImGui::GetIO().KeyCtrl) {
    ImGui::ClearActiveID();
    changed = false;
    typing.parameter = row.path;
    typing.begins = true;
  }
  if (changed) {
    now = range.logarithmic ? std::pow(10.0, at) : at;
    now = whole ? std::round(now) : rounded(now);
    now = std::clamp(now, row.range.low, row.range.high);
    if (now != before || is_open) set(whole ? fmt::format("{}", static_cast<std::int64_t>(now)) : shortest(now));
  }
  ui.name(name, {{}, false, true, false, low, high, range.logarithmic});
}

/// The widget; writes `set PATH VALUE` where it was changed.
void draw_widget(Ui& ui, const Parameter& row, CommandLines& lines) {
  const std::string name = "parameters/" + row.path;
  const auto set = [&](const std::string& value) { lines.push_back(fmt::format("set {} {}", row.path, value)); };
  const ParameterValue value = row.get();
  switch (row.kind) {
    case ParameterKind::boolean: {
      bool on = std::get<bool>(value);
      if (ImGui::Checkbox("##v", &on)) set(on ? "true" : "false");
      ui.name(name);
      break;
    }
    case ParameterKind::choice: {
      const std::string now = std::get<std::string>(value);
      const bool open = ImGui::BeginCombo("##v", now.c_str());
      ui.name(name);
      if (!open) break;
      for (const std::string& choice : row.names) {
        if (ImGui::Selectable(choice.c_str(), choice == now) && choice != now) set(choice);
        ui.name(fmt::format("{}:{}", name, choice));
      }
      close_on_escape(ui);
      ImGui::EndCombo();
      break;
    }
    case ParameterKind::integer:
    case ParameterKind::real:
      draw_number(ui, row, value, name, set);
      break;
    case ParameterKind::vector3: {
      Vec3 now = std::get<Vec3>(value);
      ImGui::InputScalarN("##v", ImGuiDataType_Double, now.data(), 3, nullptr, nullptr, "%.4g");
      if (ImGui::IsItemDeactivatedAfterEdit()) set(format_value(now));
      ui.name(name);
      break;
    }
    case ParameterKind::text:
    case ParameterKind::text_list:
      ImGui::TextColored(dim(), "%s", format_value(value).c_str());
      break;
  }
}

void draw_parameters(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const std::optional<std::string> typed = search_field(ui, "parameters/search", model.state.filter);
  if (typed) lines.push_back("panel filter " + *typed);
  const std::string word = typed.value_or(model.state.filter);
  const float label = 0.53f * ImGui::GetContentRegionAvail().x;
  std::string group;
  bool open = false;
  for (std::size_t i = 0; i < model.rows_present; ++i) {
    const Parameter& row = model.rows->all()[i];
    // panels and mouse of their own
    if (row.path.starts_with("view.layer") || row.path.starts_with("view.camera")) continue;
    if (!word.empty() && row.path.find(word) == std::string::npos) continue;
    if (group_of(row) != group) {
      group = group_of(row);
      const bool folded = model.state.folded.contains(group) && word.empty();
      const bool asked = folded && ui.wanted().starts_with("parameters/" + group + ".");
      ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetStyleColorVec4(ImGuiCol_FrameBg));
      if (ImGui::Selectable(fmt::format("{} {}##{}", folded ? "+" : "-", group, group).c_str(), true) || asked)
        lines.push_back(fmt::format("panel {} {}", folded ? "unfold" : "fold", group));
      ImGui::PopStyleColor();
      ui.name("parameters/" + group);
      open = !folded;
    }
    if (!open) continue;
    ImGui::PushID(row.path.c_str());
    const bool changed = row.live && format_value(row.get()) != format_value(row.initial);
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, changed    ? ImVec4(1.0f, 0.78f, 0.35f, 1.0f)
                                         : row.live ? ImGui::GetStyleColorVec4(ImGuiCol_Text)
                                                    : dim());
    ImGui::TextUnformatted(short_name(row).c_str());
    ImGui::PopStyleColor();
    tooltip(about_parameter(row));
    ImGui::SameLine(label);
    ImGui::BeginDisabled(!row.live);
    ImGui::SetNextItemWidth(changed ? -22.0f * ui.unit() : -1.0f);
    draw_widget(ui, row, lines);
    tooltip(about_parameter(row));
    ImGui::EndDisabled();
    if (changed) {
      ImGui::SameLine(0.0f, 3.0f * ui.unit());
      if (named_button(ui, "parameters/" + row.path + ":reset", "x"))
        lines.push_back(fmt::format("set {} {}", row.path, format_value(row.initial)));
      tooltip("back to " + format_value(row.initial));
    }
    ImGui::PopID();
  }
}

}  // namespace

Panel parameters_panel() { return {"parameters", "parameters", PanelPlace::left, {}, draw_parameters}; }

}  // namespace impinge
