#include "viewer/present/scene_painter.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/layers/view_bodies.hpp"

namespace impinge {
namespace {

Backdrop backdrop_of(const ViewSettings& settings) {
  if (settings.backdrop == BackdropStyle::light) return {hex(0xf7f8fa), hex(0xdfe3e8)};
  if (settings.backdrop == BackdropStyle::transparent) return {{}, {}, true};
  if (settings.backdrop == BackdropStyle::flat) return {hex(0x3f4650), hex(0x3f4650)};
  return {hex(0x5a6472), hex(0x23272e)};
}

/// Sizes in pixels are meant for pictures 720 high; small pictures keep marks that can be seen. By the shorter side, so
/// that pictures that stand upright are not drowned in them.
float pixel_scale(int width, int height) {
  return std::max(0.5f, static_cast<float>(std::min(width, height)) / 720.0f);
}

/// By the shorter side likewise.
int text_scale(const ViewSettings& settings, int width, int height) {
  const int side = std::min(width, height);
  return settings.panel_scale > 0 ? settings.panel_scale : std::max(1, static_cast<int>(std::lround(side / 800.0)));
}

RenderStyle style_of(const ViewSettings& settings, int width, int height) {
  return {backdrop_of(settings), settings.antialiasing, pixel_scale(width, height), settings.clip, settings.backs};
}

Camera camera_of(const StepRecord& record, const ViewSettings& settings, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  return settings.camera_given ? camera_of_picture(record, settings, aspect)
                               : fitted_camera(record, settings.camera, settings.followed, aspect);
}

/// What is written over the picture hides what is behind it.
void add_panel(IdImage& ids, const PanelArea& area, const char* mark) {
  const int left = std::clamp(static_cast<int>(std::floor(area.x)), 0, ids.width),
            top = std::clamp(static_cast<int>(std::floor(area.y)), 0, ids.height);
  const int right = std::clamp(static_cast<int>(std::ceil(area.x + area.width)), left, ids.width);
  const int bottom = std::clamp(static_cast<int>(std::ceil(area.y + area.height)), top, ids.height);
  if (area.width <= 0.0f || right == left || bottom == top) return;
  IdObject object;
  object.layer = "panels";
  object.mark = mark;
  ids.objects.push_back(object);
  const auto index = static_cast<std::uint32_t>(ids.objects.size());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * ids.width + x;
      ids.object[i] = index;
      ids.part[i] = IdImage::kNoPart;
    }
}

/// Pixels that a box of the world covers; none where it is behind the eye, or so near that no panel could avoid it.
PanelArea area_of(const Aabb& box, const Camera& camera, int width, int height) {
  if (box.is_empty()) return {};
  Vec2 low = Vec2::Constant(1e9), high = -low;
  for (int bits = 0; bits < 8; ++bits) {
    const Vec3 corner = {bits & 1 ? box.max.x() : box.min.x(), bits & 2 ? box.max.y() : box.min.y(),
                         bits & 4 ? box.max.z() : box.min.z()};
    const auto at = camera.project(corner, width, height);
    if (!at) return {};
    low = low.cwiseMin(at->head<2>());
    high = high.cwiseMax(at->head<2>());
  }
  const Vec2 around = Vec2::Constant(0.02 * height);  // a contact is a point, and marked by a ring
  low -= around;
  high += around;
  low = low.cwiseMax(Vec2::Zero());
  high = high.cwiseMin(Vec2(width, height));
  if (low.x() >= high.x() || low.y() >= high.y() || (high - low).prod() > 0.5 * width * height) return {};
  return {static_cast<float>(low.x()), static_cast<float>(low.y()), static_cast<float>(high.x() - low.x()),
          static_cast<float>(high.y() - low.y())};
}

}  // namespace

ScenePainter::ScenePainter(int width, int height) : target_(width, height) {}

