#include "engine/io/scene/scene_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/memory.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/mend/winding_tree.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/geometry/tets/quadratic_tets.hpp"
#include "engine/geometry/tets/tet_cage.hpp"
#include "engine/io/scene/scene_shape.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "engine/io/scene/volume_memory.hpp"
#include "engine/io/tets/tetrahedralize.hpp"
#include "engine/shapes/primitives.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

constexpr int kFewestCells = 2, kMostCells = 200;
constexpr double kMostOutside = 0.1;  // of the volume's longest side: a vertex farther out belongs to another mesh

int read_cells(const TomlNode& table, const std::string& what, const std::vector<std::string>& keys = {"cells"}) {
  check_keys(table, what, keys);
  const TomlEntry* cells = table.find("cells");
  if (cells == nullptr)
    refuse(table.place, what + " has no cells", "cells = how many along the longest side", "add cells = 12");
  const double n = scene_real(cells->value, what + ".cells", {kFewestCells, kMostCells});
  if (n != std::floor(n))
    refuse(cells->value.place, fmt::format("{}.cells is {}", what, shortest(n)), "a whole number is wanted",
           "round it");
  return static_cast<int>(n);
}

/// How a cage tells what is inside: by rays, exact along each, or by winding numbers, which open surfaces have too.
bool is_by_winding(const TomlNode& table, const std::string& what) {
  const TomlEntry* inside = table.find("inside");
  if (inside == nullptr) return false;
  const std::string& word = scene_text(inside->value, what + ".inside");
  if (word != "rays" && word != "winding")
    refuse(inside->value.place, fmt::format("{}.inside is {}", what, toml_string(word)),
           "\"rays\" or \"winding\" is allowed", "use one of them");
  return word == "winding";
}

Aabb box_round(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& x : points) box.include(x);
  return box;
}

MeshPointer checked_surface(TriangleMesh mesh, const TomlNode& node, const std::string& name) {
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = std::move(mesh);
  surface->topology = make_topology(surface->mesh);
  if (const auto problem = check_mesh(surface->mesh, surface->topology))
    throw InputError(
        fmt::format("{}: the boundary of {} {}; give the body a surface of its own", node.place, name, *problem));
  return surface;
}

/// The faces that belong to one tetrahedron, with the vertices they use.
TriangleMesh boundary_of(const TetMesh& volume) {
  TriangleMesh mesh;
  mesh.triangles = boundary_triangles(volume);
  std::vector<int> index(volume.vertices.size(), -1);
  for (Triangle& t : mesh.triangles)
    for (int& v : t) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(volume.vertices[v]);
      }
      v = index[v];
    }
  return mesh;
}

/// An exact shape as triangles whose edges are about `edge` metres long.
MeshPointer shape_surface(const TomlNode& node, const std::string& what, const Shape& shape, double edge) {
  const ShapeEntry& entry = shape_entries()[static_cast<std::size_t>(shape.type())];
  if (entry.not_deformable.empty()) return checked_surface(shape.surface(edge), node, what);
  std::vector<std::string_view> others;
  for (const ShapeEntry& e : shape_entries())
    if (e.make != nullptr && e.not_deformable.empty()) others.push_back(e.name);
  refuse(node.place, fmt::format("{} is a {} and the body deformable: it {}", what, entry.name, entry.not_deformable),
         fmt::format("{} and any closed surface file can be deformable", fmt::join(others, ", ")), "use another shape");
}

/// The surface that collides and is drawn: a file's, or an exact shape's with edges of `edge` metres, or of its longest
/// side / `cells` where cells > 0.
MeshPointer outer_surface(const TomlNode& table, const std::string& what, double scale, double edge, int cells,
                          SurfaceFiles& files, BodyDescription& body) {
  if (const TomlEntry* surface = table.find("surface")) {
    body.surface_file = surface->value.string;
    return files.load(table, what);
  }
  const TomlEntry* entry = table.find("shape");
  const SharedShape shape = read_shape(entry->value, what + ".shape", scale, files);
  // an edge too short is refused by the caller, once the surface is there: no finer than is ever taken
  const double longest = shape->bounds({}).extent().maxCoeff();
  return shape_surface(entry->value, what + ".shape", *shape,
                       cells > 0 ? longest / cells : std::max(edge, longest / kMostCells));
}

