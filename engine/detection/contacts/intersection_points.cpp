// Contacts of triangles that intersect already: the seed's discrete detection. [Haapaoja16 §3.2.3]
//
// The seed takes the vertex of T_A that is deepest behind T_B, with T_B's normal, even where it is a vertex of T_B that
// stands in T_A (a corner of B in the middle of a face of A): its contact is then as deep as T_A is long. Here either
// triangle may give the vertex: the one whose vertex lies over the other triangle, and of two such, or of none, the
// shallower. n points from B towards A in both cases.
//
// The vertex is traced back against its relative velocity to where it came through the other triangle. Where that gives
// no sound answer (at rest, moving out, grazing, a ray that misses) the closest point of the triangle to its projection
// on the plane stands in. Both lie in the triangle's plane, so the gap is the depth of the vertex behind it either way.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/contact_points.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

// sine of the angle to the plane below which a path grazes it: the point found would be far off the vertex
constexpr double kGrazing = 0.1;

struct Deepest {
  int corner = -1;  // of the triangle whose vertex it is; -1: none lies behind the other
  double depth = 0.0;
  bool is_over = false;  // its projection lies in the other triangle
};

Deepest deepest_behind(const TriangleCorners& own, const TriangleCorners& other, const Vec3& n) {
  Deepest found;
  if (n.isZero(0.0)) return found;
  for (int k = 0; k < 3; ++k) {
    const double depth = n.dot(other[0] - own[k]);
    if (depth >= 0.0 && (found.corner < 0 || depth > found.depth)) found = {k, depth, false};
  }
  if (found.corner < 0) return found;
  const Vec3 projected = own[found.corner] + found.depth * n;
  const double size =
      std::max({(other[1] - other[0]).norm(), (other[2] - other[1]).norm(), (other[0] - other[2]).norm()});
  found.is_over = closest_on_triangle(projected, other).squared_distance <= 1e-18 * size * size;
  return found;
}

// the contact of a vertex of `own` in triangle t of `other`, as if own were body a
Collision make_contact(const SurfaceView& own, int t_own, const Deepest& deepest, const SurfaceView& other, int t,
                       const Vec3& n) {
  const int v = own.triangle(t_own)[deepest.corner];
  const Vec3& x = own.vertex(v);
  const TriangleCorners triangle = other.corners(t);
  Collision c;
  c.body_a = BodyIndex(own.body());
  c.body_b = BodyIndex(other.body());
  // of several that the vertex is deepest of, the same one whichever was found first
  c.triangle_a = TriangleIndex(own.triangles_round(v)[0]);
  c.triangle_b = TriangleIndex(t);
  c.point_a = x;
  c.normal = n;
  c.normal_owner = BodyIndex(other.body());
  c.feature = feature_key(Feature::vertex, v, Feature::face, t);
  const Vec3 path = own.vertex_velocity(v) - other.velocity_at(t, x);
  const double speed = path.norm();
  c.point_b = closest_on_triangle(x + deepest.depth * n, triangle).point;
  if (speed > 0.0 && n.dot(path) < -kGrazing * speed) {
    const std::optional<RayHit> hit = intersect_line(x, -path, triangle);
    if (hit && hit->t >= 0.0) c.point_b = x - hit->t * path;
  }
  c.gap = std::min(0.0, n.dot(c.point_a - c.point_b));
  return c;
}

}  // namespace

void intersection_contacts(std::span<const Collider> colliders, const BodyPair& pair,
                           std::span<const TrianglePair> triangles, std::vector<Collision>& contacts) {
  const SurfaceView a(colliders[pair.a], pair.a), b(colliders[pair.b], pair.b);
  std::vector<Collision> found;
  InterruptPoll poll;
  for (const TrianglePair& t : triangles) {
    poll();
    if (!t.intersecting) continue;
    const Vec3 na = a.face_normal(t.triangle_a), nb = b.face_normal(t.triangle_b);
    const TriangleCorners ca = a.corners(t.triangle_a), cb = b.corners(t.triangle_b);
    const Deepest of_a = deepest_behind(ca, cb, nb), of_b = deepest_behind(cb, ca, na);
    if (of_a.corner < 0 && of_b.corner < 0) continue;  // two triangles of no area
    const bool from_a = of_b.corner < 0 ||
                        (of_a.corner >= 0 && (of_a.is_over != of_b.is_over ? of_a.is_over : of_a.depth <= of_b.depth));
    found.push_back(from_a ? make_contact(a, t.triangle_a, of_a, b, t.triangle_b, nb)
                           : exchanged(make_contact(b, t.triangle_b, of_b, a, t.triangle_a, na)));
  }
  keep_one_a_side(found);
  contacts.insert(contacts.end(), found.begin(), found.end());
}

}  // namespace impinge
