// What lies at a path, and folders. Unlike std::filesystem these tell "nothing there" from "can't be known", and say
// why.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace impinge {

enum class PathKind { nothing, file, folder, other };

/// Symbolic links are followed. Throws InputError with the system's reason where it can't be told: a folder above that
/// may not be entered, links that lead in a circle, a broken disk.
PathKind path_kind(const std::filesystem::path& path);
inline bool is_there(const std::filesystem::path& path) { return path_kind(path) != PathKind::nothing; }
inline bool is_file(const std::filesystem::path& path) { return path_kind(path) == PathKind::file; }
inline bool is_folder(const std::filesystem::path& path) { return path_kind(path) == PathKind::folder; }

/// The names in a folder, sorted. Throws InputError with the reason where it can't be read.
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// Makes a folder and those above it, as far as they are not there. Throws OutputError with the reason.
void make_folder(const std::filesystem::path& folder);

/// The path from the root; of "" the present folder. Throws InputError where that is gone.
std::filesystem::path absolute_path(const std::filesystem::path& path);

}  // namespace impinge
