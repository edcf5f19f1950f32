// A body whose pose is a given function of time. It pushes and is not pushed.
#pragma once

#include "engine/bodies/body.hpp"
#include "engine/bodies/motion.hpp"

namespace impinge {

class ScriptedBody final : public Body {
 public:
  Motion motion;

  BodyKind kind() const override { return BodyKind::scripted; }
  bool is_moving() const override { return !deleted && !driven_.is_zero(); }
  Twist twist() const override { return driven_; }
  void place(double time) override;
  /// From pose(t) to pose(t + h): the velocity that does so exactly.
  void drive(double time, double h, double share) override;
  void advance(const TimeIntegration&, double end) override { place(end); }
  void save(ByteWriter& out) const override { save_frame(out, driven_.linear, Vec3::Zero(), driven_.angular); }
  void restore(ByteReader& in) override;

 private:
  Twist driven_;
};

}  // namespace impinge
