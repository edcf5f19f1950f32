// Key frames of a scripted body or of moved nodes.
#pragma once

#include "engine/bodies/motion.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

/// [ { time, position, rotation }, ... ] in increasing time; a key frame without position or rotation has the given
/// one.
std::vector<MotionKey> read_motion(const TomlNode& node, const std::string& what, const Vec3& position,
                                   const Vec3& rotation);

}  // namespace impinge
