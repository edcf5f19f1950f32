// One [[attachment]] of a scene as a checked description.
#pragma once

#include "engine/bodies/attachment.hpp"
#include "engine/bodies/bodies.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

/// The table of number `index`, which is its name unless it gives one. Throws InputError, located, at the first key or
/// value that can't be taken: names that are not among `bodies`, and two ends that can't move.
AttachmentDescription read_attachment(const TomlNode& table, int index, const Bodies& bodies);

}  // namespace impinge
