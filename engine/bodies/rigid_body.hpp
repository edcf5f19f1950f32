// A rigid body that forces and impulses move: 6 degrees of freedom. Its frame sits in the centre of mass, its axes are
// those of the file.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/bodies/stagger.hpp"
#include "engine/geometry/mass_properties.hpp"

namespace impinge {

class RigidBody final : public Body {
 public:
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, body frame, kg·m²; see set_inertia
  Mat3 inertia_inverse = Mat3::Zero();
  PrincipalInertia principal;  ///< what the two above are made of

  // State. It carries its spatial angular momentum: free rotation then keeps it to rounding. [Haapaoja16 §2.1]
  Vec3 velocity = Vec3::Zero();          ///< of the centre of mass, m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< about the centre of mass, world axes, kg·m²/s

  void set_inertia(const Mat3& about_center);
  Mat3 world_inertia() const { return pose.rotation * inertia * pose.rotation.transpose(); }
  Mat3 world_inertia_inverse() const { return pose.rotation * inertia_inverse * pose.rotation.transpose(); }
  Vec3 angular_velocity() const { return world_inertia_inverse() * angular_momentum; }

  BodyKind kind() const override { return BodyKind::dynamic; }
  bool has_freedom() const override { return !deleted; }
  bool is_moving() const override { return !asleep && !deleted; }
  int dofs() const override { return 6; }
  Twist twist() const override { return {velocity, angular_velocity()}; }
  double fastest_point() const override { return velocity.norm() + angular_velocity().norm() * radius; }

  void open_sub_step() override;
  void find_free_velocity(const TimeIntegration& how) override;
  SystemBlock system_block() const override;
  CarriedPoint carry(const MaterialPoint& point, const Vec3& at) const override;
  void change_velocity(const BodyVector& change, bool is_blow) override;
  void advance(const TimeIntegration& how, double end) override;
  void displace(const BodyVector& by) override;
  void stay(ByteReader& start) override;
  void check_finite() const override;
  void come_to_rest() override;
  void catch_up() override { lag = 0.0, stagger_ = {}; }

  void push(const Vec3& impulse, const std::optional<Vec3>& at) override;
  void shift(const Vec3& by, const Mat3& turn) override;

  Balance balance(const Vec3& gravity) override;
  void save(ByteWriter& out) const override;
  void restore(ByteReader& in) override;

  /// Where its velocity lags: what of velocity and angular momentum is lead. Zero where it doesn't.
  const Stagger& stagger() const { return stagger_; }

 private:
  void lead_on(const TimeIntegration& how);

  Stagger stagger_;
  Twist lead_;                                               // that was taken off when the sub-step began
  Vec3 given_ = Vec3::Zero(), spin_given_ = Vec3::Zero();    // velocity and angular momentum, by impulses
  bool is_struck_ = false;                                   // by some of these
  Vec3 pulled_ = Vec3::Zero(), spin_pulled_ = Vec3::Zero();  // the same, by a pull
};

}  // namespace impinge
