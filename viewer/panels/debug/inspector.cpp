// The numbers of what is selected.
#include <fmt/format.h>

#include <cmath>

#include "viewer/draw/number_text.hpp"
#include "viewer/layers/contact_measures.hpp"
#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

void label(const char* text) {
  ImGui::TableNextColumn();
  ImGui::TextColored(dim(), "%s", text);
  ImGui::TableNextColumn();
}

void row(const char* name, const std::string& value) {
  label(name);
  ImGui::TextWrapped("%s", value.c_str());
}

/// Digits of all such rows end at one place.
void row(const char* name, double value, std::string_view unit, const std::string& more = "") {
  label(name);
  const NumberText text = number_text(value, unit);
  const float room = ImGui::CalcTextSize("-888.8").x - ImGui::CalcTextSize(text.digits.c_str()).x;
  if (room > 0.0f) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
  ImGui::TextUnformatted((text.whole() + more).c_str());
}

void body_rows(const DebugModel& model, const Selection& s) {
  const BodyRecord& b = model.record->bodies[static_cast<std::size_t>(s.index)];
  row("body", std::string(b.name));
  row("kind", fmt::format("{}{}", kind_name(b.kind), b.deleted ? ", deleted" : sleep_words(model, BodyIndex(s.index))));
  if (b.deleted) return;
  if (b.mass > 0.0) row("mass", b.mass, "kg");
  row("place", vector_text(b.pose.position, "m"));
  row("v", vector_text(b.velocity, "m/s"));
  if (b.deformable == nullptr)
    row("w", vector_text(b.angular_velocity, "rad/s"));
  else
    row("unknowns", fmt::format("{} in {} tetrahedra", b.deformable->dofs(), b.deformable->fem.rest().tets.size()));
  if (b.pull) row("pulled", (b.pull->target - b.pull->point).norm(), "m", " to go");
  int contacts = 0;
  double impulse = 0.0;
  for (const ContactRecord& c : model.record->contacts)
    if (c.body_a == s.index || c.body_b == s.index) ++contacts, impulse += c.lambda.x();
  row("contacts", contacts, "");
  if (contacts > 0) row("normal", impulse, "N s", ", of all");
  if (b.group >= 0)
    if (const std::size_t n = model.record->groups[static_cast<std::size_t>(b.group)].size(); n > 0)
      row("group", fmt::format("{}, of {} bod{}", b.group, n, n == 1 ? "y" : "ies"));
  if (s.triangle >= 0) row("triangle", std::to_string(s.triangle));
}

void contact_rows(const DebugModel& model, const Selection& s) {
  const ContactRecord& c = model.record->contacts[static_cast<std::size_t>(s.index)];
  const auto side = [&](int body, int triangle) {
    return triangle < 0
               ? std::string(model.record->bodies[static_cast<std::size_t>(body)].name)
               : fmt::format("{}, triangle {}", model.record->bodies[static_cast<std::size_t>(body)].name, triangle);
  };
  row("contact", fmt::format("{} ({}), group {}", s.index, state_name(c.state), c.group));
  row("A", side(c.body_a, c.triangle_a));
  row("B", side(c.body_b, c.triangle_b));
  row("point A", vector_text(c.point_a, "m"));
  row("direction", vector_text(c.normal, ""));
  row("gap", c.gap, "m");
  row("solved gap", c.gap0, "m");
  row("normal", c.lambda.x(), "N s");
  const double friction = std::hypot(c.lambda.y(), c.lambda.z()), most = c.friction * c.lambda.x();
  row("friction", friction, "N s",
      c.friction > 0.0 ? fmt::format(", {:.0f} % of {:.3g}", most > 0.0 ? 100.0 * friction / most : 0.0, c.friction)
                       : ", none");
  row("slip", slip_speed(*model.record, c), "m/s");
}

void draw_inspector(Ui& ui, const DebugModel& model, CommandLines&) {
  const Selection& s = model.selection;
  if (s.kind == Selection::none) {
    ImGui::TextColored(dim(), "nothing: click a body or a contact");
    return;
  }
  if (!s.is_there()) {
    ImGui::TextColored(dim(), "the contact is not in this frame");
    return;
  }
  if (!ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 84.0f * ui.unit());
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
  if (s.kind == Selection::body)
    body_rows(model, s);
  else
    contact_rows(model, s);
  ImGui::EndTable();
}

}  // namespace

Panel inspector_panel() { return {"inspector", "selected", PanelPlace::right, {0.39f, 214.0f}, draw_inspector}; }

}  // namespace impinge
