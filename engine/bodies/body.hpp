// A body of a scene: what it is called, what it is made of, how it rubs, whether it sleeps, and one of four ways to
// move, each a file of its own: fixed_body, scripted_body, rigid_body, deformable_body. Whoever steps, records or saves
// a world asks a Body; only what one kind alone has is asked of that kind (as<RigidBody>()).
#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <typeinfo>

#include "engine/bodies/balance.hpp"
#include "engine/bodies/body_kind.hpp"
#include "engine/bodies/pull.hpp"
#include "engine/bodies/system_block.hpp"
#include "engine/core/index.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

struct BodyDescription;
class ByteReader;
class ByteWriter;
class DeformableIntegrator;
class ExemptPairs;
struct TimeIntegration;

class Body {
 public:
  virtual ~Body() = default;
  Body& operator=(const Body&) = delete;
  virtual BodyKind kind() const = 0;
  /// This body if it is a T, else null.
  template <std::derived_from<Body> T>
  T* as() {
    return typeid(*this) == typeid(T) ? static_cast<T*>(this) : nullptr;
  }
  template <std::derived_from<Body> T>
  const T* as() const {
    return typeid(*this) == typeid(T) ? static_cast<const T*>(this) : nullptr;
  }

  // identity and shape
  std::string name;
  SharedShape shape;           ///< relative to the centre of mass; of a deformable body: its surface at rest
  std::string surface_file;    ///< of a mesh, as the scene names it
  Vec3 center = Vec3::Zero();  ///< centre of mass in the file's frame
  double radius = 0.0;         ///< farthest point from the centre of mass, metres; 0 of planes and deformable bodies
  double size = 0.0;           ///< at rest, metres: see size_of (shapes/shape_size.hpp); infinite of a plane
  double mean_edge = 0.0;      ///< of a mesh, metres
  double mass = 0.0;           ///< kg; 0: has no freedom

  // coefficients
  std::optional<double> friction, restitution;  ///< empty: the scene's
  bool self_collision = false;
  std::optional<double> self_exempt_distance;       ///< metres; empty: no pair of its triangles is exempt
  std::shared_ptr<const ExemptPairs> exempt_pairs;  ///< of its own triangles; null: none

  // sleep
  bool asleep = false;
  double rest_time = 0.0;  ///< seconds in a row below the sleeping speed
  BodyIndex island;        ///< of a sleeping body: the group it fell asleep with, named by its lowest body

  // when its velocity is that of (VelocityTime, time_integration.hpp)
  double lag = 0.0;                 ///< by how much the velocity that moves it is older than its place, s
  Vec3 lag_gravity = Vec3::Zero();  ///< what acts on it for so long, m/s²: that of the sub-step before
  double kick = 0.0;                ///< for how long forces act in the open sub-step, s; no state

  /// What acts on it in the open sub-step in the mean of `kick`, m/s².
  Vec3 mean_gravity(const TimeIntegration& how) const;

  // what somebody did to it (step/act.hpp)
  std::optional<Pull> pull;  ///< a force on it until it is let go
  bool deleted = false;      ///< it takes no part any more: a name without a body
  bool absent = false;       ///< it takes no part yet, and is in no state and no record (World::add_absent_body)

  // where it is
  Pose pose;                         ///< of the centre of mass; of a deformable body: the world's frame
  std::vector<Vec3> world_vertices;  ///< of a mesh, where update_world_vertices() put them last
  Aabb bounds() const;               ///< of a mesh those of its world_vertices, found with them
  virtual Pose file_pose() const { return {pose.rotation, pose.position - pose.rotation * center}; }
  virtual Vec3 center_of_mass() const { return pose.position; }
  virtual void update_world_vertices();

  // how it moves
  /// Whether forces and impulses change its motion.
  virtual bool has_freedom() const { return false; }
  /// Whether it moves in the coming sub-step, or may.
  virtual bool is_moving() const { return false; }
  virtual int dofs() const { return 0; }
  /// Of its centre of mass; what moves node by node has no spin.
  virtual Twist twist() const { return {}; }
  /// Of the vertices of what moves node by node, in the coming sub-step, m/s; empty: the twist says it.
  virtual std::span<const Vec3> vertex_velocities() const { return {}; }
  /// Of any of its points, m/s, or a bound of it.
  virtual double fastest_point() const { return 0.0; }
  virtual bool can_touch_itself() const { return false; }

