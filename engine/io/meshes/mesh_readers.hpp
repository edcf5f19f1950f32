// One function a format; mesh_file.cpp chooses. See mesh_file.hpp for what they promise.
#pragma once

#include <filesystem>

#include "engine/geometry/triangle_mesh.hpp"
#include "engine/io/file_guard.hpp"

namespace impinge {

TriangleMesh read_ply(const std::string& name, std::string_view bytes);
TriangleMesh read_off(const std::string& name, std::string_view bytes);
TriangleMesh read_obj(const std::string& name, std::string_view bytes);
TriangleMesh read_stl(const std::string& name, std::string_view bytes);
/// Any format that assimp knows, read in a child process; in metres where the format has a unit.
TriangleMesh read_with_assimp(const std::filesystem::path& path, const FileGuard& guard);

/// Most vertices, triangles or corners of one polygon that are taken.
inline constexpr std::int64_t kMostElements = 100'000'000;
inline constexpr std::int64_t kMostCorners = 1'000'000;

/// Appends the fan of a polygon. `corners` has at least three entries.
inline void append_fan(const std::vector<int>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < corners.size(); ++i) triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

}  // namespace impinge
