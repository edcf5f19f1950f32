#include "engine/detection/continuous/plane_between.hpp"

#include <algorithm>

namespace impinge {
namespace {

constexpr std::size_t kMostVertices = 32;  // of either: beyond, a search by trees is no dearer
constexpr int kMostStretches = 8;          // of the path, as it comes
constexpr int kHalvings = 2;               // of such a piece: shorter ones bend less

/// A surface where a piece of its path begins and ends.
struct Piece {
  std::vector<Vec3> first, last;

  Piece(const SurfacePath& path, double t0, double t1) {
    const Pose from = path.pose_at(t0), to = path.pose_at(t1);
    for (const Vec3& x : path.of->surface->mesh.vertices) first.push_back(from.apply(x)), last.push_back(to.apply(x));
  }
};

double reach(const std::vector<Vec3>& points, const Vec3& direction) {
  double most = -INFINITY;
  for (const Vec3& x : points) most = std::max(most, direction.dot(x));
  return most;
}

/// Whether one of the faces of `a`, as it stands half way, has all of `b` beyond it but for `allowed`. Along a fixed
/// normal points on straight lines overlap most where they start or end.
bool has_face_between(const SurfacePath& a, const Piece& of_a, const Piece& of_b, double half_way, double allowed) {
  const TriangleMesh& mesh = a.of->surface->mesh;
  const Mat3 rotation = a.pose_at(half_way).rotation;
  Vec3 before = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3& p = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3 across = (mesh.vertices[static_cast<std::size_t>(t[1])] - p)
                            .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - p)
                            .normalized();
    if (across.dot(before) > 1.0 - 1e-12) continue;  // the other half of a face
    before = across;
    const Vec3 normal = rotation * across;
    if (reach(of_a.last, normal) + reach(of_b.last, -normal) <= allowed &&
        reach(of_a.first, normal) + reach(of_b.first, -normal) <= allowed)
      return true;
  }
  return false;
}

bool is_beside(const SurfacePath& a, const SurfacePath& b, double depth, double t0, double t1, int halvings) {
  const double allowed = depth - a.bend(t0, t1) - b.bend(t0, t1), half_way = 0.5 * (t0 + t1);
  if (allowed > 0.0) {
    const Piece of_a(a, t0, t1), of_b(b, t0, t1);
    if (has_face_between(a, of_a, of_b, half_way, allowed) || has_face_between(b, of_b, of_a, half_way, allowed))
      return true;
  }
  return halvings > 0 && is_beside(a, b, depth, half_way, t1, halvings - 1) &&
         is_beside(a, b, depth, t0, half_way, halvings - 1);
}

}  // namespace

bool stays_beside(const SurfacePath& a, const SurfacePath& b, double depth) {
  if (!a.is_rigid() || !b.is_rigid()) return false;
  for (const SurfacePath* path : {&a, &b})
    if (path->of->surface->mesh.vertices.size() > kMostVertices) return false;
  const int pieces = std::max(a.pieces(), b.pieces());  // both are powers of two
  if (pieces > kMostStretches) return false;
  for (int i = pieces - 1; i >= 0; --i)  // where it ends it is the most likely to overlap
    if (!is_beside(a, b, depth, static_cast<double>(i) / pieces, (i + 1.0) / pieces, kHalvings)) return false;
  return true;
}

}  // namespace impinge
