// Triangle surfaces from files, and to PLY.
//
// PLY, OFF, OBJ and STL have readers of our own: strict, in double precision, and true to the file's vertex order.
// assimp stores single precision, reorders and splits vertices, and crashes on some damaged files of these formats; it
// reads the other formats here, but glTF (read_gltf.cpp), both in a process of their own, so that a crash in them becomes
// an error message.
//
// Every problem is one InputError: `file:line:column: found; allowed; remedy` for text, `file: byte N: ...` for binary.
#pragma once

#include <filesystem>
#include <span>

#include "engine/geometry/triangle_mesh.hpp"
#include "engine/io/file_guard.hpp"

namespace impinge {

/// What a file says of itself beside its mesh.
struct MeshOrigin {
  /// What its numbers are in, in words, where the format says so and they were converted: "0.01 m"; "" where it doesn't
  /// and they were taken as metres.
  std::string unit;
  std::vector<std::filesystem::path> others;  ///< files that it names in turn and that were read
};

/// The mesh in a file, by its ending: vertices in source order, polygons as triangles (polygon.hpp). Indices are in
/// range and coordinates finite; whether the surface is closed is for others to check. Coordinates are metres: those of
/// formats that say their unit (FBX, Collada, 3MF) are converted, others are taken as they stand. What the file names in turn
/// is read where the guard allows it.
TriangleMesh read_mesh(const std::filesystem::path& path, const FileGuard& guard = {}, MeshOrigin* origin = nullptr);

/// The same from bytes; `name` is used in messages and its ending chooses among ply, off, obj and stl.
TriangleMesh parse_mesh(const std::string& name, std::string_view bytes);

/// Binary little-endian PLY: property double x, y, z; list uchar uint vertex_indices. Positions in metres, order kept.
void write_ply(const std::filesystem::path& path, std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace impinge
