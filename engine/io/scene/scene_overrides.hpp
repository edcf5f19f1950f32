// `--set PATH=VALUE` on the tree of a scene, before anything in it is looked at.
#pragma once

#include "engine/io/scene/toml.hpp"

namespace impinge {

/// Replaces or adds the values at dotted paths, one after another; `body.NAME.key...` means the [[body]] of that name.
/// Throws InputError `--set PATH=VALUE: ...`.
void apply_overrides(TomlNode& root, const std::vector<std::string>& texts);

}  // namespace impinge