/// Midpoints for elements that have some; parts are as full as the whole.
void add_element_nodes(const TomlNode& node, const std::string& name, DeformableDescription& soft) {
  if (soft.element == ElementKind::linear) return;
  check_memory(node.place, fmt::format("{} of {} quadratic tetrahedra", name, soft.mesh.tets.size()),
               deformable_memory(static_cast<double>(soft.mesh.tets.size() * kTetParts), 0.0), "use fewer of them");
  soft.mesh = cut_at_midpoints(soft.mesh);
  std::vector<double> fraction;
  for (const double f : soft.fraction) fraction.insert(fraction.end(), kTetParts, f);
  soft.fraction = std::move(fraction);
}

void take(const CarriedVolume& volume, const MeshPointer& surface, const TomlNode& node, const std::string& name,
          DeformableDescription& soft, BodyDescription& body) {
  soft.mesh = volume.mesh;
  soft.fraction = volume.fraction;
  soft.embedding = volume.embedding;
  body.shape = surface;
  if (soft.element == ElementKind::linear) return;
  add_element_nodes(node, name, soft);
  soft.embedding = embed(soft.mesh, surface->mesh.vertices);
}

// only what the scene leaves open is taken from the file
void use_file_material(const TomlNode& table, const TomlNode& node, const std::string& what, const TetFile& file,
                       DeformableDescription& soft) {
  if (file.materials.empty()) return;
  const TomlEntry* material = table.find("material");
  const auto gives = [&](const char* key) { return material != nullptr && material->value.find(key) != nullptr; };
  const bool elastic = gives("young") && gives("poisson"), density = gives("density") || table.find("mass") != nullptr;
  if (elastic && density) return;
  const std::vector<int>& of = file.element_material;
  const bool one = std::all_of(of.begin(), of.end(), [&](int m) { return m == of[0]; });
  const TetFileMaterial& m = file.materials[of.empty() ? 0 : of[0]];
  if (!one || (!m.isotropic && !elastic))
    refuse(node.place,
           fmt::format("{} = {} has {}", what, toml_string(node.string),
                       one ? "a material that is not isotropic" : "more than one material"),
           "a body has one isotropic material",
           "give young, poisson and density in the scene: they then hold for all of it");
  if (!gives("young")) soft.material.young = m.young;
  if (!gives("poisson")) soft.material.poisson = m.poisson;
  if (!density) soft.density = m.density;
}

double distance_to_triangles(const Vec3& x, const TetMesh& volume, std::span<const Triangle> triangles) {
  double least_sq = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles) {
    const TriangleCorners corners = {volume.vertices[t[0]], volume.vertices[t[1]], volume.vertices[t[2]]};
    least_sq = std::min(least_sq, closest_on_triangle(x, corners).squared_distance);
  }
  return std::sqrt(least_sq);
}

// a surface and a volume that don't belong together would be carried by nonsense
void check_outside(const TomlNode& node, const std::string& what, const TriangleMesh& surface,
                   const DeformableDescription& soft) {
  if (soft.embedding.outside == 0) return;
  const double size = box_round(soft.mesh.vertices).extent().maxCoeff(), allowed = kMostOutside * size;
  std::vector<Triangle> boundary;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    if (soft.embedding.weight[v].minCoeff() >= 0.0) continue;
    // the carrying tetrahedron bounds the distance from above; only where that is too far, the whole boundary is asked
    const Vec3& x = surface.vertices[v];
    const Tet& tet = soft.mesh.tets[soft.embedding.tet[v]];
    std::array<Triangle, 4> faces;
    for (int k = 0; k < 4; ++k) faces[k] = {tet[kTetFaces[k][0]], tet[kTetFaces[k][1]], tet[kTetFaces[k][2]]};
    if (distance_to_triangles(x, soft.mesh, faces) <= allowed) continue;
    if (boundary.empty()) boundary = boundary_triangles(soft.mesh);
    const double distance = distance_to_triangles(x, soft.mesh, boundary);
    if (distance > allowed)
      refuse(node.place,
             fmt::format("{}: vertex {} of the surface lies {:.3g} m outside of the volume", what, v, distance),
             fmt::format("at most {:.3g} m (a tenth of its {:.3g} m) is taken: both must be of one frame and scale",
                         allowed, size),
             "check that they belong together");
  }
}

