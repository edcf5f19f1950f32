#include "viewer/present/debug_window.hpp"

#include <fmt/format.h>

#include <cmath>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/panels/debug/keys.hpp"
#include "viewer/panels/debug/outliner.hpp"
#include "viewer/present/debug_marks.hpp"

namespace impinge {
namespace {

constexpr Color kBetweenPanels = hex(0x0f1216);
constexpr float kDegreesPerPixel = 0.4f;
constexpr double kZoomPerStep = 1.15;
constexpr double kMostLegend = 0.1;  // of the view
constexpr float kClick = 3.0f;       // pixels that the pointer may move in a click

/// As exact as a hand is, so that lines can be read.
std::string words_of(const Vec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x(), v.y(), v.z()); }

}  // namespace

DebugWindow::DebugWindow(int width, int height, int scale)
    : context_(make_offscreen_context()),
      window_(width, height),
      ui_(scale > 0 ? scale : debug_scale(height)),
      layout_(debug_layout(width, height, ui_.unit())),
      scene_(static_cast<int>(layout_.view.width), static_cast<int>(layout_.view.height)) {}

DebugWindow::~DebugWindow() { context_->make_current(); }

std::string DebugWindow::scene_key(const DebugModel& model) const {
  std::string asked;
  for (const Act& act : model.asked)
    if (act.verb == Act::pull) asked += fmt::format("{} {} {} ", act.body, words_of(*act.point), words_of(act.vector));
  for (const DebugModel::Coming& coming : model.coming)
    asked +=
        fmt::format("{} {} {} ", coming.like, words_of(coming.body.pose.position), coming.body.pose.rotation(0, 0));
  std::string key =
      asked + fmt::format("{} {:016x} {} {} {} {} {} {}", model.frame, model.record->stats.state_hash,
                          static_cast<int>(model.selection.kind), model.selection.index, model.selection.triangle,
                          static_cast<const void*>(model.record), model.state.trails, model.state.ghost);
  for (const Parameter& row : model.rows->all())
    if (row.path.starts_with("view.")) key += ' ' + format_value(row.get());
  return key;
}

CommandLines DebugWindow::paint(const DebugModel& model, bool quick) {
  context_->make_current();
  ViewSettings settings = *model.view;
  rough_ = quick && held_ >= 0 && dragged_ && settings.antialiasing;
  if (rough_) settings.antialiasing = false;
  settings.most_legend = kMostLegend;
  for (const BodyIndex body : selected_bodies(model)) settings.selected.push_back(name_of(model, body));
  settings.picked = bounds_of_selection(model);
  if (settings.panel_scale == 0) settings.panel_scale = static_cast<int>(ui_.unit());  // as the panels around it
  std::string key = scene_key(model) + (rough_ ? " rough" : "");
  const bool is_new = key != painted_;
  if (is_new) {
    scene_.paint(*model.record, settings, [&](DrawList& list) {
      draw_ghost(model, list);
      draw_coming(model, list);
      draw_trails(model, list);
      mark_pulls(model, list);
      mark_selection(model, list);
    });
    painted_ = std::move(key);
  }
  CommandLines lines;
  ui_.begin(width(), height());
  keys_to_lines(ui_, model, lines);
  for (std::size_t i = 0; i < panels().size(); ++i)
    if (is_in_front(panels()[i], model.state)) draw_panel(panels()[i], layout_.panels[i], ui_, model, lines);
  draw_help(model, layout_.view);
  use_mouse(model, lines);
  const std::optional<std::vector<PanelDrawing>> changed = changes_.next(ui_.end(), layout_.panels);
  has_changed_ = is_new || !changed || !changed->empty();
  if (!changed) window_.clear(kBetweenPanels);
  if (!changed || is_new)
    scene_.target().copy_to(window_, static_cast<int>(layout_.view.x), static_cast<int>(layout_.view.y));
  window_.bind();
  if (!changed)
    ui_.draw();
  else
    for (const PanelDrawing& panel : *changed) {
      window_.clear(kBetweenPanels, static_cast<int>(panel.area.x), static_cast<int>(panel.area.y),
                    static_cast<int>(panel.area.width), static_cast<int>(panel.area.height));
      ui_.draw(panel.lists);
    }
  return lines;
}

void DebugWindow::read(Image& out) {
  context_->make_current();
  window_.read(out);
}

