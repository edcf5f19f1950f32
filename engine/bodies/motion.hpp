// Key-framed motion of a scripted body: smooth between its keys, held before the first and after the last.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

struct MotionKey {
  double time = 0.0;             ///< seconds
  Vec3 position = Vec3::Zero();  ///< of the file's origin
  Vec3 rotation = Vec3::Zero();  ///< degrees about x, then y, then z; interpolated as numbers, so 0 -> 720 turns twice
};

/// Monotone cubic interpolation [FritschCarlson80] of each component: C1, and never beyond the values of its two keys.
class Motion {
 public:
  Motion() = default;
  /// Keys in increasing time (the loader checks it).
  explicit Motion(std::vector<MotionKey> keys);
  bool is_empty() const { return keys_.empty(); }
  /// Pose of the file's origin at `time`.
  Pose at(double time) const;
  const std::vector<MotionKey>& keys() const { return keys_; }

 private:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  std::vector<MotionKey> keys_;
  std::vector<Vec6> slopes_;  ///< per second, at each key
};

}  // namespace impinge
