// Whole files, in and out. A file appears under its name complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace impinge {

/// The bytes of a regular file of at most `limit` bytes. Throws InputError, beginning with the path, naming the remedy.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit);

/// Writes a temporary file beside `path`, then renames it. Throws InputError where that can't be done (disk full, ...).
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace impinge
