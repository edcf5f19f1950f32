#include "viewer/draw/surface_cache.hpp"

namespace impinge {
namespace {

constexpr double kCreaseDeg = 50.0;  // scans look smooth, machine parts keep their edges

}  // namespace

ShadedSurfacePointer SurfaceCache::surface_of(const Shape& shape) { return kept(shape, false); }

ShadedSurfacePointer SurfaceCache::touched_surface_of(const Shape& shape) {
  return kept(shape, shape.mesh() != nullptr && shape.mesh()->full != nullptr);
}

ShadedSurfacePointer SurfaceCache::kept(const Shape& shape, bool is_touched) {
  // shapes with equal numbers share their triangles; one that has none is itself
  Key key{shape.type(), nullptr, shape.dimensions(), is_touched};
  if (std::get<2>(key).empty()) std::get<1>(key) = &shape;
  const auto [place, is_new] = kept_.try_emplace(key);
  Kept& kept = place->second;
  kept.used = true;
  if (is_new) {
    kept.source = shape.shared_from_this();
    if (const SurfaceMesh* source = shape.mesh()) {
      if (!is_touched) source = &source->shown();
      kept.surface = std::make_shared<ShadedSurface>(make_shaded_surface(source->mesh, source->topology, kCreaseDeg));
    } else {
      const TriangleMesh mesh = shape.drawn();
      kept.surface = std::make_shared<ShadedSurface>(make_shaded_surface(mesh, make_topology(mesh), kCreaseDeg));
    }
  }
  return kept.surface;
}

MovedSurfacePointer SurfaceCache::moved_of(const BodyRecord& body) {
  if (body.deformable == nullptr) return nullptr;
  MovedSurfacePointer& moved = moved_[body.deformable];
  if (!moved)
    moved = std::make_shared<MovedSurface>(
        move_surface(*surface_of(*body.shape), body.vertices, body.deformable->smallest_volume_ratio() <= 0.0));
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
