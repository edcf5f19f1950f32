#include "viewer/gl/renderer.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/draw/color_map.hpp"
#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

Aabb bounds_of(const DrawList& list) {
  Aabb box;
  for (const DrawPoint& p : list.points) box.include(p.position);
  for (const DrawLine& l : list.lines) box.include(l.a), box.include(l.b);
  for (const DrawTriangle& t : list.triangles)
    for (const Vec3& p : t.corners) box.include(p);
  for (const DrawSurface& s : list.surfaces) {
    const Eigen::AlignedBox3f& local = s.bounds();
    const Pose pose = s.placement();
    for (int corner = 0; corner < 8 && !local.isEmpty(); ++corner)
      box.include(pose.apply(local.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)).cast<double>()));
  }
  return box;
}

/// Which part of a surface the clip plane leaves.
enum class Left { all, some, none };
Left left_of(const DrawSurface& item, const ClipPlane& clip) {
  if (!clip.is_on() || !item.clipped || item.bounds().isEmpty()) return Left::all;
  const Pose pose = item.placement();
  const Vec3 normal = pose.rotation.transpose() * clip.normal.normalized();
  const double middle = clip.height(pose.apply(item.bounds().center().cast<double>()));
  const double reach = normal.cwiseAbs().dot(0.5 * item.bounds().sizes().cast<double>());
  return middle - reach > 0.0 ? Left::none : middle + reach > 0.0 ? Left::some : Left::all;
}

/// Whether the back of no triangle can be seen: the surface is solid and whole, and neither the eye nor the near plane
/// reaches into its box. Half of the triangles are then left out, which saves up to 45 % of the drawing.
bool hides_its_backs(const DrawSurface& item, const ViewTransform& view) {
  if (!item.is_solid()) return false;
  const double across = std::hypot(0.5 * view.width, 0.5 * view.height) / view.focal;
  const double reach = view.near * std::sqrt(1.0 + across * across);  // of the near plane's corners
  const Eigen::Vector3f eye = item.placement().apply_inverse(view.eye).cast<float>();
  return item.bounds().exteriorDistance(eye) > 1.001 * reach;
}

std::vector<Eigen::Vector3f> heat_table(ColorMap map) {
  std::vector<Eigen::Vector3f> table;
  for (const Color& c : heat_colors(map)) table.emplace_back(c.r, c.g, c.b);
  return table;
}

}  // namespace

Renderer::SurfaceBuffers& Renderer::buffers_of(const DrawSurface& item) {
  const ShadedSurface& surface = *item.surface;
  const auto [place, is_new] = buffers_.try_emplace(item.surface.get());
  SurfaceBuffers& buffers = place->second;
  if (!is_new && buffers.moved == item.moved && buffers.heat == item.heat) return buffers;
  struct Vertex {
    Eigen::Vector3f position, normal;
    float heat;
  };
  const std::vector<Eigen::Vector3f>& positions = item.moved ? item.moved->positions : surface.positions;
  const std::vector<Eigen::Vector3f>& normals = item.moved ? item.moved->normals : surface.normals;
  std::vector<Vertex> data(positions.size());
  for (std::size_t i = 0; i < data.size(); ++i)
    data[i] = {positions[i], normals[i], item.heat ? (*item.heat)[i] : 0.0f};
  buffers.array.set_vertices(data.data(), data.size() * sizeof(Vertex));
  buffers.moved = item.moved;
  buffers.heat = item.heat;
  if (!is_new) return buffers;
  buffers.surface = item.surface;
  buffers.array.floats(0, 3, sizeof(Vertex), offsetof(Vertex, position));
  buffers.array.floats(1, 3, sizeof(Vertex), offsetof(Vertex, normal));
  buffers.array.floats(2, 1, sizeof(Vertex), offsetof(Vertex, heat));
  buffers.array.set_indices(surface.triangles.data(), surface.triangles.size() * 3 * sizeof(std::uint32_t));
  buffers.indices = static_cast<int>(3 * surface.triangles.size());
  return buffers;
}

