#include "engine/bodies/motion.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/rotation.hpp"

namespace impinge {

Motion::Motion(std::vector<MotionKey> keys) : keys_(std::move(keys)), slopes_(keys_.size(), Vec6::Zero()) {
  const auto value = [&](std::size_t k) {
    Vec6 v;
    v << keys_[k].position, keys_[k].rotation;
    return v;
  };
  // slopes at inner keys: the weighted harmonic mean of the neighbouring secants where they agree in sign, else 0;
  // at the ends 0, because the body rests before the first key and after the last
  for (std::size_t k = 1; k + 1 < keys_.size(); ++k) {
    const double h0 = keys_[k].time - keys_[k - 1].time, h1 = keys_[k + 1].time - keys_[k].time;
    const Vec6 d0 = (value(k) - value(k - 1)) / h0, d1 = (value(k + 1) - value(k)) / h1;
    for (int c = 0; c < 6; ++c) {
      if (d0[c] * d1[c] <= 0.0) continue;
      const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
      slopes_[k][c] = (w0 + w1) / (w0 / d0[c] + w1 / d1[c]);
    }
  }
}

Pose Motion::at(double time) const {
  const auto pose = [](const Vec3& position, const Vec3& degrees) {
    return Pose{rotation_from_degrees(degrees), position};
  };
  if (time <= keys_.front().time) return pose(keys_.front().position, keys_.front().rotation);
  if (time >= keys_.back().time) return pose(keys_.back().position, keys_.back().rotation);
  const auto next =
      std::upper_bound(keys_.begin(), keys_.end(), time, [](double t, const MotionKey& key) { return t < key.time; });
  const std::size_t k = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const double h = keys_[k + 1].time - keys_[k].time, s = (time - keys_[k].time) / h;
  const double h01 = s * s * (3.0 - 2.0 * s), h10 = s * (1.0 - s) * (1.0 - s), h11 = s * s * (s - 1.0);
  const auto blend = [&](const Vec3& p0, const Vec3& p1, const Vec3& m0, const Vec3& m1) {
    return Vec3(p0 + h01 * (p1 - p0) + h * (h10 * m0 + h11 * m1));
  };
  return pose(blend(keys_[k].position, keys_[k + 1].position, slopes_[k].head<3>(), slopes_[k + 1].head<3>()),
              blend(keys_[k].rotation, keys_[k + 1].rotation, slopes_[k].tail<3>(), slopes_[k + 1].tail<3>()));
}

}  // namespace impinge
