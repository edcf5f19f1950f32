// A deformable body in a scene: a tetrahedral body, the surface embedded in it that collides and is drawn, and the
// nodes that are held or moved.
#pragma once

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/motion.hpp"
#include "engine/geometry/embedding.hpp"

namespace impinge {

/// Which nodes are held: world coordinates at the start.
struct NodeRegion {
  enum Kind { box, sphere, list } kind = box;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< box
  Vec3 center = Vec3::Zero();                   ///< sphere
  double radius = 0.0;
  std::vector<int> nodes;  ///< list
  /// how they are moved: displacement, and rotation about their middle; empty: not at all
  std::vector<MotionKey> motion;
  bool contains(int node, const Vec3& x) const;
};

/// What a deformable body is made from; positions in the file's frame, scaled.
struct SoftDescription {
  TetMesh mesh;
  std::vector<double> fraction;  ///< filled fraction of each tetrahedron; empty: all full
  Embedding embedding;           ///< of the surface's vertices
  std::string model = "corotational";
  MaterialSettings material;      ///< what every model has
  std::vector<RowText> settings;  ///< rows of the model, which come after `material`
  double density = 1000.0;        ///< kg/m³
  MassKind mass = MassKind::lumped;
  RayleighDamping damping;
  std::vector<NodeRegion> fixed;
};

/// Held nodes and where they go: x(t) = pivot + displacement + p(t) + R(t) (x(0) - pivot), p and R from key frames.
struct HeldRegion {
  std::vector<int> nodes;
  std::vector<Vec3> start;    ///< their positions at the start, world
  Vec3 pivot = Vec3::Zero();  ///< their mean at the start
  Motion motion;
  Vec3 displacement = Vec3::Zero();  ///< where a parameter has moved them so far, metres
  Vec3 wanted = Vec3::Zero();        ///< where it wants them at the end of the frame, metres
  Vec3 at(std::size_t k, double time) const;
  bool is_moved() const { return !motion.is_empty() || displacement != wanted || !displacement.isZero(0.0); }
};

struct SoftBody {
  DeformableBody fem;
  Embedding embedding;
  std::shared_ptr<Material> material;  ///< the one that fem's elements refer to
  std::vector<HeldRegion> held;
  std::vector<Vec3> surface_velocity;  ///< of the surface's vertices in the coming sub-step, m/s
  std::string model;                   ///< the material's name

  /// The free and held nodes that carry surface vertex v, with embedding.weight[v].
  const Tet& nodes_of(int vertex) const { return fem.fem.rest().tets[embedding.tet[vertex]]; }
  /// Gives held nodes the velocities that bring them where they are wanted at time + h. `share` of what is left of the
  /// wanted displacement is covered in this sub-step (1: all of it).
  void drive_held(double time, double h, double share);
  double fastest_node() const;  ///< m/s
};

/// Placed by a rotation and a translation of the file's frame, moving with the given velocities about its centre of
/// mass. Throws InputError (without a place) where a region holds no node.
SoftBody make_soft_body(const SoftDescription& description, const Pose& file, const Vec3& velocity,
                        const Vec3& angular_velocity);

}  // namespace impinge
