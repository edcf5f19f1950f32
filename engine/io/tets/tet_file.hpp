// Volume meshes from files: Vega .veg, TetGen .node/.ele, Gmsh .msh (2.2 and 4.1, text and binary).
//
// Every problem is one InputError `file:line:column: found; allowed; remedy`. What is accepted is a body: finite
// coordinates, positive volumes, at most two tetrahedra at a face, every vertex used (TetGen and Gmsh files may hold
// unused vertices, which are dropped with a note).
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/geometry/tets/tet_mesh.hpp"
#include "engine/io/file_guard.hpp"

namespace impinge {

/// A material that a .veg file names. Orthotropic and Mooney-Rivlin ones are checked and known by name and density
/// only.
struct TetFileMaterial {
  std::string name;
  double density = 1000.0;  ///< kg/m³
  bool isotropic = true;    ///< false: young and poisson don't describe it
  double young = 1e9;       ///< Pa
  double poisson = 0.45;
};

struct TetFile {
  TetMesh mesh;                            ///< vertices and tetrahedra in file order
  std::vector<TetFileMaterial> materials;  ///< empty where the format has none
  std::vector<int> element_material;       ///< of each tetrahedron; empty where there are no materials
  std::vector<std::string> notes;          ///< what was dropped or assumed, one sentence each
  std::vector<std::string> files;          ///< all that were read, the one that was named first among them
};

/// The mesh in a file, by its ending: .veg, .msh, or .node or .ele (whose partner is looked for beside it). What it
/// names or needs beside itself is read where the guard allows it.
TetFile read_tet_file(const std::filesystem::path& path, const FileGuard& guard = {});

// the same from bytes; names are used in messages
TetFile parse_msh(const std::string& name, std::string_view bytes);
TetFile parse_tetgen(const std::string& node_name, std::string_view node_bytes, const std::string& ele_name,
                     std::string_view ele_bytes);
/// Reads *INCLUDE files from `directory`, kMostIncludes of them in all.
TetFile parse_veg(const std::string& name, std::string_view bytes, const std::filesystem::path& directory,
                  const FileGuard& guard = {});

}  // namespace impinge
