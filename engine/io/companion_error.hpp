// A file that another one needs beside it, and that can't be had.
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"

namespace impinge {

/// Whoever knows who asked for `file` can say so in front of the rest of the message.
struct CompanionError : InputError {
  CompanionError(const std::filesystem::path& file, const std::string& rest)
      : InputError(file.string() + ": " + rest), reason(rest) {}
  std::string reason;  ///< "found; allowed; remedy"
};

}  // namespace impinge
