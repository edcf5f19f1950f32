// The bodies, with an eye that hides and a lock.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "viewer/gl/packed_color.hpp"
#include "viewer/layers/body_style.hpp"
#include "viewer/panels/debug/outliner.hpp"

namespace impinge {
namespace {

/// What contacts sum up to on a body.
struct Touched {
  int contacts = 0;
  double deepest = kNone, impulse = 0.0;
};

std::vector<Touched> touched(const StepRecord& record) {
  std::vector<Touched> all(record.bodies.size());
  for (const ContactRecord& c : record.contacts)
    for (const BodyIndex b : {c.body_a, c.body_b}) {
      Touched& t = all[static_cast<std::size_t>(b.value())];
      ++t.contacts;
      t.impulse += c.lambda.x();
      if (!(t.deepest <= c.gap)) t.deepest = c.gap;
      if (c.body_a == c.body_b) break;
    }
  return all;
}

/// How far from where it is in what is made beside it.
double apart(const DebugModel& model, BodyIndex body) {
  if (model.against == nullptr) return kNone;
  const std::optional<Pose> there = model.against->pose(model.frame, body);
  const BodyRecord& now = model.record->bodies[static_cast<std::size_t>(body.value())];
  return there && now.kind != BodyKind::fixed ? (there->position - now.pose.position).norm() : kNone;
}

/// Each body's place by the alphabet.
std::vector<double> ranks(const StepRecord& record) {
  std::vector<std::size_t> order(record.bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t l, std::size_t r) { return record.bodies[l].name < record.bodies[r].name; });
  std::vector<double> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
  return rank;
}

std::vector<double> body_numbers(const DebugModel& model) {
  const StepRecord& record = *model.record;
  const std::vector<double> rank = ranks(record);
  const std::vector<Touched> all = touched(record);
  const double step = substep_time(record);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& b = record.bodies[i];
    const Touched& t = all[i];
    const bool moves = b.kind != BodyKind::fixed, is_plane = b.bounds.is_empty() || !b.bounds.extent().allFinite();
    if (b.deleted) {
      numbers.push_back(rank[i]);
      numbers.insert(numbers.end(), bodies_table().columns.size() - 1, kNone);
      continue;
    }
    const double row[] = {rank[i],
                          static_cast<double>(b.kind),
                          moves ? b.velocity.norm() : kNone,
                          static_cast<double>(t.contacts),
                          t.deepest,
                          b.mass > 0.0 ? b.mass : kNone,
                          is_plane ? kNone : b.bounds.extent().maxCoeff(),
                          moves && b.deformable == nullptr ? b.angular_velocity.norm() : kNone,
                          step > 0.0 && t.contacts > 0 ? t.impulse / step : kNone,
                          b.group.is_none() ? kNone : static_cast<double>(b.group.value()),
                          apart(model, BodyIndex(i))};
    numbers.insert(numbers.end(), std::begin(row), std::end(row));
  }
  return numbers;
}

void draw_eye(ImVec2 middle, float half, ImU32 color, bool is_open) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 left = {middle.x - half, middle.y}, right = {middle.x + half, middle.y};
  const float lid = 1.3f * half, width = std::max(1.0f, 0.22f * half);
  list.AddBezierQuadratic(left, {middle.x, middle.y + lid}, right, color, width);
  if (!is_open) return;
  list.AddBezierQuadratic(left, {middle.x, middle.y - lid}, right, color, width);
  list.AddCircleFilled(middle, 0.42f * half, color, 12);
}

void draw_lock(ImVec2 middle, float half, ImU32 color, bool is_closed) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (!is_closed) {
    list.AddCircleFilled(middle, 0.18f * half, color, 8);
    return;
  }
  list.AddRectFilled({middle.x - 0.6f * half, middle.y - 0.1f * half}, {middle.x + 0.6f * half, middle.y + 0.8f * half},
                     color, 0.1f * half);
  list.PathArcTo({middle.x, middle.y - 0.1f * half}, 0.4f * half, 3.14159f, 6.28319f, 8);
  list.PathStroke(color, 0, std::max(1.0f, 0.25f * half));
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A square that can be clicked, and what is drawn in it.
template <class Draw>
bool icon(Ui& ui, const std::string& name, const std::string& doc, Draw&& draw) {
  const float size = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {size, size});
  ui.name(name);
  draw(ImVec2(at.x + 0.5f * size, at.y + 0.5f * size), 0.42f * size);
  tooltip(doc);
  return clicked;
}

