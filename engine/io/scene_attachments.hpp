// [[attachment]] tables of a scene: two points that stay together.
#pragma once

#include "engine/bodies/attachment.hpp"
#include "engine/io/scene_values.hpp"

namespace impinge {

/// Number `index` of the scene. Throws InputError, located.
AttachmentDescription read_attachment(const TomlNode& table, int index);

}  // namespace impinge
