// What a scene says of a body, checked and in SI units, and how a body is made from it.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/bodies/deformable_body.hpp"

namespace impinge {

/// What a deformable body is made of; positions in the file's frame, scaled.
struct DeformableDescription {
  TetMesh mesh;                  ///< of quadratic elements: cut (geometry/quadratic_tets)
  std::vector<double> fraction;  ///< filled fraction of each tetrahedron; empty: all full
  Embedding embedding;           ///< of the surface's vertices
  std::string model = "corotational";
  MaterialSettings material;      ///< what every model has
  std::vector<RowText> settings;  ///< rows of the model, which come after `material`
  double density = 1000.0;        ///< kg/m³
  MassKind mass = MassKind::lumped;
  ElementKind element = ElementKind::linear;
  RayleighDamping damping;
  std::vector<NodeRegion> fixed;
};

/// `shape` still stands in the file's own frame.
struct BodyDescription {
  std::string name;
  BodyKind kind = BodyKind::dynamic;
  SharedShape shape;                     ///< scaled, in the file's axes
  std::string surface_file;              ///< of a mesh, as the scene names it; for run.toml and messages
  double density = 1000.0;               ///< kg/m³
  std::optional<double> mass;            ///< kg, instead of the density
  Vec3 position = Vec3::Zero();          ///< of the file's origin
  Vec3 rotation = Vec3::Zero();          ///< degrees about x, then y, then z (fixed axes)
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass, m/s
  Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
  std::vector<MotionKey> motion;         ///< scripted only
  std::optional<double> friction, restitution;
  bool self_collision = false;
  std::optional<double> self_exempt_distance;  ///< metres: triangles of its own this near at rest don't collide
  std::shared_ptr<const DeformableDescription> deformable;  ///< deformable only
};

/// Mass, centre and inertia by exact volume integrals. Throws InputError (without a place) naming the remedy if a mesh
/// encloses no volume, a dynamic body is a plane, or a region of held nodes holds none.
std::unique_ptr<Body> make_body(const BodyDescription& description);

}  // namespace impinge
