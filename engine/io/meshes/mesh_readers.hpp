// One function a format; mesh_file.cpp chooses. See mesh_file.hpp for what they promise.
#pragma once

#include "engine/io/meshes/mesh_file.hpp"

namespace impinge {

TriangleMesh read_ply(const std::string& name, std::string_view bytes);
TriangleMesh read_off(const std::string& name, std::string_view bytes);
TriangleMesh read_obj(const std::string& name, std::string_view bytes);
TriangleMesh read_stl(const std::string& name, std::string_view bytes);
/// Any format that assimp knows, read in a child process; in metres where the format has a unit, which `origin` then
/// names.
TriangleMesh read_with_assimp(const std::filesystem::path& path, const FileGuard& guard, MeshOrigin& origin);

/// What that does in the child process. Throws InputError, worded to follow the file's name.
struct Imported;
class CompanionFiles;
Imported import_by_assimp(const std::string& path, CompanionFiles& files);
/// glTF and GLB, in a child process likewise.
TriangleMesh read_gltf(const std::filesystem::path& path, const FileGuard& guard, MeshOrigin& origin);

/// Metres of the unit that a 3MF file says, a thousandth where it says none. Throws InputError, worded to follow the
/// file's name, for one that the format doesn't have.
double metres_of_3mf(const std::string& path);

/// ".ply" of "a/B.PLY".
std::string ending(const std::string& name);

/// Largest file that is read.
inline constexpr std::uint64_t kMostMeshBytes = std::uint64_t{4} << 30;
/// Most vertices, triangles or corners of one polygon that are taken.
inline constexpr std::int64_t kMostElements = 100'000'000;
inline constexpr std::int64_t kMostCorners = 1'000'000;

}  // namespace impinge
