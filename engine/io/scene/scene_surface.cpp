#include "engine/io/scene/scene_surface.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/geometry/mesh_checks.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;

bool is_inside(const fs::path& folder, const fs::path& path) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != ".." && !relative.is_absolute();
}

}  // namespace

fs::path SurfaceFiles::find(const TomlNode& node, const std::string& what) const {
  const std::string& name = scene_text(node, what);
  if (name.empty())
    refuse(node.place, what + " is empty", "a mesh file's path relative to the scene file is wanted", "name a file");
  const fs::path path = folder_ / name;  // an absolute name replaces the folder
  std::error_code error;
  // symbolic links are followed first: what counts is where the file really is
  const fs::path folder = fs::weakly_canonical(folder_.empty() ? fs::path(".") : folder_, error);
  // of a name that isn't there, a relative one stays relative
  const fs::path target = fs::weakly_canonical(fs::absolute(path, error), error);
  if (!allow_outside_ && !is_inside(folder, target))
    refuse(node.place,
           fmt::format("{} = {} leads out of the scene's folder ({})", what, toml_string(name), target.string()),
           "files inside it are read", "move the file there, or set allow_outside_files = true in the table [scene]");
  if (!fs::exists(path, error))
    refuse(node.place, fmt::format("{} = {}: there is no such file ({})", what, toml_string(name), path.string()),
           "a mesh file is wanted", "check the path");
  if (!fs::is_regular_file(path, error))
    refuse(node.place, fmt::format("{} = {} is not a regular file", what, toml_string(name)), "a mesh file is wanted",
           "check the path");
  return path;
}

MeshPointer SurfaceFiles::read(const fs::path& path, const TomlNode& node) {
  SurfaceFile file;
  file.name = node.string;
  file.hash = hash_bytes(read_file(path, kLargestFile));
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = read_mesh(path);
  const auto refuse_mesh = [&](const std::string& problem) {
    throw InputError(fmt::format("{}: surface {} {}", node.place, toml_string(node.string), problem));
  };
  if (const auto problem = check_indices(surface->mesh)) refuse_mesh(*problem);
  surface->topology = make_topology(surface->mesh);
  if (!surface->topology.is_closed()) {
    // formats without shared vertices, and seams of texture or material: the same point written more than once
    WeldedMesh welded = weld(surface->mesh);
    if (welded.mesh.vertices.size() < surface->mesh.vertices.size() && !check_indices(welded.mesh)) {
      file.welded = surface->mesh.vertices.size() - welded.mesh.vertices.size();
      surface->mesh = std::move(welded.mesh);
      surface->topology = make_topology(surface->mesh);
    }
  }
  if (const auto problem = check_mesh(surface->mesh, surface->topology)) refuse_mesh(*problem);
  file.vertices = surface->mesh.vertices.size();
  file.triangles = surface->mesh.triangles.size();
  files_.push_back(file);
  return surface;
}

std::shared_ptr<const TetFile> SurfaceFiles::load_volume(const TomlNode& node, const std::string& what) {
  const fs::path path = find(node, what);
  std::shared_ptr<const TetFile>& volume = volumes_[node.string];
  if (volume != nullptr) return volume;
  volume = std::make_shared<TetFile>(read_tet_file(path));
  SurfaceFile file;
  file.name = node.string;
  file.hash = hash_bytes(read_file(path, kLargestFile));
  // TetGen's mesh is a pair of files, and the run depends on both
  for (const auto& [own, other] : {std::pair(".node", ".ele"), std::pair(".ele", ".node")})
    if (path.extension() == own)
      file.hash = hash_bytes(read_file(fs::path(path).replace_extension(other), kLargestFile), file.hash);
  file.vertices = volume->mesh.vertices.size();
  file.tets = volume->mesh.tets.size();
  file.notes = volume->notes;
  files_.push_back(std::move(file));
  return volume;
}

std::vector<Vec3> SurfaceFiles::load_points(const TomlNode& node, const std::string& what) {
  const fs::path path = find(node, what);
  const auto [place, is_new] = points_.try_emplace(node.string);
  if (is_new) {
    SurfaceFile file;
    file.name = node.string;
    file.hash = hash_bytes(read_file(path, kLargestFile));
    const TriangleMesh mesh = read_mesh(path);
    for (const Vec3& x : mesh.vertices)
      if (!x.allFinite())
        throw InputError(fmt::format("{}: surface {} has a vertex that is not a finite number; mend the file",
                                     node.place, toml_string(node.string)));
    file.vertices = mesh.vertices.size();
    file.triangles = mesh.triangles.size();
    files_.push_back(std::move(file));
    place->second = mesh.vertices;
  }
  return place->second;
}

MeshPointer SurfaceFiles::load(const TomlNode& node, const std::string& what, double scale) {
  const fs::path path = find(node, what);
  MeshPointer& surface = unscaled_[node.string];
  if (surface == nullptr) surface = read(path, node);
  if (scale == 1.0) return surface;
  MeshPointer& result = scaled_[{node.string, scale}];
  if (result == nullptr) {
    auto copy = std::make_shared<SurfaceMesh>(*surface);
    for (Vec3& x : copy->mesh.vertices) x *= scale;
    result = std::move(copy);
  }
  return result;
}

}  // namespace impinge
