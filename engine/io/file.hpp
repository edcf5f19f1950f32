// Whole files, in and out. A file appears under its name complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace impinge {

/// What is written finds no place (disk full, no permission): exit code 2 like other input errors, but no fault of the
/// scene in hand, so that whoever goes on after an InputError with the next scene stops here.
struct OutputError : InputError {
  explicit OutputError(const std::string& message, std::string why = "")
      : InputError(message), reason(std::move(why)) {}
  std::string reason;  ///< the system's, "" where it is in the message only
};

/// The bytes of a regular file of at most `limit` bytes. Throws InputError, beginning with the path, naming the remedy.
std::string read_file(const std::filesystem::path& path, std::uint64_t limit);

/// Writes a temporary file beside `path`, then renames it. Throws OutputError where that can't be done; nothing of it
/// is left then.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// A name beside `path` that no other file has and no other process is given: X.PROCESS-COUNT.tmp, and before its own
/// ending where `keeps_ending`. What is written under it is renamed to `path` when it is whole.
std::filesystem::path temporary_name(const std::filesystem::path& path, bool keeps_ending = false);
/// Whether a file of that name is one that temporary_name() named: what a process left that was killed.
bool is_temporary_name(std::string_view file_name);

}  // namespace impinge
