// The numbers of what is selected.
#include <fmt/format.h>

#include <cmath>

#include "viewer/panels/debug/widgets.hpp"

namespace impinge {
namespace {

void row(const char* label, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::TextColored(dim(), "%s", label);
  ImGui::TableNextColumn();
  ImGui::TextWrapped("%s", value.c_str());
}

std::string vector(const Vec3& v) {
  return fmt::format("{}  {}  {}", brief(v.x(), 3), brief(v.y(), 3), brief(v.z(), 3));
}

void body_rows(const DebugModel& model, const Selection& s) {
  const BodyRecord& b = model.record->bodies[static_cast<std::size_t>(s.index)];
  row("body", std::string(b.name));
  row("kind", fmt::format("{}{}", kind_name(b.kind), b.asleep ? ", asleep" : ""));
  if (b.mass > 0.0) row("mass", fmt::format("{:.5g} kg", b.mass));
  row("place, m", vector(b.pose.position));
  row("v, m/s", vector(b.velocity));
  if (b.deformable == nullptr)
    row("w, rad/s", vector(b.angular_velocity));
  else
    row("unknowns", fmt::format("{} in {} tetrahedra", b.deformable->dofs(), b.deformable->fem.rest().tets.size()));
  int contacts = 0;
  double force = 0.0;
  for (const ContactRecord& c : model.record->contacts)
    if (c.body_a == s.index || c.body_b == s.index) ++contacts, force += c.lambda.x();
  row("contacts", fmt::format("{}, in all {} N s normal", contacts, brief(force, 3)));
  if (b.group >= 0)
    row("group",
        fmt::format("{}, of {} bodies", b.group, model.record->groups[static_cast<std::size_t>(b.group)].size()));
  if (s.triangle >= 0) row("triangle", std::to_string(s.triangle));
}

void contact_rows(const DebugModel& model, const Selection& s) {
  const ContactRecord& c = model.record->contacts[static_cast<std::size_t>(s.index)];
  const auto side = [&](int body, int triangle) {
    return triangle < 0
               ? std::string(model.record->bodies[static_cast<std::size_t>(body)].name)
               : fmt::format("{}, triangle {}", model.record->bodies[static_cast<std::size_t>(body)].name, triangle);
  };
  row("contact", fmt::format("{} ({})", s.index, state_name(c.state)));
  row("A", side(c.body_a, c.triangle_a));
  row("B", side(c.body_b, c.triangle_b));
  row("point A, m", vector(c.point_a));
  row("normal", vector(c.normal));
  row("gap", fmt::format("{} mm, solved with {}", brief(1e3 * c.gap, 3), brief(1e3 * c.gap0, 3)));
  row("impulse, N s",
      fmt::format("{} normal, {} friction", brief(c.lambda.x(), 3), brief(std::hypot(c.lambda.y(), c.lambda.z()), 3)));
  row("friction", c.friction > 0.0 ? fmt::format("{:.3g}, {:.0f} % of it used", c.friction,
                                                 c.lambda.x() > 0.0 ? 100.0 * std::hypot(c.lambda.y(), c.lambda.z()) /
                                                                          (c.friction * c.lambda.x())
                                                                    : 0.0)
                                   : "none");
  row("group", std::to_string(c.group));
}

void draw(Ui& ui, const DebugModel& model, CommandLines&) {
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

Panel inspector_panel() { return {"inspector", "selected", PanelPlace::right, {0.39f, 214.0f}, draw}; }

}  // namespace impinge
