// `copies` of a body: one description, many placements.
#pragma once

#include "engine/io/scene/toml.hpp"

namespace impinge {

/// Each [[body]] with copies = [ { position, ... }, ... ] or copies = { count, spacing } is followed by bodies of their
/// own, NAME_2, NAME_3, ..., which have all its keys but those that the copy gives; `copies` itself is gone. So they
/// have names, can be set, and share what is loaded and built for the first. Throws InputError, located.
void expand_copies(TomlNode& root);

}  // namespace impinge
