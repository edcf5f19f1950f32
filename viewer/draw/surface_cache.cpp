#include "viewer/draw/surface_cache.hpp"

#include "viewer/draw/tessellation.hpp"

namespace impinge {
namespace {

constexpr double kCreaseDeg = 50.0;  // scans look smooth, machine parts keep their edges

}  // namespace

ShadedSurfacePointer SurfaceCache::surface_of(const Shape& shape) {
  Key key{static_cast<int>(shape.index()), nullptr, 0.0, 0.0, 0.0};
  MeshPointer source;
  if (const auto* s = std::get_if<Sphere>(&shape)) std::get<2>(key) = s->radius;
  if (const auto* s = std::get_if<Capsule>(&shape)) std::get<2>(key) = s->radius, std::get<3>(key) = s->half_length;
  if (const auto* s = std::get_if<Box>(&shape))
    std::tie(std::get<2>(key), std::get<3>(key), std::get<4>(key)) = std::tie(s->half.x(), s->half.y(), s->half.z());
  if (const auto* s = std::get_if<MeshPointer>(&shape)) source = *s, std::get<1>(key) = s->get();
  const auto [place, is_new] = kept_.try_emplace(key);
  Kept& kept = place->second;
  kept.used = true;
  if (is_new) {
    kept.source = source;
    if (source) {
      kept.surface = std::make_shared<ShadedSurface>(make_shaded_surface(source->mesh, source->topology, kCreaseDeg));
    } else {
      const TriangleMesh mesh = tessellate(shape);
      kept.surface = std::make_shared<ShadedSurface>(make_shaded_surface(mesh, make_topology(mesh), kCreaseDeg));
    }
  }
  return kept.surface;
}

void SurfaceCache::forget_unused() {
  for (auto it = kept_.begin(); it != kept_.end();) {
    it = it->second.used ? std::next(it) : kept_.erase(it);
  }
  for (auto& [key, kept] : kept_) kept.used = false;
}

}  // namespace impinge
