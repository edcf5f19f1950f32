// The surface of a mesh body that is asked what is inside it: a rigid one in its own frame, one that deforms where it stands.
#pragma once

#include <cmath>
#include <optional>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {

class EnclosingSurface {
 public:
  EnclosingSurface(const Collider& collider, BodyIndex body) : collider_(collider), view_(collider, body) {
    if (view_.is_deforming())
      surface().tree().fit(triangle_boxes(surface().mesh.triangles, collider.vertices), fitted_);
  }

  const SurfaceView& view() const { return view_; }

  /// The point of the surface nearest to x.
  NearestTriangle nearest(const Vec3& x) const {
    const TriangleMesh& mesh = surface().mesh;
    if (view_.is_deforming()) return nearest_triangle(surface().tree(), mesh.triangles, collider_.vertices, x, fitted_);
    NearestTriangle found =
        nearest_triangle(surface().tree(), mesh.triangles, mesh.vertices, collider_.pose.apply_inverse(x));
    found.at.point = collider_.pose.apply(found.at.point);
    return found;
  }

  /// By the normal of the feature nearest to x, which must be `nearest`'s; where a surface that bends has folded over only
  /// winds_round says for certain.
  bool is_behind(const Vec3& x, const NearestTriangle& nearest) const {
    return (x - nearest.at.point).dot(view_.normal(view_.feature(nearest.triangle, nearest.at.feature))) < 0.0;
  }
  bool winds_round(const Vec3& x) const { return view_.winds_round(x); }

  /// The point of the surface nearest to x if x lies inside.
  std::optional<NearestTriangle> if_inside(const Vec3& x) const {
    if (!overlap(collider_.bounds, Aabb{x, x})) return std::nullopt;
    NearestTriangle found = nearest(x);
    return is_behind(x, found) ? std::optional(found) : std::nullopt;
  }

 private:
  const SurfaceMesh& surface() const { return collider_.mesh(); }

  const Collider& collider_;
  SurfaceView view_;
  std::vector<Aabb> fitted_;  // of what deforms, by node
};

/// Of a place x on a feature of `own` that lies inside another surface, whose nearest point is `out`: gap = -depth, the normal
/// along the way out. `own_is_a`: whose is which.
inline Collision contact_inside(const SurfaceView& own, const SurfaceFeature& feature, const Vec3& x,
                                const NearestTriangle& out, bool own_is_a) {
  const double depth = std::sqrt(out.at.squared_distance);
  const Vec3 way = (out.at.point - x) / depth;
  const TriangleIndex own_triangle(own.triangle_of(feature)), other_triangle(out.triangle);
  Collision c;
  c.triangle_a = own_is_a ? own_triangle : other_triangle;
  c.triangle_b = own_is_a ? other_triangle : own_triangle;
  c.point_a = own_is_a ? x : out.at.point;
  c.point_b = own_is_a ? out.at.point : x;
  c.normal = own_is_a ? way : Vec3(-way);
  c.gap = -depth;
  c.feature = own_is_a ? feature_key(feature.kind, feature.index, Feature::face, out.triangle)
                       : feature_key(Feature::face, out.triangle, feature.kind, feature.index);
  return c;
}

}  // namespace impinge
