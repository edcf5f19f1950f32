// The surface files of a scene: found, kept inside the scene's folder, checked, read once for each scale.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "engine/geometry/mend/skin_check.hpp"
#include "engine/geometry/surface/thickened_surface.hpp"
#include "engine/io/file_guard.hpp"
#include "engine/io/scene/surface_keys.hpp"
#include "engine/io/scene/toml.hpp"
#include "engine/io/tets/tet_file.hpp"
#include "engine/io/tets/volume_cache.hpp"
#include "engine/shapes/shape.hpp"

namespace impinge {

/// One surface file as the scene names it.
struct SurfaceFile {
  std::string name;        ///< relative to the scene's folder
  std::uint64_t hash = 0;  ///< of the file's bytes
  std::size_t vertices = 0, triangles = 0;
  std::size_t welded = 0;          ///< vertices that coincided with an earlier one and were made one with it
  bool says_unit = false;          ///< what its numbers are in
  std::size_t tets = 0;            ///< of a volume mesh, which has no triangles here
  std::vector<std::string> notes;  ///< of a volume mesh's reader, one sentence each
  /// Where it lies, and then those that were read because it names or needs them.
  std::vector<std::filesystem::path> paths = {};
  std::optional<SkinFault> skin_fault = {};  ///< of a new skin (MendReport)
};

class SurfaceFiles {
 public:
  SurfaceFiles(std::filesystem::path folder, bool allow_outside)
      : folder_(std::move(folder)), guard_(allow_outside ? FileGuard() : FileGuard(folder_)) {}

  /// The closed, outward surface of the file that the body's table names, as its other keys want it. Throws InputError
  /// located at the name, or in the file where its text is at fault.
  MeshPointer load(const TomlNode& table, const std::string& what);
  /// The same of a body that does not move by itself, whose surface may be open: then the thin solid round it.
  /// `is_asked`: the scene says how thick or which sides, which a closed surface has no use for.
  MeshPointer load_thin(const TomlNode& table, const std::string& what, const ThinSurface& how, bool is_asked);
  /// The same of a deformable body, whose surface may be open; `skin`: the surface itself, which says what is inside.
  MeshPointer load_open(const TomlNode& table, const std::string& what, MeshPointer& skin);
  /// Bodies of one mesh share its shape, and what is built for that.
  SharedShape shape_of(const MeshPointer& surface);
  /// The convex hull of its vertices.
  SharedShape load_hull(const TomlNode& table, const std::string& what);

  /// The vertices of the mesh file that `node` names, whatever its triangles are like.
  std::vector<Vec3> load_points(const TomlNode& node, const std::string& what);

  /// Shapes that were made of the same text with the same scale are one.
  std::map<std::pair<std::string, double>, SharedShape>& made_shapes() { return shapes_; }

  /// The volume mesh of the file that `node` names, unscaled.
  std::shared_ptr<const TetFile> load_volume(const TomlNode& node, const std::string& what);

  /// Volumes that are made from surfaces.
  VolumeCache& volumes() { return made_; }

  const std::vector<SurfaceFile>& files() const { return files_; }  ///< in order of first use

 private:
  std::filesystem::path find(const TomlNode& node, const std::string& what) const;
  /// As the file has it: its indices are right, and equal vertices are one where they kept it from being closed.
  MeshPointer read(const std::filesystem::path& path, const TomlNode& node);
  /// As the file has it, its triangles unchecked, and its name among the files.
  TriangleMesh read_file_of(const std::filesystem::path& path, const TomlNode& node, const SurfaceKeys& keys);
  /// As the keys want it: mended, or perhaps open.
  MeshPointer prepared(const TomlNode& table, const std::string& what, const SurfaceKeys& keys);
  /// With fewer triangles, beside the surface that it stands for.
  MeshPointer decimated(const TomlNode& table, const std::string& what, const SurfaceKeys& keys);
  MeshPointer load(const TomlNode& table, const std::string& what, const SurfaceKeys& keys);
  MeshPointer load_thin(const TomlNode& table, const std::string& what, const SurfaceKeys& keys, const ThinSurface& how,
                        bool is_asked);
  void check_solid(const TomlNode& node, const std::string& key, const SurfaceMesh& surface);
  SurfaceFile& file_named(const std::string& name);

  std::filesystem::path folder_;
  FileGuard guard_;
  std::vector<SurfaceFile> files_;
  VolumeCache made_;
  std::map<std::string, std::shared_ptr<const TetFile>> volumes_;
  std::map<std::string, MeshPointer> unscaled_;                   // by name
  std::map<std::string, MeshPointer> prepared_;                   // by name and keys
  std::set<std::string> solid_;                                   // by name and keys: what was found to bound a solid
  std::map<std::string, MeshPointer> thin_;                       // by name, scale and how
  std::map<std::pair<std::string, double>, MeshPointer> scaled_;  // by name and scale
  std::map<std::string, std::vector<Vec3>> points_;               // by name
  std::map<std::pair<std::string, double>, SharedShape> shapes_;
  std::map<MeshPointer, SharedShape> mesh_shapes_;  // by address: only looked up
};

}  // namespace impinge