void read_volume_file(const TomlNode& table, const TomlNode& node, const std::string& what, double scale,
                      SurfaceFiles& files, DeformableDescription& soft, BodyDescription& body) {
  const std::string name = what + ".volume";
  if (const TomlEntry* shape = table.find("shape"))
    refuse(shape->place, what + " has a shape and a volume file",
           "the volume's own boundary or a surface file is its surface", "remove shape");
  const std::shared_ptr<const TetFile> file = files.load_volume(node, name);
  check_memory(node.place, fmt::format("{} of {} tetrahedra", name, file->mesh.tets.size()),
               deformable_memory(static_cast<double>(file->mesh.tets.size()), 0.0), "use a coarser mesh");
  soft.mesh = file->mesh;
  for (Vec3& x : soft.mesh.vertices) x *= scale;
  check_extent(node, name, soft.mesh.vertices, scale);
  add_element_nodes(node, name, soft);
  use_file_material(table, node, name, *file, soft);
  const MeshPointer surface = table.find("surface") != nullptr
                                  ? outer_surface(table, what, scale, 1.0, 0, files, body)
                                  : checked_surface(boundary_of(soft.mesh), node, toml_string(node.string));
  soft.embedding = embed(soft.mesh, surface->mesh.vertices);
  check_outside(node, name, surface->mesh, soft);
  body.shape = surface;
}

void read_cage(const TomlNode& table, const TomlEntry& way, const std::string& what, double scale, SurfaceFiles& files,
               DeformableDescription& soft, BodyDescription& body) {
  const int cells = read_cells(way.value, what + ".volume.cage", {"cells", "inside"});
  const bool by_winding = is_by_winding(way.value, what + ".volume.cage");
  const TomlEntry* surface = table.find("surface");
  MeshPointer outer, skin;
  if (by_winding && surface != nullptr) {
    outer = files.load_open(table, what, skin);
    body.surface_file = surface->value.string;
  } else {
    // a shape's surface is as fine as the nodes that carry it
    const int fineness = soft.element == ElementKind::quadratic ? 2 : 1;
    outer = outer_surface(table, what, scale, 0.0, fineness * cells, files, body);
    skin = outer;
  }
  check_memory(way.value.place, fmt::format("{}.volume.cage of {} cells", what, cells), cage_memory(outer->mesh, cells),
               "use fewer cells");
  const auto make = [&]() -> CarriedVolume {
    TetCageSettings settings;
    settings.cells = cells;
    const WindingTree winding(skin->mesh.triangles, skin->mesh.vertices);
    if (by_winding) settings.is_inside = [&](const Vec3& x) { return winding.is_inside(x); };
    TetCage cage = make_tet_cage(outer->mesh, settings);
    return {std::move(cage.mesh), std::move(cage.fraction), std::move(cage.embedding)};
  };
  take(*files.volumes().get(outer->mesh, fmt::format("cage {}{}", cells, by_winding ? " winding" : ""), make), outer,
       way.value, what + ".volume.cage", soft, body);
}

void read_lattice(const TomlNode& table, const TomlEntry& way, const std::string& what, double scale,
                  SurfaceFiles& files, DeformableDescription& soft, BodyDescription& body) {
  const std::string name = what + ".volume.lattice";
  const int cells = read_cells(way.value, name);
  const TomlEntry* shape = table.find("shape");
  if (shape == nullptr || shape->value.find("box") == nullptr)
    refuse(way.place, name + " is of a body that is not a box", "shape = { box = { size } } can be one", "use a cage");
  const SharedShape box = read_shape(shape->value, what + ".shape", scale, files);
  const Vec3 half = box->as<Box>()->half;
  const Eigen::Vector3i n = cells_of_box(half, cells);
  const Vec3 count = n.cast<double>();
  const double faces = count.x() * count.y() + count.y() * count.z() + count.z() * count.x();
  check_memory(way.value.place, fmt::format("{} of {} cells", name, cells),
               deformable_memory(5.0 * count.prod(), 4.0 * faces), "use fewer cells");
  soft.mesh = make_alternating_box(2.0 * half, n.x(), n.y(), n.z());
  for (Vec3& x : soft.mesh.vertices) x -= half;
  add_element_nodes(way.value, name, soft);
  const MeshPointer boundary = checked_surface(boundary_of(soft.mesh), way.value, name);
  soft.embedding = embed(soft.mesh, boundary->mesh.vertices);
  body.shape = boundary;
}

