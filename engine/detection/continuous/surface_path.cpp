#include "engine/detection/continuous/surface_path.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/rotation.hpp"

namespace impinge {
namespace {

/// The pose before t and how far from it towards the next.
std::pair<std::size_t, double> place_of(const SurfacePath& path, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * path.pieces();
  const std::size_t i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(path.pieces() - 1));
  return {i, at - static_cast<double>(i)};
}

}  // namespace

PathSurface::PathSurface(const SurfaceMesh& of) : surface(&of) {
  const TriangleMesh& mesh = of.mesh;
  for (const Vec3& x : mesh.vertices) radius = std::max(radius, x.norm());
  owned.assign(mesh.triangles.size(), 0);
  std::vector<char> vertex_taken(mesh.vertices.size(), 0), edge_taken(of.topology.edges.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      char& vertex = vertex_taken[mesh.triangles[t][k]];
      char& edge = edge_taken[of.topology.triangle_edges[t][k]];
      if (vertex == 0) owned[t] |= 1 << k, vertex = 1;
      if (edge == 0) owned[t] |= 8 << k, edge = 1;
    }
}

Pose SurfacePath::pose_at(double t) const {
  const auto [i, share] = place_of(*this, t);
  const Pose &from = poses[i], &to = poses[i + 1];
  if (share == 0.0) return from;
  if (share == 1.0) return to;
  const Vec3 turn = rotation_log(to.rotation * from.rotation.transpose());
  return {rotation_exp(share * turn) * from.rotation, from.position + share * (to.position - from.position)};
}

double SurfacePath::bend(double t0, double t1) const {
  if (!is_rigid()) return 0.0;
  const auto [i, share] = place_of(*this, 0.5 * (t0 + t1));
  const double angle =
      rotation_log(poses[i + 1].rotation * poses[i].rotation.transpose()).norm() * (t1 - t0) * pieces();
  return of->radius * (1.0 - std::cos(0.5 * angle));
}

double SurfacePath::travel(double t0, double t1) const {
  if (!is_rigid()) {
    double most = 0.0;
    for (std::size_t v = 0; v < start.size(); ++v) most = std::max(most, (end[v] - start[v]).squaredNorm());
    return std::sqrt(most) * (t1 - t0);
  }
  const auto [i, share] = place_of(*this, 0.5 * (t0 + t1));
  const double part = (t1 - t0) * pieces();
  const double angle = rotation_log(poses[i + 1].rotation * poses[i].rotation.transpose()).norm() * part;
  return (poses[i + 1].position - poses[i].position).norm() * part + angle * of->radius;
}

}  // namespace impinge
