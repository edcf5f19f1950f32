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

MovedSurfacePointer SurfaceCache::moved_of(const BodyRecord& body) {
  if (body.soft == nullptr) return nullptr;
  MovedSurfacePointer& moved = moved_[body.soft];
  if (!moved)
    moved = std::make_shared<MovedSurface>(
        move_surface(*surface_of(*body.shape), body.vertices, body.soft->smallest_volume_ratio() <= 0.0));
  return moved;
}

const TetEdges& SurfaceCache::edges_of(const FemAssembly& fem) {
  const auto [place, is_new] = edges_.try_emplace(fem.pattern().get());
  KeptEdges& kept = place->second;
  kept.used = true;
  if (is_new) kept.pattern = fem.pattern(), kept.edges = make_tet_edges(fem.rest());
  return kept.edges;
}

void SurfaceCache::forget_unused() {
  const auto forget = [](auto& all) {
    for (auto it = all.begin(); it != all.end();) it = it->second.used ? std::next(it) : all.erase(it);
    for (auto& [key, kept] : all) kept.used = false;
  };
  forget(kept_);
  forget(edges_);
  moved_.clear();
}

}  // namespace impinge