  // a sub-step, in its order (step/)
  /// Puts a body that is driven where it is at `time`, s.
  virtual void place(double) {}
  /// Gives what is driven, bodies or held nodes, the velocity that brings it where it is at time + h. `share` of what
  /// is left of a displacement asked for by a parameter is covered in this sub-step (1: all of it).
  virtual void drive(double /*time*/, double /*h*/, double /*share*/) {}
  /// Keeps the velocity before forces and impulses: what restitution reflects.
  virtual void open_sub_step() { before_ = twist(); }
  /// v*: A v* = b. Throws DivergenceError, as all of these do: naming the body, not the frame.
  virtual void find_free_velocity(const TimeIntegration&) {}
  /// Its part of a group's system at v*.
  virtual SystemBlock system_block() const;
  /// How the material at `point` takes part in a row that acts at the world point `at`.
  virtual CarriedPoint carry(const MaterialPoint& point, const Vec3& at) const;
  /// For one more Newton iteration of a scheme whose A and b depend on v: takes them at v* + `change`. Returns how far
  /// that is from the root that `impulse` leaves, relative to the momenta in it.
  virtual double relinearize(const DeformableIntegrator&, const VecX& /*change*/, const VecX& /*impulse*/) {
    return 0.0;
  }
  /// v* of the A and b that relinearize took.
  virtual void solve_again() {}
  /// Of what moves node by node: its surface where v* and `change` (null: nothing) lead, metres.
  virtual void surface_at_end(const BodyVector* /*change*/, std::vector<Vec3>& /*vertices*/) const {}
  /// Adds what contact made of v*.
  virtual void change_velocity(const BodyVector&, bool /*is_blow*/) {}
  /// Moves through the sub-step, which ends at `end`, s.
  virtual void advance(const TimeIntegration&, double /*end*/) {}
  /// Puts it elsewhere without changing its velocity, or its angular momentum.
  virtual void displace(const BodyVector&) {}
  /// Stands where it stood when save() wrote `start`, with the velocity it has now; world_vertices are left to
  /// update_world_vertices. What is driven moves on.
  virtual void stay(ByteReader& /*start*/) {}
  /// Throws DivergenceError where position or velocity is no longer finite.
  virtual void check_finite() const {}
  virtual void come_to_rest() {}
  /// Takes the velocity that it shows for that of its place: forces of the sub-step before act on it no longer.
  virtual void catch_up() {}

  // points of it
  /// A point on (or next to) its surface; `triangle` of a mesh's.
  virtual MaterialPoint surface_point(TriangleIndex triangle, const Vec3& world) const;
  /// The point in or close to it. Throws InputError (without a place) where what moves node by node is too far away.
  virtual MaterialPoint inner_point(const Vec3& world) const;
  virtual Vec3 position_of(const MaterialPoint& point) const { return pose.apply(point.local); }

  /// The point at these coordinates of its own: of a rigid body in the file's axes, from its origin; of what moves node by
  /// node in its shape at rest, where the nearest point of it is taken.
  virtual MaterialPoint own_point(const Vec3& own) const { return surface_point({}, file_pose().apply(own)); }
  virtual Vec3 own_coordinates(const Vec3& world) const { return file_pose().apply_inverse(world); }

  // what somebody does to it between frames; of bodies with freedom
  /// An impulse, N·s, at the world point (of what moves node by node: the nearest point of it), none: at its centre of
  /// mass.
  virtual void push(const Vec3& /*impulse*/, const std::optional<Vec3>& /*at*/) {}
  /// Puts it elsewhere as it is, and as fast as it is: turned about its centre of mass, then moved by `by`, metres.
  virtual void shift(const Vec3& /*by*/, const Mat3& /*turn*/) {}

  // lines and planes that it carries: as the material round a point moves them
  /// What the normal of a plane through the point is to the material there, of any length; and, later, the unit normal.
  virtual Vec3 material_normal(const MaterialPoint& point, const Vec3& world) const;
  virtual Vec3 world_normal(const MaterialPoint& point, const Vec3& material) const;
  /// What moves with the material round `point` and is at `world` now, however far away.
  virtual MaterialPoint point_beside(const MaterialPoint& point, const Vec3& world) const;

  virtual Balance balance(const Vec3& /*gravity*/) { return {}; }
  /// The full state, bit for bit; a world with the same bodies restores it.
  virtual void save(ByteWriter& out) const = 0;
  virtual void restore(ByteReader& in) = 0;

 protected:
  Body() = default;
  Body(const Body&) = default;  // not sliced: only what is derived is copied
  Body(Body&&) = default;

  void save_frame(ByteWriter& out, const Vec3& velocity, const Vec3& angular_momentum,
                  const Vec3& angular_velocity) const;
  struct Frame {
    Vec3 velocity, angular_momentum, angular_velocity;
  };
  Frame restore_frame(ByteReader& in);

  /// To be called when world_vertices have changed.
  void find_vertex_bounds();

  static constexpr double kLargest = 1e12;  ///< metres, m/s: beyond this nothing is resolved, squares overflow soon
  Twist before_;                            ///< at the start of the sub-step

 private:
  Pose placed_;         // that world_vertices belong to, of what is rigid
  Aabb vertex_bounds_;  // of world_vertices
};

}  // namespace impinge
