#include "engine/bodies/scripted_body.hpp"

#include "engine/geometry/rotation.hpp"

namespace impinge {

void ScriptedBody::place(double time) {
  if (motion.is_empty()) return;
  const Pose file = motion.at(time);
  pose = {file.rotation, file.apply(center)};
  update_world_vertices();
}

void ScriptedBody::drive(double time, double h, double /*share*/) {
  if (motion.is_empty()) return;
  const Pose now = motion.at(time), then = motion.at(time + h);
  driven_.linear = (then.apply(center) - now.apply(center)) / h;
  driven_.angular = rotation_log(then.rotation * now.rotation.transpose()) / h;
}

void ScriptedBody::restore(ByteReader& in) {
  const Frame frame = restore_frame(in);
  driven_ = {frame.velocity, frame.angular_velocity};
}

}  // namespace impinge
