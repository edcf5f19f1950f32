#include "engine/bodies/pull.hpp"

#include <cmath>

#include "engine/core/archive.hpp"

namespace impinge {

constexpr double kFrames = 4.0;  // 1/ω of a pull

double critical_damping(double stiffness, double mass) { return 2.0 * std::sqrt(stiffness * mass); }

double default_stiffness(double mass, double frame_time) {
  const double frequency = 1.0 / (kFrames * frame_time);
  return mass * frequency * frequency;
}

void Pull::save(ByteWriter& out) const {
  out.put(point.local), out.put(point.tet);
  for (int k = 0; k < 4; ++k) out.put(point.weight[k]);
  out.put(target), out.put(stiffness), out.put(damping);
}

Pull Pull::restore(ByteReader& in) {
  Pull pull;
  pull.point.local = in.get_vec3(), pull.point.tet = in.get<int>();
  for (int k = 0; k < 4; ++k) pull.point.weight[k] = in.get<double>();
  pull.target = in.get_vec3(), pull.stiffness = in.get<double>(), pull.damping = in.get<double>();
  return pull;
}

}  // namespace impinge
