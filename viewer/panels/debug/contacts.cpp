// The frame's contacts as a table. A heading sorts, a row selects.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

constexpr std::size_t kContactColumns = 13;

Color state_color(ContactState state) {
  return state == ContactState::stick ? role::kStick : state == ContactState::slip ? role::kSlip : role::kOpen;
}

std::vector<double> contact_numbers(const StepRecord& record) {
  std::vector<double> numbers;
  numbers.reserve(kContactColumns * record.contacts.size());
  const double step = substep_time(record);
  for (std::size_t i = 0; i < record.contacts.size(); ++i) {
    const ContactRecord& c = record.contacts[i];
    const double friction = std::hypot(c.lambda.y(), c.lambda.z()), most = c.friction * c.lambda.x();
    const double row[kContactColumns] = {static_cast<double>(i),
                                         static_cast<double>(c.body_a.value()),
                                         static_cast<double>(c.body_b.value()),
                                         c.gap,
                                         c.lambda.x(),
                                         friction,
                                         c.gap0,
                                         step > 0.0 ? c.lambda.x() / step : kNone,
                                         most > 0.0 ? 100.0 * friction / most : kNone,
                                         static_cast<double>(c.friction),
                                         c.group.is_none() ? kNone : static_cast<double>(c.group.value()),
                                         c.residual,
                                         static_cast<double>(c.state)};
    numbers.insert(numbers.end(), std::begin(row), std::end(row));
  }
  return numbers;
}

void draw_state(ContactState state) {
  const Color s = state_color(state);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float half = 0.5f * ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddCircleFilled({at.x + half, at.y + half}, 0.7f * half,
                                              ImGui::ColorConvertFloat4ToU32({s.r, s.g, s.b, 1.0f}));
}

std::string count_of_contacts(const DebugModel& model) {
  const int asleep = model.record->stats.asleep;  // their contacts are not looked for
  return fmt::format(": {}{}", model.record->contacts.size(), asleep > 0 ? fmt::format(" ({} asleep)", asleep) : "");
}

void draw_contacts(Ui& ui, const DebugModel& model, CommandLines& lines) {
  const std::vector<ContactRecord>& contacts = model.record->contacts;
  TableRows rows;
  rows.numbers = contact_numbers(*model.record);
  rows.shown.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) rows.shown[i] = i;
  rows.words = [&](std::size_t row, std::size_t column) {
    return name_of(model, column == 1 ? contacts[row].body_a : contacts[row].body_b);
  };
  rows.name = [](std::size_t) { return std::string(); };
  rows.select = [](std::size_t row) { return fmt::format("select contact {}", row); };
  rows.tip = [&](std::size_t row) {
    return fmt::format("{} and {}, {}", name_of(model, contacts[row].body_a), name_of(model, contacts[row].body_b),
                       state_name(contacts[row].state));
  };
  rows.is_selected = [&](std::size_t row) {
    return model.selection.kind == Selection::contact && model.selection.index == static_cast<int>(row);
  };
  rows.is_dim = [](std::size_t) { return false; };
  rows.draw_mark = [&](std::size_t row, std::size_t) { draw_state(contacts[row].state); };
  draw_table(ui, model, lines, "contacts", contacts_table(), rows);
}

}  // namespace

const Table& contacts_table() {
  using C = TableColumn;
  static const Table table = {
      "contacts",
      {{"index", "#", "", C::whole, 4, true, "index in this frame"},
       {"a", "A", "", C::words, 5, true, "the body that stands earlier in the scene"},
       {"b", "B", "", C::words, 5, true, "the other body"},
       {"gap", "gap", "m", C::number, 0, true, "at the end of the frame; negative: they overlap"},
       {"normal", "n", "N s", C::number, 0, true, "normal impulse of the last sub-step"},
       {"friction", "t", "N s", C::number, 0, true, "size of the friction impulse of the last sub-step"},
       {"gap0", "gap0", "m", C::number, 0, false, "the gap that the solver saw"},
       {"force", "force", "N", C::number, 0, false, "normal impulse by the sub-step's time"},
       {"used", "used %", "", C::number, 0, false, "friction impulse by the most that friction may be"},
       {"coefficient", "mu", "", C::number, 0, false, "coefficient of friction"},
       {"group", "group", "", C::whole, 4, false, "its collision group"},
       {"residual", "resid.", "", C::number, 0, false,
        "how far the last sub-step's answer is from Coulomb's law here: relative, no more than residual_coulomb"},
       {"state", "", "", C::words, 2, true,
        "green: sticks, orange: slips or may (friction is at its limit), white: open"}}};
  return table;
}

Panel contacts_panel() {
  Panel panel{"contacts", "contacts", PanelPlace::right, {}, draw_contacts, count_of_contacts};
  panel.scrolls_inside = true;
  return panel;
}

}  // namespace impinge
