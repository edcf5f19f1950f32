// A rigid body: static, scripted or dynamic. Its frame sits in the centre of mass, its axes are those of the file.
#pragma once

#include <optional>

#include "engine/bodies/body_kind.hpp"
#include "engine/bodies/motion.hpp"
#include "engine/bodies/soft_body.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// What a scene file says of a body, checked and in SI; `shape` still stands in the file's own frame (scaled).
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
  std::shared_ptr<const SoftDescription> soft;  ///< deformable only
};

struct RigidBody {
  std::string name;
  BodyKind kind = BodyKind::dynamic;
  SharedShape shape;  ///< relative to the centre of mass
  std::string surface_file;
  Vec3 center = Vec3::Zero();   ///< centre of mass in the file's frame
  double mass = 0.0;            ///< kg; 0: static or scripted
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, body frame, kg·m²; see set_inertia
  Mat3 inertia_inverse = Mat3::Zero();
  PrincipalInertia principal;  ///< of a dynamic body: what the two above are made of
  double radius = 0.0;         ///< farthest point from the centre of mass, metres (0 for planes)
  double mean_edge = 0.0;      ///< of a mesh, metres
  Motion motion;               ///< scripted only

  // State. A dynamic body carries its spatial angular momentum: free rotation then keeps it to rounding. [Haapaoja16
  // §2.1]
  Pose pose;  ///< of the centre of mass
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_momentum = Vec3::Zero();
  Vec3 scripted_angular_velocity = Vec3::Zero();
  bool asleep = false;
  double rest_time = 0.0;  ///< seconds in a row below the sleeping speed
  int island = -1;         ///< of a sleeping body: the group it fell asleep with, named by its lowest body

  double friction = -1.0;     ///< -1: the scene's contact.friction
  double restitution = -1.0;  ///< -1: the scene's contact.restitution
  bool self_collision = false;

  std::vector<Vec3> world_vertices;  ///< of a mesh at `pose`, or of a deformable body's surface
  std::unique_ptr<SoftBody> soft;    ///< of a deformable body; its pose is the identity then

  bool is_dynamic() const { return kind == BodyKind::dynamic; }
  bool is_deformable() const { return kind == BodyKind::deformable; }
  bool has_freedom() const { return is_dynamic() || is_deformable(); }
  void set_inertia(const Mat3& about_center);
  Mat3 world_inertia() const { return pose.rotation * inertia * pose.rotation.transpose(); }
  Mat3 world_inertia_inverse() const { return pose.rotation * inertia_inverse * pose.rotation.transpose(); }
  Vec3 angular_velocity() const {
    return is_dynamic() ? Vec3(world_inertia_inverse() * angular_momentum) : scripted_angular_velocity;
  }
  Pose file_pose() const { return {pose.rotation, pose.position - pose.rotation * center}; }
  void update_world_vertices();
  Aabb bounds() const;
};

/// Mass, centre and inertia by exact volume integrals; throws InputError (without a place) naming the remedy if a mesh
/// encloses no volume or a dynamic body is a plane.
RigidBody make_rigid_body(const BodyDescription& description);

}  // namespace impinge
