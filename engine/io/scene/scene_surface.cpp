#include "engine/io/scene/scene_surface.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/memory.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/decimate.hpp"
#include "engine/geometry/mend/mend.hpp"
#include "engine/geometry/mend/remesh.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/companion_error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/meshes/mesh_memory.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;

[[noreturn]] void refuse_mesh(const TomlNode& node, const std::string& problem) {
  throw InputError(fmt::format("{}: surface {} {}; mend = true drops and mends what can be", node.place,
                               toml_string(node.string), problem));
}

/// What `read` makes. Where it needs a file that can't be had, the message begins where the scene names the one that does.
template <class Read>
auto read_with_companions(const TomlNode& node, const Read& read) {
  try {
    return read();
  } catch (const CompanionError& error) {
    throw InputError(fmt::format("{}: file {}: {}", node.place, toml_string(node.string), error.reason));
  }
}

/// The file and those that it names, each once.
std::vector<fs::path> with_others(const fs::path& path, const std::vector<fs::path>& others) {
  std::vector<fs::path> all = {path};
  for (const fs::path& other : others)
    if (std::find(all.begin(), all.end(), other) == all.end()) all.push_back(other);
  return all;
}

/// Why a surface is no solid as it stands.
std::string open_text(const MeshTopology& topology) {
  if (topology.border_edges == 0 && topology.nonmanifold_edges == 0)
    return fmt::format("the surface is not oriented: neighbouring triangles face opposite ways across {} edge{}",
                       topology.misoriented_edges, topology.misoriented_edges == 1 ? "" : "s");
  if (topology.border_edges == 0)
    return fmt::format("the surface is no solid's, and cut where sheets meet ({} edge{} of three triangles or more)",
                       topology.nonmanifold_edges, topology.nonmanifold_edges == 1 ? "" : "s");
  return fmt::format("the surface is open ({} border edges{})", topology.border_edges,
                     topology.nonmanifold_edges > 0 ? ", and cut where sheets meet" : "");
}

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

SurfaceFile& SurfaceFiles::file_named(const std::string& name) {
  for (SurfaceFile& file : files_)
    if (file.name == name) return file;
  files_.emplace_back();
  files_.back().name = name;
  return files_.back();
}

TriangleMesh SurfaceFiles::read_file_of(const fs::path& path, const TomlNode& node, const SurfaceKeys& keys) {
  if (const std::string kind = path.extension().string(); kind == ".msh" || kind == ".veg")
    refuse(node.place, fmt::format("surface {} holds tetrahedra, and not a surface", toml_string(node.string)),
           "ply, off, obj, stl and what assimp reads are surfaces",
           fmt::format("it is the volume of a deformable body: volume = {}", toml_string(node.string)));
  const MeshCount count = estimate_mesh(path);
  check_memory(node.place,
               fmt::format("surface {} ({}, about {:.2g} triangles)", toml_string(node.string),
                           describe_bytes(count.bytes), count.triangles),
               surface_memory(count), "simplify it");
  const std::uint64_t hash = hash_bytes(read_file(path, kLargestFile));
  check_interrupt();
  MeshOrigin origin;
  TriangleMesh mesh = read_with_companions(node, [&] { return read_mesh(path, guard_, &origin); });
  check_interrupt();
  if (keys.is_unit_given && !origin.unit.empty())
    refuse(node.place, fmt::format("surface {} says its own unit ({})", toml_string(node.string), origin.unit),
           "unit belongs to files that say none", "remove unit, or use scale");
  SurfaceFile& file = file_named(node.string);
  file.hash = hash;
  file.vertices = mesh.vertices.size();
  file.triangles = mesh.triangles.size();
  file.says_unit = !origin.unit.empty();
  file.paths = with_others(path, origin.others);
  return mesh;
}

