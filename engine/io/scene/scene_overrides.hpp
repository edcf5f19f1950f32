// `--set PATH=VALUE` on the tree of a scene, before anything in it is looked at.
#pragma once

#include "engine/io/scene/toml.hpp"

namespace impinge {

/// Replaces or adds the value at a dotted path; `body.NAME.key...` means the [[body]] of that name. Throws InputError
/// `--set PATH=VALUE: ...`.
void apply_override(TomlNode& root, const std::string& text);

}  // namespace impinge
