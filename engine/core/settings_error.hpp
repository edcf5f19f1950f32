// Settings that don't go together, or that the rest of a scene has no room for: found when all of them are known, by
// who doesn't know where they were given.
#pragma once

#include <utility>
#include <vector>

#include "engine/core/error.hpp"

namespace impinge {

/// Without a place; whoever read the settings puts that before it.
struct SettingsError : InputError {
  SettingsError(std::vector<std::string> of, const std::string& message) : InputError(message), paths(std::move(of)) {}
  std::vector<std::string> paths;  ///< of the parameters that it is about
};

}  // namespace impinge