void Renderer::draw_surface(Program& program, const DrawSurface& item, const ViewTransform& view,
                            const ClipPlane& clip) {
  SurfaceBuffers& buffers = buffers_of(item);
  program.use();
  program.set("model_view", view.model_view(item.placement()));
  program.set("color", Eigen::Vector4f(item.color.r, item.color.g, item.color.b, item.color.a));
  program.set("outline_only", item.see_through ? item.faintness : 0.0f);
  program.set("heated", item.heat ? 1.0f : 0.0f);
  float bands = 0.0f;
  if (item.striped) bands = 9.0f / std::max(item.bounds().sizes().sum(), 1e-12f);
  const Color stripe = role::kScriptedStripe;
  program.set("stripes", Eigen::Vector4f(stripe.r, stripe.g, stripe.b, bands));
  program.set("cut", left_of(item, clip) == Left::some ? 1.0f : 0.0f);
  buffers.array.bind();
  glDrawElements(GL_TRIANGLES, buffers.indices, GL_UNSIGNED_INT, nullptr);
}

void Renderer::draw_see_through(Program& program, const DrawList& list, const ViewTransform& view,
                                const ClipPlane& clip) {
  std::vector<const DrawSurface*> order;
  for (const DrawSurface& item : list.surfaces)
    if (item.see_through && left_of(item, clip) != Left::none) order.push_back(&item);
  const auto distance = [&](const DrawSurface* item) { return (item->placement().position - view.eye).squaredNorm(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const DrawSurface* l, const DrawSurface* r) { return distance(l) > distance(r); });
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  for (const DrawSurface* item : order) draw_surface(program, *item, view, clip);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::prepare(Program& program, const DrawList& list, const ViewTransform& view, const RenderStyle& style) {
  // a surface that is gone may leave its address to another
  std::erase_if(buffers_, [](const auto& entry) { return entry.second.surface.expired(); });
  program.use();
  program.set("projection", view.projection);
  program.set("eye_up", view.eye_up);
  if (!list.color_bars.empty()) program.set("heat_colors[0]", heat_table(list.color_bars.front().map));
  if (!style.clip.is_on() || list.surfaces.empty()) return;
  const Eigen::Vector3f normal = (view.rotation * style.clip.normal.normalized()).cast<float>();
  const auto eye_height = static_cast<float>(style.clip.height(view.eye));
  program.set("clip", Eigen::Vector4f(normal.x(), normal.y(), normal.z(), eye_height));
  const Color edge = role::kInk;
  program.set("cut_edge", Eigen::Vector4f(edge.r, edge.g, edge.b, 0.8f + style.pixel_scale));
}

void Renderer::draw_solid(Program& program, const DrawList& list, const ViewTransform& view, const RenderStyle& style) {
  for (const DrawSurface& item : list.surfaces) {
    const Left left = left_of(item, style.clip);
    if (item.see_through || left == Left::none) continue;
    if (style.backs != Backs::shown || (left == Left::all && hides_its_backs(item, view))) glEnable(GL_CULL_FACE);
    glCullFace(style.backs == Backs::only ? GL_FRONT : GL_BACK);
    draw_surface(program, item, view, style.clip);
    glCullFace(GL_BACK);
    glDisable(GL_CULL_FACE);
  }
}

void Renderer::draw(const DrawList& list, const Camera& camera, const RenderStyle& style, Framebuffer& target) {
  const ViewTransform view = make_view_transform(camera, bounds_of(list), list.planes, target.width(), target.height());
  scenery_.draw(style.backdrop, list.planes, camera, view, style.pixel_scale, target);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  prepare(surface_program_, list, view, style);
  draw_solid(surface_program_, list, view, style);
  draw_see_through(surface_program_, list, view, style.clip);
  if (style.smooth_edges) target.smooth_edges();
  marks_.draw(list, view, style.pixel_scale);
}

void Renderer::draw_ids(const DrawList& coded, const Camera& camera, const RenderStyle& style, IdBuffer& target) {
  if (id_pass_ == nullptr) id_pass_ = std::make_unique<IdPass>();
  const ViewTransform view =
      make_view_transform(camera, bounds_of(coded), coded.planes, target.width(), target.height());
  target.bind_cleared();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  // see-through walls first: they count only where nothing else is
  prepare(id_pass_->surfaces, coded, view, style);
  draw_see_through(id_pass_->surfaces, coded, view, style.clip);
  for (const DrawPlane& plane : coded.planes) id_pass_->grid.draw(plane, camera, view, style.pixel_scale);
  id_pass_->surfaces.use();
  draw_solid(id_pass_->surfaces, coded, view, style);
  id_pass_->marks.draw(coded, view, style.pixel_scale);
}

}  // namespace impinge
