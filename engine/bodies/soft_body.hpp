// A deformable body in a scene: a tetrahedral body, and the surface embedded in it that collides and is drawn.
#pragma once

#include "engine/bodies/deformable_body.hpp"
#include "engine/geometry/embedding.hpp"

namespace impinge {

/// Which nodes are held: world coordinates at the start.
struct NodeRegion {
  enum Kind { box, sphere, list } kind = box;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();     ///< box
  Vec3 center = Vec3::Zero();                      ///< sphere
  double radius = 0.0;
  std::vector<int> nodes;                          ///< list
  bool contains(int node, const Vec3& x) const;
};

/// What a deformable body is made from; positions in the file's frame, scaled.
struct SoftDescription {
  TetMesh mesh;
  std::vector<double> fraction;       ///< filled fraction of each tetrahedron; empty: all full
  Embedding embedding;                ///< of the surface's vertices
  std::string model = "corotational";
  MaterialSettings material;
  double density = 1000.0;            ///< kg/m³
  MassKind mass = MassKind::lumped;
  RayleighDamping damping;
  std::vector<NodeRegion> fixed;
};

struct SoftBody {
  DeformableBody fem;
  Embedding embedding;
  std::vector<Vec3> surface_velocity;  ///< of the surface's vertices in the coming sub-step, m/s
  double radius = 0.0;                 ///< of the body about its centre at the start, metres: its size

  /// The free and held nodes that carry surface vertex v, with their weights.
  const Tet& nodes_of(int vertex) const { return fem.fem.rest().tets[embedding.tet[vertex]]; }
};

/// Placed by a rotation and a translation of the file's frame, moving with the given velocities about its centre of mass.
SoftBody make_soft_body(const SoftDescription& description, const Pose& file, const Vec3& velocity, const Vec3& angular_velocity);

}  // namespace impinge
