// Parameters that stood under other paths in earlier versions: a tree that names those is made one of present paths
// before anything in it is looked at.
#pragma once

#include "engine/core/parameter.hpp"
#include "engine/io/scene/toml.hpp"

namespace impinge {

/// Moves values at former paths to the present ones and returns those that there were. Throws InputError where the
/// tree gives a parameter by both.
std::vector<std::string> rename_former_paths(TomlNode& root, const ParameterSet& rows);

/// `PATH=VALUE` texts with present paths; those that name a former one are added to `used`.
std::vector<std::string> renamed_overrides(const std::vector<std::string>& overrides, const ParameterSet& rows,
                                           std::vector<std::string>& used);

}  // namespace impinge
