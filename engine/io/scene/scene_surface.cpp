#include "engine/io/scene/scene_surface.hpp"

#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/memory.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/meshes/mesh_memory.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;

}  // namespace

fs::path SurfaceFiles::find(const TomlNode& node, const std::string& what) const {
  const std::string& name = scene_text(node, what);
  if (name.empty())
    refuse(node.place, what + " is empty", "a mesh file's path relative to the scene file is wanted", "name a file");
  fs::path path = folder_ / name;  // an absolute name replaces the folder
  PathKind kind = PathKind::nothing;
  try {
    kind = path_kind(path);
  } catch (const InputError& reason) {
    throw InputError(fmt::format("{}: {} = {}: {}", node.place, what, toml_string(name), reason.what()));
  }
  std::error_code error;
  if (const auto target = guard_.refused(path))
    refuse(node.place,
           fmt::format("{} = {} leads out of the scene's folder ({})", what, toml_string(name), target->string()),
           "files inside it are read", "move the file there, or set allow_outside_files = true in the table [scene]");
  if (kind == PathKind::nothing)
    refuse(node.place, fmt::format("{} = {}: there is no such file ({})", what, toml_string(name), path.string()),
           "a mesh file is wanted", "check the path");
  if (kind != PathKind::file)
    refuse(node.place, fmt::format("{} = {} is not a regular file", what, toml_string(name)), "a mesh file is wanted",
           "check the path");
  return path;
}

MeshPointer SurfaceFiles::read(const fs::path& path, const TomlNode& node) {
  SurfaceFile file;
  file.name = node.string;
  const MeshCount count = estimate_mesh(path);
  check_memory(node.place,
               fmt::format("surface {} ({}, about {:.2g} triangles)", toml_string(node.string),
                           describe_bytes(count.bytes), count.triangles),
               surface_memory(count), "simplify it");
  file.hash = hash_bytes(read_file(path, kLargestFile));
  auto surface = std::make_shared<SurfaceMesh>();
  check_interrupt();
  surface->mesh = read_mesh(path, guard_);
  check_interrupt();
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
  file.vertices = surface->mesh.vertices.size();
  file.triangles = surface->mesh.triangles.size();
  files_.push_back(file);
  return surface;
}

std::shared_ptr<const TetFile> SurfaceFiles::load_volume(const TomlNode& node, const std::string& what) {
  const fs::path path = find(node, what);
  std::shared_ptr<const TetFile>& volume = volumes_[node.string];
  if (volume != nullptr) return volume;
  std::error_code error;
  const double bytes = static_cast<double>(fs::file_size(path, error));
  // its text, and what it says: no less than 20 bytes a tetrahedron or a vertex
  if (!error)
    check_memory(node.place, fmt::format("{} = {} ({})", what, toml_string(node.string), describe_bytes(bytes)),
                 3.0 * bytes, "use a coarser mesh");
  volume = std::make_shared<TetFile>(read_tet_file(path, guard_));
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

MeshPointer SurfaceFiles::load_thin(const TomlNode& node, const std::string& what, double scale, const ThinSurface& how,
                                    bool is_asked) {
  const fs::path path = find(node, what);
  MeshPointer& surface = unscaled_[node.string];
  if (surface == nullptr) surface = read(path, node);
  if (surface->topology.is_closed()) {
    if (is_asked)
      refuse(node.place, fmt::format("surface {} is closed", toml_string(node.string)),
             "sides and thickness belong to open surfaces", "remove them");
    return load(node, what, scale);
  }
  if (how.sides == SurfaceSides::front && surface->topology.misoriented_edges > 0)
    refuse(node.place,
           fmt::format("surface {} has no front: neighbouring triangles face opposite ways across {} edges",
                       toml_string(node.string), surface->topology.misoriented_edges),
           "sides = \"both\" takes it as it is", "use that, or make the normals consistent");
  const std::string key =
      fmt::format("{} {} {} {}", static_cast<int>(how.sides), how.thickness.value_or(0.0), scale, node.string);
  MeshPointer& result = thin_[key];
  if (result != nullptr) return result;
  check_memory(node.place, fmt::format("surface {}, thickened,", toml_string(node.string)),
               2.0 * surface_bytes(static_cast<double>(surface->mesh.triangles.size())), "simplify it");
  TriangleMesh scaled = surface->mesh;
  for (Vec3& x : scaled.vertices) x *= scale;
  auto solid = make_surface(thickened(scaled, how));
  check_extent(node, what, solid->mesh.vertices, scale);
  if (const auto problem = check_mesh(solid->mesh, solid->topology))
    refuse(node.place,
           fmt::format("surface {}, open and thickened by {:.3g} m, {}", toml_string(node.string),
                       how.thickness_of(scaled), *problem),
           "a thin solid is wanted", "set another thickness");
  for (SurfaceFile& file : files_)
    if (file.name == node.string)
      file.notes.push_back(fmt::format(
          "the surface is open ({} border edges{}): a solid {:.3g} m thick, {}", surface->topology.border_edges,
          surface->topology.nonmanifold_edges > 0 ? ", and cut where sheets meet" : "", how.thickness_of(scaled),
          how.sides == SurfaceSides::both ? "met from both sides" : "behind its front"));
  return result = std::move(solid);
}

MeshPointer SurfaceFiles::load(const TomlNode& node, const std::string& what, double scale) {
  const fs::path path = find(node, what);
  MeshPointer& surface = unscaled_[node.string];
  if (surface == nullptr) surface = read(path, node);
  if (solid_.insert(node.string).second)
    if (const auto problem = check_mesh(surface->mesh, surface->topology))
      throw InputError(
          fmt::format("{}: surface {} {}{}", node.place, toml_string(node.string), *problem,
                      surface->topology.is_closed() ? "" : "; a static or scripted body takes it as it is"));
  if (scale == 1.0) {
    check_extent(node, what, surface->mesh.vertices, scale);
    return surface;
  }
  MeshPointer& result = scaled_[{node.string, scale}];
  if (result == nullptr) {
    check_memory(node.place, fmt::format("surface {}, scaled,", toml_string(node.string)),
                 surface_bytes(static_cast<double>(surface->mesh.triangles.size())), "use one scale for all bodies");
    auto copy = std::make_shared<SurfaceMesh>(*surface);
    for (Vec3& x : copy->mesh.vertices) x *= scale;
    check_extent(node, what, copy->mesh.vertices, scale);
    result = std::move(copy);
  }
  return result;
}

}  // namespace impinge