void draw_icons(Ui& ui, const DebugModel& model, CommandLines& lines, const std::vector<Color>& colors,
                std::size_t row) {
  const std::string name = name_of(model, BodyIndex(row));
  const bool hidden = has(model.view->hidden, name), locked = has(model.view->locked, name);
  const ImU32 faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
  if (icon(ui, "outliner/hide:" + name, hidden ? "show" : "hide (h)",
           [&](ImVec2 middle, float half) { draw_eye(middle, half, hidden ? faint : opaque(colors[row]), !hidden); }))
    lines.push_back(fmt::format("{} {}", hidden ? "show" : "hide", name));
  ImGui::SameLine(0.0f, 2.0f * ui.unit());
  if (icon(ui, "outliner/lock:" + name, locked ? "unlock" : "lock: clicks in the view go through it",
           [&](ImVec2 middle, float half) {
             draw_lock(middle, half, locked ? ImGui::GetColorU32(ImGuiCol_Text) : faint, locked);
           }))
    lines.push_back(fmt::format("{} {}", locked ? "unlock" : "lock", name));
}

}  // namespace

std::string sleep_words(const DebugModel& model, BodyIndex body) {
  if (!model.record->bodies[static_cast<std::size_t>(body.value())].asleep) return "";
  return fmt::format(", asleep since frame {}", model.tracks->asleep_since(model.frame, body));
}

const Table& bodies_table() {
  using C = TableColumn;
  static const Table table = {
      "bodies",
      {{"name", "name", "", C::words, 8, true, "a heading that is clicked sorts; this one by the alphabet"},
       {"kind", "kind", "", C::words, 6, false, "dynamic, deformable, scripted or static"},
       {"speed", "speed", "m/s", C::number, 0, true, "of its centre"},
       {"contacts", "cont.", "", C::whole, 4, true, "contacts that it has part in"},
       {"gap", "gap", "m", C::number, 0, true, "the least of its contacts' gaps; negative: they overlap"},
       {"mass", "mass", "kg", C::number, 0, false, "of dynamic and deformable bodies"},
       {"size", "size", "m", C::number, 0, false, "longest edge of the box around it"},
       {"spin", "spin", "rad/s", C::number, 0, false, "how fast it turns"},
       {"force", "force", "N", C::number, 0, false, "sum of its contacts' normal forces, last sub-step"},
       {"group", "group", "", C::whole, 4, false, "its collision group"},
       {"apart", "apart", "m", C::number, 0, false, "with --against: its centre from where it is in B"}}};
  return table;
}

TableRows body_rows(Ui& ui, const DebugModel& model, CommandLines& lines) {
  TableRows rows;
  rows.numbers = body_numbers(model);
  for (std::size_t i = 0; i < model.record->bodies.size(); ++i)
    if (is_sought(model, model.record->bodies[i].name)) rows.shown.push_back(i);
  rows.words = [&](std::size_t row, std::size_t column) {
    const BodyRecord& b = model.record->bodies[row];
    if (column > 0) return std::string(kind_name(b.kind));
    return fmt::format("{}{}", b.name, b.deleted ? ", deleted" : "");
  };
  rows.name = [&](std::size_t row) { return name_of(model, BodyIndex(row)); };
  rows.select = [&](std::size_t row) { return "select body " + name_of(model, BodyIndex(row)); };
  rows.tip = [&](std::size_t row) {
    const BodyRecord& b = model.record->bodies[row];
    return fmt::format("{}, {}{}", b.name, kind_name(b.kind),
                       b.deleted ? ", deleted" : sleep_words(model, BodyIndex(row)));
  };
  const std::vector<BodyIndex> selected = selected_bodies(model);
  rows.is_selected = [selected](std::size_t row) {
    return std::find(selected.begin(), selected.end(), BodyIndex(row)) != selected.end();
  };
  rows.is_dim = [&](std::size_t row) {
    const BodyRecord& b = model.record->bodies[row];
    return b.asleep || b.deleted || has(model.view->hidden, name_of(model, BodyIndex(row)));
  };
  rows.icons = 2;
  rows.draw_icons = [&ui, &model, &lines, colors = body_colors(*model.record, model.view->colors)](std::size_t row) {
    draw_icons(ui, model, lines, colors, row);
  };
  return rows;
}

}  // namespace impinge
