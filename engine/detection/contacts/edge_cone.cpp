#include "engine/detection/contacts/edge_cone.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

// sine of the angle between two faces below which their common edge is flat and carries no edge contact
constexpr double kFlat = 1e-5;
// sine of the angle between two edges below which they are parallel: their ends carry the contact
constexpr double kParallel = 1e-4;
// how far (as a sine, and as a part of the fold's own) the direction may leave the cone between the faces' normals: the
// crossings of a face that tilts a little all stay, as its vertices do
constexpr double kConeSlack = 0.1, kConeSlackOfFold = 0.25;
// a deforming surface bends within a step: an edge folded either way by less than this (a sine) may be convex at its
// end
constexpr double kBends = 0.02;

}  // namespace

std::optional<EdgeCone> make_edge_cone(const SurfaceView& view, int e) {
  const MeshTopology::Edge& ends = view.edge(e);
  const Vec3 n0 = view.face_normal(ends.triangle0);
  EdgeCone cone{
      e, view.vertex(ends.v0), view.vertex(ends.v1), view.into_face(ends.triangle0, e), Vec3::Zero(), n0, kConeSlack};
  if (ends.triangle1 < 0) return cone;
  const Vec3 n1 = view.face_normal(ends.triangle1);
  cone.into1 = view.into_face(ends.triangle1, e);
  const double fold = n0.cross(n1).norm(), cosine = n0.dot(n1);
  // two faces back to back (no fold, opposite normals) make the sharpest edge there is
  const bool may_bend = view.is_deforming() && fold < kBends && cosine > 0.0;
  if (!may_bend && (n0.dot(cone.into1) >= 0.0 || (fold < kFlat && cosine > 0.0))) return std::nullopt;
  if (may_bend)
    cone.slack = 2.0 * kBends;
  else if (cosine > 0.0)
    cone.slack = std::min(kConeSlack, kConeSlackOfFold * fold);
  const Vec3 sum = n0 + n1;
  const double length = sum.norm();
  cone.normal = length > 1e-9 ? Vec3(sum / length) : Vec3(-(cone.into0 + cone.into1).normalized());
  return cone;
}

std::optional<Vec3> common_normal(const EdgeCone& a, const EdgeCone& b) {
  const Vec3 da = a.q - a.p, db = b.q - b.p;
  Vec3 normal = da.cross(db);
  const double length = normal.norm();
  if (!(length > kParallel * std::sqrt(da.squaredNorm() * db.squaredNorm()))) return std::nullopt;
  normal /= length;
  if (normal.dot(b.normal - a.normal) < 0.0) normal = -normal;
  if (!b.is_outward(normal) || !a.is_outward(-normal)) return std::nullopt;
  return normal;
}

}  // namespace impinge