MeshPointer SurfaceFiles::read(const fs::path& path, const TomlNode& node) {
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = read_file_of(path, node, {});
  if (const auto problem = check_indices(surface->mesh)) refuse_mesh(node, *problem);
  surface->topology = make_topology(surface->mesh);
  if (!surface->topology.is_closed()) {
    // formats without shared vertices, and seams of texture or material: the same point written more than once
    WeldedMesh welded = weld(surface->mesh);
    if (welded.mesh.vertices.size() < surface->mesh.vertices.size() && !check_indices(welded.mesh)) {
      file_named(node.string).welded = surface->mesh.vertices.size() - welded.mesh.vertices.size();
      surface->mesh = std::move(welded.mesh);
      surface->topology = make_topology(surface->mesh);
    }
  }
  SurfaceFile& file = file_named(node.string);
  file.vertices = surface->mesh.vertices.size();
  file.triangles = surface->mesh.triangles.size();
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
  volume = read_with_companions(node, [&] { return std::make_shared<TetFile>(read_tet_file(path, guard_)); });
  SurfaceFile file;
  file.name = node.string;
  file.hash = hash_bytes(read_file(path, kLargestFile));
  // TetGen's mesh is a pair of files, and the run depends on both
  for (const auto& [own, other] : {std::pair(".node", ".ele"), std::pair(".ele", ".node")})
    if (path.extension() == own)
      file.hash = hash_bytes(read_file(fs::path(path).replace_extension(other), kLargestFile), file.hash);
  file.vertices = volume->mesh.vertices.size();
  file.tets = volume->mesh.tets.size();
  file.paths = with_others(path, {volume->files.begin(), volume->files.end()});
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
    MeshOrigin origin;
    const TriangleMesh mesh = read_with_companions(node, [&] { return read_mesh(path, guard_, &origin); });
    file.paths = with_others(path, origin.others);
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

MeshPointer SurfaceFiles::prepared(const TomlNode& table, const std::string& what, const SurfaceKeys& keys) {
  const TomlNode& node = table.find("surface")->value;
  const fs::path path = find(node, what + ".surface");
  MeshPointer& result = prepared_[node.string + '\n' + keys.text()];
  if (result != nullptr) return result;
  if (keys.decimate) return result = decimated(table, what, keys);
  TriangleMesh mesh = placed(read_file_of(path, node, keys), keys, table, what);
  if (keys.mend) {
    if (keys.mend->remesh > 0)
      check_memory(table.find("mend")->value.place, fmt::format("{}.mend.remesh = {}", what, keys.mend->remesh),
                   remesh_memory(mesh, keys.mend->remesh), "use fewer cells");
    MendedMesh mended = mend(std::move(mesh), *keys.mend);
    if (mended.problem)
      throw InputError(
          fmt::format("{}: surface {} {}; even mended: mend = {{ remesh = 100 }} makes a new skin of so many "
                      "cells, `impinge mesh {} --mend --picture FILE` shows where it is",
                      node.place, toml_string(node.string), *mended.problem, shell_word(path.string())));
    SurfaceFile& file = file_named(node.string);
    for (const std::string& step : mended.report.steps()) file.notes.push_back("mended: " + step);
    if (mended.report.skin_fault) file.skin_fault = mended.report.skin_fault;
    mesh = std::move(mended.mesh);
  } else {
    if (const auto problem = check_indices(mesh)) refuse_mesh(node, *problem);
    if (!make_topology(mesh).is_closed())
      if (WeldedMesh welded = weld(mesh); !check_indices(welded.mesh)) mesh = std::move(welded.mesh);
  }
  MeshPointer surface = make_surface(std::move(mesh));
  // an open one gets its thickness first
  if (surface->topology.is_closed())
    check_extent(node, what + ".surface", surface->mesh.vertices, keys.scale.maxCoeff());
  return result = std::move(surface);
}

MeshPointer SurfaceFiles::decimated(const TomlNode& table, const std::string& what, const SurfaceKeys& keys) {
  const TomlNode &node = table.find("surface")->value, &key = table.find("decimate")->value;
  MeshPointer full = prepared(table, what, keys.full());
  const int most = *keys.decimate, given = static_cast<int>(full->mesh.triangles.size());
  if (given <= most) return full;
  check_memory(key.place, fmt::format("{}.decimate = {}", what, most), decimate_memory(full->mesh),
               "simplify the file");
  DecimatedMesh few = decimate(full->mesh, most);
  if (few.report.triangles_after > most)
    refuse(
        key.place, fmt::format("{}.decimate is {}", what, most),
        fmt::format("surface {} of {} triangles goes down to {}: then it would cross itself, or lose a part, a hole or "
                    "a handle",
                    toml_string(node.string), given, few.report.triangles_after),
        fmt::format("use {} or more", few.report.triangles_after));
  file_named(node.string).notes.push_back("for contact: " + few.report.text());
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = std::move(few.mesh);
  surface->topology = make_topology(surface->mesh);
  surface->full = std::move(full);
  return surface;
}

void SurfaceFiles::check_solid(const TomlNode& node, const std::string& key, const SurfaceMesh& surface) {
  if (!solid_.insert(key).second) return;
  const auto problem = check_mesh(surface.mesh, surface.topology);
  if (!problem) return;
  throw InputError(
      fmt::format("{}: surface {} {}; mend = true mends it as far as can be, or impinge mesh {} --mend "
                  "--out NEW.ply{}",
                  node.place, toml_string(node.string), *problem, shell_word((folder_ / node.string).string()),
                  surface.topology.is_closed() ? "" : "; a static or scripted body takes it as it is"));
}

MeshPointer SurfaceFiles::load_thin(const TomlNode& table, const std::string& what, const ThinSurface& how,
                                    bool is_asked) {
  return load_thin(table, what, read_surface_keys(table, what), how, is_asked);
}

MeshPointer SurfaceFiles::load_thin(const TomlNode& table, const std::string& what_body, const SurfaceKeys& keys,
                                    const ThinSurface& how, bool is_asked) {
  const TomlNode& node = table.find("surface")->value;
  const std::string what = what_body + ".surface";
  const fs::path path = find(node, what);
  MeshPointer surface;
  double scale = 1.0;
  if (keys.is_plain()) {
    MeshPointer& known = unscaled_[node.string];
    if (known == nullptr) known = read(path, node);
    surface = known;
    scale = keys.scale.x();
  } else {
    surface = prepared(table, what_body, keys);
  }
  if (surface->topology.is_closed()) {
    if (is_asked)
      refuse(node.place, fmt::format("surface {} is closed", toml_string(node.string)),
             "sides and thickness belong to open surfaces", "remove them");
    return load(table, what_body, keys);
  }
  if (how.sides == SurfaceSides::front && surface->topology.misoriented_edges > 0)
    refuse(node.place,
           fmt::format("surface {} has no front: neighbouring triangles face opposite ways across {} edges",
                       toml_string(node.string), surface->topology.misoriented_edges),
           "sides = \"both\" takes it as it is", "use that, or make the normals consistent");
  const std::string key =
      fmt::format("{} {} {} {}", static_cast<int>(how.sides), how.thickness.value_or(0.0), keys.text(), node.string);
  MeshPointer& result = thin_[key];
  if (result != nullptr) return result;
  check_memory(node.place, fmt::format("surface {}, thickened,", toml_string(node.string)),
               2.0 * surface_bytes(static_cast<double>(surface->mesh.triangles.size())), "simplify it");
  TriangleMesh scaled = surface->mesh;
  for (Vec3& x : scaled.vertices) x *= scale;
  auto solid = std::make_shared<SurfaceMesh>();
  solid->mesh = thickened(scaled, how);
  solid->topology = make_topology(solid->mesh);
  if (surface->full != nullptr) solid->full = load_thin(table, what_body, keys.full(), how, is_asked);
  check_extent(node, what, solid->mesh.vertices, scale);
  // the sheets of a file lie in and across one another as they like: each has its own two sides
  auto problem = check_closed(solid->mesh, solid->topology);
  if (!problem && !(signed_volume(solid->mesh) > 0.0)) problem = "encloses no volume: it is flat";
  if (problem)
    refuse(node.place,
           fmt::format("surface {}, open and thickened by {:.3g} m, {}", toml_string(node.string),
                       how.thickness_of(scaled), *problem),
           "a thin solid is wanted", "set another thickness");
  for (SurfaceFile& file : files_)
    if (file.name == node.string && surface->full == nullptr)
      file.notes.push_back(fmt::format("{}: a solid {:.3g} m thick, {}", open_text(surface->topology),
                                       how.thickness_of(scaled),
                                       how.sides == SurfaceSides::both ? "met from both sides" : "behind its front"));
  return result = std::move(solid);
}

MeshPointer SurfaceFiles::load(const TomlNode& table, const std::string& what) {
  return load(table, what, read_surface_keys(table, what));
}

MeshPointer SurfaceFiles::load(const TomlNode& table, const std::string& what_body, const SurfaceKeys& keys) {
  const TomlNode& node = table.find("surface")->value;
  // what is wrong with the file is said of the file
  if (keys.decimate)
    check_solid(node, node.string + '\n' + keys.full().text(), *prepared(table, what_body, keys.full()));
  if (!keys.is_plain()) {
    MeshPointer surface = prepared(table, what_body, keys);
    check_solid(node, node.string + '\n' + keys.text(), *surface);
    return surface;
  }
  const std::string what = what_body + ".surface";
  const double scale = keys.scale.x();
  const fs::path path = find(node, what);
  MeshPointer& surface = unscaled_[node.string];
  if (surface == nullptr) surface = read(path, node);
  check_solid(node, node.string, *surface);
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

MeshPointer SurfaceFiles::load_open(const TomlNode& table, const std::string& what, MeshPointer& skin) {
  skin = prepared(table, what, read_surface_keys(table, what));
  return skin->topology.is_closed() ? load(table, what) : load_thin(table, what, {}, false);
}

SharedShape SurfaceFiles::shape_of(const MeshPointer& surface) {
  SharedShape& shape = mesh_shapes_[surface];
  if (!shape) shape = surface;
  return shape;
}

SharedShape SurfaceFiles::load_hull(const TomlNode& table, const std::string& what) {
  const SurfaceKeys keys = read_surface_keys(table, what);
  const TomlNode& node = table.find("surface")->value;
  const std::pair key("hull\n" + node.string + '\n' + keys.text(), 1.0);
  if (const auto made = shapes_.find(key); made != shapes_.end()) return made->second;
  const MeshPointer surface = prepared(table, what, keys);
  ShapeValues values;
  values.set("points", surface->mesh.vertices);
  try {
    const SharedShape hull = shape_entries()[static_cast<std::size_t>(shape_type("convex_hull"))].make(values);
    shapes_.emplace(key, hull);
    return hull;
  } catch (const ShapeError& error) {
    refuse(node.place, fmt::format("surface {}, whose hull is wanted, {}", toml_string(node.string), error.found),
           error.allowed, error.remedy);
  }
}

}  // namespace impinge
