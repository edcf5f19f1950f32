#include "viewer/gl/renderer.hpp"

#include <algorithm>
#include <cmath>

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
    const Eigen::AlignedBox3f& local = s.surface->bounds;
    for (int corner = 0; corner < 8 && !local.isEmpty(); ++corner)
      box.include(s.pose.apply(local.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)).cast<double>()));
  }
  return box;
}

/// Whether the back of no triangle can be seen: the surface is solid, and neither the eye nor the near plane reaches into
/// its box. Half of the triangles are then left out, which saves up to 45 % of the drawing.
bool hides_its_backs(const DrawSurface& item, const ViewTransform& view) {
  if (!item.surface->solid) return false;
  const double across = std::hypot(0.5 * view.width, 0.5 * view.height) / view.focal;
  const double reach = view.near * std::sqrt(1.0 + across * across);  // of the near plane's corners
  const Eigen::Vector3f eye = item.pose.apply_inverse(view.eye).cast<float>();
  return item.surface->bounds.exteriorDistance(eye) > 1.001 * reach;
}

}  // namespace

Renderer::SurfaceBuffers& Renderer::buffers_of(const ShadedSurfacePointer& surface) {
  // a surface that is gone may have left its address to another
  for (auto it = buffers_.begin(); it != buffers_.end();)
    it = it->second.surface.expired() ? buffers_.erase(it) : std::next(it);
  const auto [place, is_new] = buffers_.try_emplace(surface.get());
  SurfaceBuffers& buffers = place->second;
  if (!is_new) return buffers;
  buffers.surface = surface;
  std::vector<Eigen::Vector3f> data;
  data.reserve(2 * surface->positions.size());
  for (std::size_t i = 0; i < surface->positions.size(); ++i)
    data.insert(data.end(), {surface->positions[i], surface->normals[i]});
  buffers.array.set_vertices(data.data(), data.size() * sizeof(Eigen::Vector3f));
  buffers.array.floats(0, 3, 6 * sizeof(float), 0);
  buffers.array.floats(1, 3, 6 * sizeof(float), 3 * sizeof(float));
  buffers.array.set_indices(surface->triangles.data(), surface->triangles.size() * 3 * sizeof(std::uint32_t));
  buffers.indices = static_cast<int>(3 * surface->triangles.size());
  return buffers;
}

void Renderer::draw_backdrop(const Backdrop& backdrop) {
  glDisable(GL_DEPTH_TEST);
  nothing_.bind();
  backdrop_program_.use();
  backdrop_program_.set("top", Eigen::Vector3f(backdrop.top.r, backdrop.top.g, backdrop.top.b));
  backdrop_program_.set("bottom", Eigen::Vector3f(backdrop.bottom.r, backdrop.bottom.g, backdrop.bottom.b));
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::draw_surface(const DrawSurface& item, const ViewTransform& view) {
  SurfaceBuffers& buffers = buffers_of(item.surface);
  surface_program_.use();
  surface_program_.set("model_view", view.model_view(item.pose));
  surface_program_.set("color", Eigen::Vector4f(item.color.r, item.color.g, item.color.b, item.color.a));
  surface_program_.set("outline_only", item.see_through ? 1.0f : 0.0f);
  float bands = 0.0f;
  if (item.striped) bands = 9.0f / std::max(item.surface->bounds.sizes().sum(), 1e-12f);
  const Color stripe = role::kScriptedStripe;
  surface_program_.set("stripes", Eigen::Vector4f(stripe.r, stripe.g, stripe.b, bands));
  buffers.array.bind();
  glDrawElements(GL_TRIANGLES, buffers.indices, GL_UNSIGNED_INT, nullptr);
}

void Renderer::draw_see_through(const DrawList& list, const ViewTransform& view) {
  std::vector<const DrawSurface*> order;
  for (const DrawSurface& item : list.surfaces)
    if (item.see_through) order.push_back(&item);
  std::stable_sort(order.begin(), order.end(), [&](const DrawSurface* l, const DrawSurface* r) {
    return (l->pose.position - view.eye).squaredNorm() > (r->pose.position - view.eye).squaredNorm();
  });
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  for (const DrawSurface* item : order) draw_surface(*item, view);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Renderer::draw(const DrawList& list, const Camera& camera, const RenderStyle& style, Framebuffer& target) {
  const ViewTransform view = make_view_transform(camera, bounds_of(list), target.width(), target.height());
  target.bind();
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
  draw_backdrop(style.backdrop);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  for (const DrawPlane& plane : list.planes) grid_.draw(plane, camera, view, style.pixel_scale);
  surface_program_.use();
  surface_program_.set("projection", view.projection);
  surface_program_.set("eye_up", view.eye_up);
  for (const DrawSurface& item : list.surfaces) {
    if (item.see_through) continue;
    if (hides_its_backs(item, view)) glEnable(GL_CULL_FACE);
    draw_surface(item, view);
    glDisable(GL_CULL_FACE);
  }
  draw_see_through(list, view);
  if (style.smooth_edges) target.smooth_edges();
  marks_.draw(list, view, style.pixel_scale);
}

}  // namespace impinge
