// What reading a surface file takes, before it is taken.
#pragma once

#include <filesystem>

namespace impinge {

/// Of a surface file: as its header says, or as pieces of it let expect.
struct MeshCount {
  double bytes = 0.0;  ///< of the file
  double vertices = 0.0, triangles = 0.0;
  bool is_soup = false;  ///< three vertices a triangle, to be welded
};

/// Looks at a few pieces of the file. All zero where it can't be read: whoever reads it will say why.
MeshCount estimate_mesh(const std::filesystem::path& path);

/// Most that is resident at once while such a file becomes a surface with its topology, and while a rigid body is made
/// of that, bytes.
double surface_memory(const MeshCount& count);

/// A surface and its topology in memory, bytes, for a closed surface of so many triangles.
double surface_bytes(double triangles);

}  // namespace impinge
