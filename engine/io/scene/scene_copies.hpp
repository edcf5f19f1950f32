// Copies of a body: `copies` in the scene, one description, many placements; and those that are added while it runs.
#pragma once

#include <span>

#include "engine/io/scene/scene.hpp"
#include "engine/io/scene/toml.hpp"
#include "engine/step/act.hpp"

namespace impinge {

/// Each [[body]] with copies = [ { position, ... }, ... ] or copies = { count, spacing } is followed by bodies of their
/// own, NAME_2, NAME_3, ..., which have all its keys but those that the copy gives; `copies` itself is gone. So they
/// have names, can be set, and share what is loaded and built for the first. Throws InputError, located.
void expand_copies(TomlNode& root);

/// What `act` adds: as if its pattern stood in the scene once more, with this name, place, velocity and, if it has one,
/// turn. `before`: those added before, which may be patterns too; a name that neither has is an InternalError. Throws
/// InputError, without a place, where there can be no copy.
BodyDescription describe_added(const Scene& scene, std::span<const Act> before, const Act& act);

}  // namespace impinge