const Framebuffer& ScenePainter::paint(const StepRecord& record, const ViewSettings& settings,
                                       const std::function<void(DrawList&)>& more) {
  const Camera camera = camera_of(record, settings, width(), height());
  list_.clear();
  for (const Layer& layer : layers()) {
    if (!settings.is_on(layer.name)) continue;
    layer.draw({record, settings, camera, surfaces_, layer.name}, list_);
    list_.end_layer(layer.name);
  }
  if (const BodySet hidden = not_drawn(record, settings); !hidden.is_empty())
    list_.leave_out([&](PickId pick) { return hidden.has(pick); });
  if (more) more(list_), list_.end_layer("selection");
  surfaces_.forget_unused();

  renderer_.draw(list_, camera, style_of(settings, width(), height()), target_);

  const int scale = text_scale(settings, width(), height());
  if (!overlay_ || overlay_->scale() != scale) overlay_ = std::make_unique<Overlay>(scale);
  overlay_->draw(width(), height(), [&](const Pen& pen) {
    figures_ = draw_figures(pen, record, settings);
    const PanelArea picked = area_of(settings.picked, camera, width(), height());
    legend_ = draw_legend(pen, record, list_, settings, pixel_scale(width(), height()), figures_, picked);
    std::vector<PanelArea> taken = {figures_, legend_};
    caption_ = draw_caption(pen, settings, taken);
    taken.push_back(caption_);
    bars_.clear();
    for (const ColorBar& bar : list_.color_bars) {
      bars_.push_back(draw_color_bar(pen, bar, settings, taken));
      taken.push_back(bars_.back());
    }
    draw_labels(pen, list_.labels, camera, taken);
  });
  return target_;
}

void ScenePainter::read_ids(const StepRecord& record, const ViewSettings& settings, IdImage& ids, bool pickable) {
  if (!ids_) ids_ = std::make_unique<IdBuffer>(width(), height());
  DrawList coded = list_;
  if (const BodySet locked(record, settings.locked); pickable && !locked.is_empty())
    coded.leave_out([&](PickId pick) { return locked.has(pick); });
  ids.objects = code_colors(coded, record);
  renderer_.draw_ids(coded, camera_of(record, settings, width(), height()), style_of(settings, width(), height()),
                     *ids_);
  ids_->read(ids);
  add_panel(ids, figures_, "figures");
  add_panel(ids, legend_, "legend");
  add_panel(ids, caption_, "caption");
  for (const PanelArea& bar : bars_) add_panel(ids, bar, "bar");
}

std::optional<ScenePainter::Seen> ScenePainter::look_at(const StepRecord& record, const ViewSettings& settings,
                                                        double x, double y) {
  IdImage ids;
  read_ids(record, settings, ids, true);
  const int px = static_cast<int>(x), py = static_cast<int>(y);
  if (px < 0 || py < 0 || px >= ids.width || py >= ids.height) return std::nullopt;
  const IdObject* object = ids.object_at(px, py);
  if (object == nullptr) return std::nullopt;
  if (object->contact_index >= 0) {
    const ContactRecord& c = record.contacts[static_cast<std::size_t>(object->contact_index)];
    const BodyRecord& a = record.bodies[static_cast<std::size_t>(c.body_a.value())];
    if (is_moved_by_contact(a)) return Seen{c.body_a, c.point_a};
    return Seen{c.body_b, c.point_b};
  }
  if (object->body_index < 0) return std::nullopt;
  const Camera camera = camera_of(record, settings, width(), height());
  const auto body = static_cast<std::size_t>(object->body_index);
  Vec3 point = record.bodies[body].pose.position, across = camera.view_rotation().row(2).transpose();
  const auto i = static_cast<std::size_t>(py) * static_cast<std::size_t>(ids.width) + static_cast<std::size_t>(px);
  const auto drawn = std::find_if(list_.surfaces.begin(), list_.surfaces.end(),
                                  [&](const DrawSurface& s) { return s.pick == body_pick(body); });
  if (ids.part[i] != IdImage::kNoPart && drawn != list_.surfaces.end() &&
      ids.part[i] < drawn->surface->triangles.size()) {
    const auto& positions = drawn->moved ? drawn->moved->positions : drawn->surface->positions;
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = drawn->placement().apply(positions[drawn->surface->triangles[ids.part[i]][k]].cast<double>());
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const Vec3 sight = corners[0] - camera.eye;
    point = (corners[0] + corners[1] + corners[2]) / 3.0;
    if (std::abs(normal.dot(sight)) > 1e-3 * normal.norm() * sight.norm()) point = corners[0], across = normal;
  }
  const Vec3 far = camera.unproject(x, y, 1.0, width(), height()) - camera.eye;
  const double reach = across.dot(far) == 0.0 ? 0.0 : across.dot(point - camera.eye) / across.dot(far);
  if (!(reach > 0.0) || !std::isfinite(reach)) return std::nullopt;
  return Seen{BodyIndex(object->body_index), camera.eye + reach * far};
}

}  // namespace impinge
