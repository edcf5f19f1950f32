// Deformable bodies in worlds, built without files.
#pragma once

#include "engine/geometry/tets/quadratic_tets.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

struct SoftOptions {
  double young = 1e5, poisson = 0.4, density = 1000.0, damping_beta = 0.01;
  std::string model = "corotational";
  ElementKind element = ElementKind::linear;
};

/// The boundary of a tetrahedral mesh, with the nodes it uses as vertices.
inline TriangleMesh boundary_surface(const TetMesh& mesh) {
  TriangleMesh surface;
  surface.vertices = mesh.vertices;  // inner nodes stay as unused vertices: the embedding is the identity then
  surface.triangles = boundary_triangles(mesh);
  std::vector<int> index(mesh.vertices.size(), -1);
  std::vector<Vec3> used;
  for (Triangle& t : surface.triangles)
    for (int& v : t) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(used.size());
        used.push_back(surface.vertices[v]);
      }
      v = index[v];
    }
  surface.vertices = std::move(used);
  return surface;
}

/// A cube of `size` metres, `cells` lattice cells a side, its lowest corner at `corner`.
inline BodyDescription soft_box(const std::string& name, const Vec3& size, const Eigen::Vector3i& cells,
                                const Vec3& corner, const SoftOptions& o = {}) {
  auto soft = std::make_shared<DeformableDescription>();
  soft->mesh = make_tet_box(size, cells.x(), cells.y(), cells.z());
  soft->element = o.element;
  if (o.element == ElementKind::quadratic) soft->mesh = cut_at_midpoints(soft->mesh);
  soft->model = o.model;
  soft->material.young = o.young;
  soft->material.poisson = o.poisson;
  soft->density = o.density;
  soft->damping.beta = o.damping_beta;
  TriangleMesh boundary = boundary_surface(soft->mesh);
  soft->embedding = embed(soft->mesh, boundary.vertices);
  BodyDescription d;
  d.name = name;
  d.kind = BodyKind::deformable;
  d.shape = surface(std::move(boundary));
  d.deformable = soft;
  d.position = corner;
  return d;
}

inline BodyDescription soft_cube(const std::string& name, double size, int cells, const Vec3& corner,
                                 const SoftOptions& o = {}) {
  return soft_box(name, Vec3::Constant(size), Eigen::Vector3i::Constant(cells), corner, o);
}

/// Force on body b from contacts of the last sub-step, N.
inline Vec3 contact_force_on(const World& world, int b) {
  Vec3 sum = Vec3::Zero();
  for (const ContactRecord& c : world.record().contacts) {
    const Vec3 t1 = tangent1(c.normal), t2 = c.normal.cross(t1);
    const Vec3 impulse = c.lambda.x() * c.normal + c.lambda.y() * t1 + c.lambda.z() * t2;
    if (c.body_a == b) sum += impulse;
    if (c.body_b == b) sum -= impulse;
  }
  return sum / world.parameters.simulation.time_step();
}

/// Fastest node of all deformable bodies, m/s.
inline double fastest_node(const World& world) {
  double fastest = 0.0;
  for (const Body& body : world.bodies())
    if (body.kind() == BodyKind::deformable) fastest = std::max(fastest, body.fastest_point());
  return fastest;
}

}  // namespace impinge::test