void read_tetrahedralize(const TomlNode& table, const TomlEntry& way, const std::string& what, double scale,
                         SurfaceFiles& files, DeformableDescription& soft, BodyDescription& body) {
  const std::string name = what + ".volume.tetrahedralize";
  const TomlNode& node = way.value;
  check_keys(node, name, {"max_size", "min_angle"});
  const TomlEntry *size = node.find("max_size"), *angle = node.find("min_angle");
  if (size == nullptr)
    refuse(node.place, name + " has no max_size", "max_size = the longest edge in metres is wanted", "add it");
  TetrahedralizeSettings settings;
  settings.max_size = scene_positive(size->value, name + ".max_size", 1e6);
  if (angle != nullptr) settings.min_angle = scene_real(angle->value, name + ".min_angle", {0.0, 20.0});
  const MeshPointer outer = outer_surface(table, what, scale, settings.max_size, 0, files, body);
  const double longest = box_round(outer->mesh.vertices).extent().maxCoeff();
  if (settings.max_size < longest / kMostCells)
    refuse(size->value.place, fmt::format("{}.max_size is {}", name, shortest(settings.max_size)),
           fmt::format("at least {:.3g} m, a {}th of the surface's longest side, is allowed", longest / kMostCells,
                       kMostCells),
           "make it larger");
  check_memory(size->value.place, fmt::format("{} with max_size {}", name, shortest(settings.max_size)),
               tetrahedralize_memory(outer->mesh, settings.max_size), "use a larger max_size");
  const auto make = [&]() -> CarriedVolume {
    try {
      CarriedVolume volume;
      volume.mesh = tetrahedralize(outer->mesh, settings);
      volume.embedding = embed(volume.mesh, outer->mesh.vertices);
      return volume;
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", node.place, name, error.what()));
    }
  };
  const std::string options =
      fmt::format("tetrahedralize {} {}", shortest(settings.max_size), shortest(settings.min_angle));
  take(*files.volumes().get(outer->mesh, options, make), outer, node, name, soft, body);
  check_outside(node, name, outer->mesh, soft);
}

}  // namespace

void read_volume(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files,
                 DeformableDescription& soft, BodyDescription& body) {
  const TomlEntry *entry = table.find("volume"), *shape = table.find("shape"), *surface = table.find("surface");
  const std::string name = what + ".volume";
  if (shape != nullptr && surface != nullptr)
    refuse(surface->place, what + " has a shape and a surface", "one of them is wanted", "remove one");
  if (entry == nullptr)
    refuse(table.place, what + " is deformable and has no volume",
           "a cage round its surface or a file of tetrahedra is wanted", "add volume = { cage = { cells = 12 } }");
  if (entry->value.kind == TomlNode::text) return read_volume_file(table, entry->value, what, scale, files, soft, body);
  if (entry->value.kind != TomlNode::table)
    refuse(entry->value.place, fmt::format("{} is {}", name, toml_kind_name(entry->value)),
           "a file name, or a table naming one way to make it, is wanted", "write volume = { cage = { cells = 12 } }");
  const TomlNode& volume = entry->value;
  check_keys(volume, name, {"cage", "lattice", "tetrahedralize"});
  if (volume.entries.size() != 1)
    refuse(volume.place, fmt::format("{} names {} ways", name, volume.entries.size()),
           "a file's name, or one of cage, lattice, tetrahedralize, is wanted",
           "write volume = { cage = { cells = 12 } }");
  const TomlEntry& way = volume.entries[0];
  scene_table(way.value, name + "." + way.key);
  if (shape == nullptr && surface == nullptr)
    refuse(table.place, what + " has no surface", "surface = \"file\", or shape = { ... }, is wanted", "add one");
  if (way.key == "cage") return read_cage(table, way, what, scale, files, soft, body);
  if (way.key == "lattice") return read_lattice(table, way, what, scale, files, soft, body);
  read_tetrahedralize(table, way, what, scale, files, soft, body);
}

}  // namespace impinge
