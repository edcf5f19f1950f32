// A session's state in a file, with a checksum: snapshots/NNNNNN.bin. With it is what whoever watches the run knows so
// far, in bytes that mean something only to them.
#pragma once

#include <filesystem>

#include "viewer/controller/session.hpp"

namespace impinge {

/// The bytes of the file.
std::string format_snapshot(const Session& session, std::string_view notes = {});
/// Returns its size in bytes.
std::size_t write_snapshot(const std::filesystem::path& path, const Session& session, std::string_view notes = {});

/// Whether the file is whole: right head, right checksum.
bool is_valid_snapshot(const std::filesystem::path& path);

/// Throws InputError if the file is there and of the form that another version of this program writes.
void refuse_other_version(const std::filesystem::path& path);

/// Returns the notes, "" if there are none. Throws InputError if the file is damaged or belongs to another scene.
std::string restore_snapshot(const std::filesystem::path& path, Session& session);

}  // namespace impinge