void DebugWindow::use_mouse(const DebugModel& model, CommandLines& lines) {
  const float x = ui_.mouse_x(), y = ui_.mouse_y();
  const bool over = layout_.view.holds(x, y) && !ui_.takes_mouse();
  for (int button = 0; button < 3; ++button)
    if (over && ui_.went_down(button) && held_ < 0) {
      held_ = button, pressed_x_ = last_x_ = x, pressed_y_ = last_y_ = y, dragged_ = false;
      if (button == 0 && ImGui::GetIO().KeyCtrl) take_hold(model);
    }
  if (over && ui_.wheel() != 0.0f)
    lines.push_back(fmt::format("camera zoom {}", shortest(std::pow(kZoomPerStep, ui_.wheel()))));
  if (held_ < 0) return;
  const float dx = x - last_x_, dy = y - last_y_;
  dragged_ |= std::hypot(x - pressed_x_, y - pressed_y_) > kClick * ui_.unit();
  if (dragged_ && (dx != 0.0f || dy != 0.0f)) {
    if (hold_) {
      drag(model, lines);
    } else if (held_ == 0) {
      const double turn = kDegreesPerPixel / ui_.unit();
      lines.push_back(fmt::format("camera orbit {} {}", shortest(-turn * dx), shortest(turn * dy)));
    } else {
      const double pixel = model.view->camera.pixel_size_at(model.view->camera.target, scene_.height());
      lines.push_back(fmt::format("camera pan {} {}", shortest(-pixel * dx), shortest(pixel * dy)));
    }
    last_x_ = x;
    last_y_ = y;
  }
  if (!ui_.went_up(held_)) return;
  if (hold_ && hold_->has_pulled && hold_->is_moved) lines.push_back("release " + hold_->body);
  if (held_ == 0 && !dragged_) {
    const PanelArea& legend = scene_.legend();
    const UiArea at{layout_.view.x + legend.x, layout_.view.y + legend.y, legend.width, legend.height};
    lines.push_back(at.holds(x, y) ? fmt::format("set view.panel.legend_form {}", legend.is_folded ? "whole" : "folded")
                                   : pick(model, x, y));
  }
  held_ = -1;
  hold_.reset();
}

Camera DebugWindow::camera(const DebugModel& model) const {
  return camera_of_picture(*model.record, *model.view, static_cast<double>(scene_.width()) / scene_.height());
}

void DebugWindow::take_hold(const DebugModel& model) {
  const double x = pressed_x_ - layout_.view.x + 0.5, y = pressed_y_ - layout_.view.y + 0.5;
  const auto seen = scene_.look_at(*model.record, *model.view, x, y);
  if (!seen) return;
  const BodyRecord& body = model.record->bodies[static_cast<std::size_t>(seen->body.value())];
  const auto at = camera(model).project(seen->point, scene_.width(), scene_.height());
  if (!at) return;
  hold_ = Hold{std::string(body.name),
               body.deformable != nullptr ? body.deformable->own_coordinates(seen->point)
                                          : body.file_pose.apply_inverse(seen->point),
               at->z(), is_moved_by_contact(body), false};
}

/// The point that the mouse has hold of comes after it in a plane parallel to the screen.
void DebugWindow::drag(const DebugModel& model, CommandLines& lines) {
  if (hold_->has_pulled && !hold_->is_moved) return;  // that it can't be was said once
  const double x = ui_.mouse_x() - layout_.view.x + 0.5, y = ui_.mouse_y() - layout_.view.y + 0.5;
  const Vec3 to = camera(model).unproject(x, y, hold_->depth, scene_.width(), scene_.height());
  lines.push_back(fmt::format("pull {} {} to {}", hold_->body, words_of(hold_->own), words_of(to)));
  hold_->has_pulled = true;
}

std::string DebugWindow::pick(const DebugModel& model, float x, float y) {
  IdImage ids;
  scene_.read_ids(*model.record, *model.view, ids, true);
  const int px = static_cast<int>(x - layout_.view.x), py = static_cast<int>(y - layout_.view.y);
  if (px < 0 || py < 0 || px >= ids.width || py >= ids.height) return "select none";
  // a contact's point is small: within two pixels it is what was meant
  const IdObject* object = ids.object_at(px, py);
  for (int ring = 1; ring <= 2 && (object == nullptr || object->contact_index < 0); ++ring)
    for (int i = -ring; i <= ring; ++i)
      for (int j = -ring; j <= ring; ++j) {
        if (px + i < 0 || py + j < 0 || px + i >= ids.width || py + j >= ids.height) continue;
        const IdObject* near = ids.object_at(px + i, py + j);
        if (near != nullptr && near->contact_index >= 0) object = near;
      }
  if (object == nullptr || (object->contact_index < 0 && object->body_index < 0)) return "select none";
  if (object->contact_index >= 0) return fmt::format("select contact {}", object->contact_index);
  const auto i = static_cast<std::size_t>(py) * static_cast<std::size_t>(ids.width) + static_cast<std::size_t>(px);
  std::string line = fmt::format("select body {}", object->body);
  if (!ids.part.empty() && ids.part[i] != IdImage::kNoPart) line += fmt::format(" {}", ids.part[i]);
  return line;
}

}  // namespace impinge
