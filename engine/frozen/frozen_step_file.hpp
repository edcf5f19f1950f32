// A frozen step as a file: DIR/frozen/NNNNNN.step of `impinge run --freeze`, the input of `impinge step`. Its layout,
// byte by byte: engine/README.md.
#pragma once

#include <filesystem>

#include "engine/frozen/frozen_step.hpp"

namespace impinge {

/// The bytes of the file.
std::string format_frozen_step(const FrozenStep& step);
/// Throws InputError where it can't be written.
void write_frozen_step(const std::filesystem::path& path, const FrozenStep& step);

/// Throws InputError `file: byte N: found; allowed; remedy` unless the file is whole, of this version and consistent:
/// indices in range, matrices with symmetric patterns, finite numbers.
FrozenStep read_frozen_step(const std::filesystem::path& path);

/// Whether the file begins as a frozen step does. False where it can't be read.
bool is_frozen_step(const std::filesystem::path& path);

}  // namespace impinge
