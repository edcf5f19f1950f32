#include "engine/io/scene_soft.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/geometry/mesh_checks.hpp"
#include "engine/geometry/primitive_surfaces.hpp"
#include "engine/geometry/tet_cage.hpp"
#include "engine/io/scene_body.hpp"
#include "engine/io/scene_motion.hpp"
#include "engine/io/scene_values.hpp"

namespace impinge {
namespace {

constexpr Range kLength{-1e6, 1e6};
constexpr int kMostCells = 200;
constexpr double kMostOutside = 0.1;  // of the volume's size: a surface vertex farther out than this belongs to another mesh

const std::vector<std::string> kMaterialKeys = {"model",   "young",         "poisson",      "density", "damping",
                                                "damping_alpha", "damping_beta", "mass",    "extension_threshold"};

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const auto& e : materials()) names.emplace_back(e.name);
  return names;
}

std::string choice(const TomlNode& node, const std::string& what, const std::vector<std::string>& names) {
  const std::string& word = scene_text(node, what);
  if (std::find(names.begin(), names.end(), word) != names.end()) return word;
  const std::string near = nearest_word(word, names);
  refuse(node.place, fmt::format("{} is {}", what, toml_string(word)), fmt::format("one of {} is allowed", fmt::join(names, ", ")),
         near.empty() ? "use one of them" : fmt::format("did you mean '{}'?", near));
}

int read_cells(const TomlNode& table, const std::string& what) {
  check_keys(table, what, {"cells"});
  const TomlEntry* cells = table.find("cells");
  if (cells == nullptr) refuse(table.place, what + " has no cells", "cells = how many along the longest side", "add cells = 12");
  const double n = scene_real(cells->value, what + ".cells", {1, kMostCells});
  if (n != std::floor(n)) refuse(cells->value.place, fmt::format("{}.cells is {}", what, shortest(n)), "a whole number is wanted", "round it");
  return static_cast<int>(n);
}

void read_damping(const TomlNode& table, const std::string& what, RayleighDamping& damping) {
  if (const TomlEntry* entry = table.find("damping")) {
    const TomlNode& node = entry->value;
    if (node.kind != TomlNode::array || node.items.size() != 2)
      refuse(node.place, what + ".damping is not a pair", "[alpha in 1/s, beta in s] is wanted", "write damping = [0, 0.01]");
    damping.alpha = scene_real(node.items[0], what + ".damping", {0.0, 1e6});
    damping.beta = scene_real(node.items[1], what + ".damping", {0.0, 1e3});
  }
  if (const TomlEntry* entry = table.find("damping_alpha")) damping.alpha = scene_real(entry->value, what + ".damping_alpha", {0.0, 1e6});
  if (const TomlEntry* entry = table.find("damping_beta")) damping.beta = scene_real(entry->value, what + ".damping_beta", {0.0, 1e3});
}

void read_elastic(const TomlNode& table, const std::string& what, SoftDescription& soft) {
  check_keys(scene_table(table, what), what, kMaterialKeys);
  const auto with = [&](const char* key, auto&& read) {
    if (const TomlEntry* entry = table.find(key)) read(entry->value, what + "." + key);
  };
  with("model", [&](const TomlNode& node, const std::string& key) { soft.model = choice(node, key, model_names()); });
  with("young", [&](const TomlNode& node, const std::string& key) { soft.material.young = scene_positive(node, key, 1e15); });
  with("poisson", [&](const TomlNode& node, const std::string& key) { soft.material.poisson = scene_real(node, key, {0.0, 0.4999}); });
  with("density", [&](const TomlNode& node, const std::string& key) { soft.density = scene_positive(node, key, 1e9); });
  with("extension_threshold", [&](const TomlNode& node, const std::string& key) { soft.material.extension_threshold = scene_real(node, key, {1e-3, 0.9}); });
  with("mass", [&](const TomlNode& node, const std::string& key) {
    soft.mass = choice(node, key, {"lumped", "consistent"}) == "lumped" ? MassKind::lumped : MassKind::consistent;
  });
  read_damping(table, what, soft.damping);
}

NodeRegion read_region(const TomlNode& node, const std::string& what) {
  scene_table(node, what);
  check_keys(node, what, {"box", "sphere", "nodes", "motion"});
  const TomlEntry *box = node.find("box"), *sphere = node.find("sphere"), *nodes = node.find("nodes");
  const int named = (box != nullptr) + (sphere != nullptr) + (nodes != nullptr);
  if (named != 1) refuse(node.place, fmt::format("{} names {} regions", what, named), "one of box, sphere, nodes is wanted", "write fixed = { box = { min = [...], max = [...] } }");
  NodeRegion region;
  const auto vector = [&](const TomlNode& table, const std::string& name, const char* key) {
    const TomlEntry* entry = table.find(key);
    if (entry == nullptr) refuse(table.place, fmt::format("{} has no {}", name, key), "[x, y, z] in metres is wanted", "add it");
    return scene_vector(entry->value, name + "." + key, kLength);
  };
  if (box != nullptr) {
    check_keys(scene_table(box->value, what + ".box"), what + ".box", {"min", "max"});
    region.min = vector(box->value, what + ".box", "min");
    region.max = vector(box->value, what + ".box", "max");
    if ((region.min.array() > region.max.array()).any())
      refuse(box->value.place, what + ".box has a min beyond its max", "min <= max in x, y and z is wanted", "exchange them");
  } else if (sphere != nullptr) {
    region.kind = NodeRegion::sphere;
    const std::string name = what + ".sphere";
    check_keys(scene_table(sphere->value, name), name, {"center", "radius"});
    region.center = vector(sphere->value, name, "center");
    const TomlEntry* radius = sphere->value.find("radius");
    if (radius == nullptr) refuse(sphere->value.place, name + " has no radius", "radius = metres is wanted", "add it");
    region.radius = scene_positive(radius->value, name + ".radius", 1e6);
  } else {
    region.kind = NodeRegion::list;
    if (nodes->value.kind != TomlNode::array || nodes->value.items.empty())
      refuse(nodes->value.place, what + ".nodes lists no node", "[0, 1, 2], counted from 0, is wanted", "add at least one");
    for (const TomlNode& item : nodes->value.items) {
      const double n = scene_real(item, what + ".nodes", {0, 1e9});
      if (n != std::floor(n)) refuse(item.place, what + ".nodes holds a fraction", "whole numbers are wanted", "round it");
      region.nodes.push_back(static_cast<int>(n));
    }
  }
  if (const TomlEntry* motion = node.find("motion")) region.motion = read_motion(motion->value, what + ".motion", Vec3::Zero(), Vec3::Zero());
  return region;
}

MeshPointer checked_surface(TriangleMesh mesh, const TomlNode& node, const std::string& what) {
  auto surface = std::make_shared<SurfaceMesh>();
  surface->mesh = std::move(mesh);
  surface->topology = make_topology(surface->mesh);
  if (const auto problem = check_mesh(surface->mesh, surface->topology))
    throw InputError(fmt::format("{}: the boundary of {} {}; give the body a surface of its own", node.place, what, *problem));
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

/// The surface that collides and is drawn: a file's, or that of an exact shape about as fine as the cells.
MeshPointer read_outer_surface(const TomlNode& table, const std::string& what, double scale, int cells, SurfaceFiles& files, BodyDescription& body) {
  if (const TomlEntry* surface = table.find("surface")) {
    body.surface_file = surface->value.string;
    return files.load(surface->value, what + ".surface", scale);
  }
  const TomlEntry* entry = table.find("shape");
  const Shape shape = read_shape(entry->value, what + ".shape", scale);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    int k = 1;  // edges of an icosphere are about 1.1 r / 2^k long
    while (k < 5 && 1.1 * sphere->radius / (1 << k) > 2.0 * sphere->radius / cells) ++k;
    return checked_surface(sphere_surface(sphere->radius, k), entry->value, what + ".shape");
  }
  if (const auto* box = std::get_if<Box>(&shape)) {
    const double longest = box->half.maxCoeff();
    const Eigen::Vector3i n = (box->half / longest * cells).array().round().max(1.0).matrix().cast<int>();
    return checked_surface(box_surface(box->half, n), entry->value, what + ".shape");
  }
  refuse(entry->value.place, fmt::format("{}.shape is a {} and the body deformable", what, shape_name(shape)), "sphere and box can be, and any closed surface file",
         "use surface = \"file\"");
}

void use_file_material(const TomlNode& table, const TomlNode& volume, const std::string& what, const TetFile& file, SoftDescription& soft) {
  const TomlEntry* material = table.find("material");
  const auto names = [&](const char* key) { return material != nullptr && material->value.find(key) != nullptr; };
  if (file.materials.empty()) return;
  const bool one = std::all_of(file.element_material.begin(), file.element_material.end(), [&](int m) { return m == file.element_material[0]; });
  if (names("young") && names("poisson") && (names("density") || table.find("mass") != nullptr)) return;
  const TetFileMaterial& m = file.materials[file.element_material.empty() ? 0 : file.element_material[0]];
  if (!one || !m.isotropic)
    refuse(volume.place, fmt::format("{}.volume = {} has {}", what, toml_string(volume.string), one ? "a material that is not isotropic" : "more than one material"),
           "a body has one isotropic material", "give young, poisson and density in the scene: they then hold for all of it");
  if (!names("young")) soft.material.young = m.young;
  if (!names("poisson")) soft.material.poisson = m.poisson;
  if (!names("density")) soft.density = m.density;
}

void read_volume_file(const TomlNode& table, const TomlNode& node, const std::string& what, double scale, SurfaceFiles& files, SoftDescription& soft,
                      BodyDescription& body) {
  const std::shared_ptr<const TetFile> file = files.load_volume(node, what + ".volume");
  soft.mesh = file->mesh;
  for (Vec3& x : soft.mesh.vertices) x *= scale;
  use_file_material(table, node, what, *file, soft);
  if (table.find("shape") != nullptr)
    refuse(table.find("shape")->place, what + " has a shape and a volume file", "the volume's own boundary or a surface file is its surface", "remove shape");
  MeshPointer surface = table.find("surface") != nullptr ? read_outer_surface(table, what, scale, 1, files, body)
                                                         : checked_surface(boundary_of(soft.mesh), node, toml_string(node.string));
  soft.embedding = embed(soft.mesh, surface->mesh.vertices);
  // barycentric weights are distances in heights of the carrying tetrahedron
  if (soft.embedding.farthest > 0.0) {
    Aabb box{soft.mesh.vertices[0], soft.mesh.vertices[0]};
    for (const Vec3& x : soft.mesh.vertices) box.include(x);
    const double allowed = kMostOutside * (box.max - box.min).maxCoeff();
    for (std::size_t v = 0; v < surface->mesh.vertices.size(); ++v) {
      const Vec3 &x = surface->mesh.vertices[v], inside = x.cwiseMax(box.min).cwiseMin(box.max);
      if ((x - inside).norm() > allowed)
        refuse(node.place, fmt::format("{}: vertex {} of the surface lies {:.3g} m outside of the volume {}", what, v, (x - inside).norm(), toml_string(node.string)),
               "surface and volume must be in one frame and scale", "check that they belong together");
    }
  }
  body.shape = surface;
}

void read_volume(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files, SoftDescription& soft, BodyDescription& body) {
  const TomlEntry *entry = table.find("volume"), *shape = table.find("shape"), *surface = table.find("surface");
  const std::string name = what + ".volume";
  if (shape != nullptr && surface != nullptr) refuse(surface->place, what + " has a shape and a surface", "one of them is wanted", "remove one");
  if (entry == nullptr)
    refuse(table.place, what + " is deformable and has no volume", "a cage round its surface or a file of tetrahedra is wanted", "add volume = { cage = { cells = 12 } }");
  if (entry->value.kind == TomlNode::text) return read_volume_file(table, entry->value, what, scale, files, soft, body);
  const TomlNode& volume = scene_table(entry->value, name);
  check_keys(volume, name, {"cage", "lattice"});
  if (volume.entries.size() != 1)
    refuse(volume.place, fmt::format("{} names {} ways", name, volume.entries.size()), "a file name, or one of cage, lattice, is wanted", "keep one");
  const TomlEntry& way = volume.entries[0];
  const int cells = read_cells(scene_table(way.value, name + "." + way.key), name + "." + way.key);
  if (shape == nullptr && surface == nullptr)
    refuse(table.place, what + " has no surface", "surface = \"file\", or shape = { box or sphere }, is wanted", "add one");
  if (way.key == "lattice") {
    if (shape == nullptr || shape->value.find("box") == nullptr)
      refuse(way.place, name + " is a lattice of a body that is not a box", "shape = { box = { size } } has one", "use a cage");
    const Vec3 half = std::get<Box>(read_shape(shape->value, what + ".shape", scale)).half;
    const Eigen::Vector3i n = (half / half.maxCoeff() * cells).array().round().max(1.0).matrix().cast<int>();
    soft.mesh = make_tet_box(2.0 * half, n.x(), n.y(), n.z());
    for (Vec3& x : soft.mesh.vertices) x -= half;
    const MeshPointer boundary = checked_surface(boundary_of(soft.mesh), way.value, name);
    soft.embedding = embed(soft.mesh, boundary->mesh.vertices);
    body.shape = boundary;
    return;
  }
  const MeshPointer outer = read_outer_surface(table, what, scale, cells, files, body);
  TetCageSettings settings;
  settings.cells = cells;
  TetCage cage = make_tet_cage(outer->mesh, settings);
  soft.mesh = std::move(cage.mesh);
  soft.fraction = std::move(cage.fraction);
  soft.embedding = std::move(cage.embedding);
  body.shape = outer;
}

}  // namespace

void read_soft_body(const TomlNode& table, const std::string& what, double scale, SurfaceFiles& files, BodyDescription& body) {
  auto soft = std::make_shared<SoftDescription>();
  if (const TomlEntry* material = table.find("material")) read_elastic(material->value, what + ".material", *soft);
  if (const TomlEntry* fixed = table.find("fixed")) {
    const std::string name = what + ".fixed";
    if (fixed->value.kind == TomlNode::array)
      for (std::size_t i = 0; i < fixed->value.items.size(); ++i) soft->fixed.push_back(read_region(fixed->value.items[i], fmt::format("{}[{}]", name, i)));
    else
      soft->fixed.push_back(read_region(fixed->value, name));
  }
  read_volume(table, what, scale, files, *soft, body);
  const int nodes = static_cast<int>(soft->mesh.vertices.size());
  for (const NodeRegion& region : soft->fixed)
    for (const int i : region.nodes)
      if (i >= nodes)
        refuse(table.find("fixed")->place, fmt::format("{}.fixed names node {}", what, i), fmt::format("the body has nodes 0 to {}", nodes - 1), "correct it");
  if (body.mass) {
    double volume = 0.0;
    for (std::size_t t = 0; t < soft->mesh.tets.size(); ++t)
      volume += tet_volume(soft->mesh, soft->mesh.tets[t]) * (soft->fraction.empty() ? 1.0 : soft->fraction[t]);
    soft->density = *body.mass / volume;
    body.mass.reset();
  }
  body.soft = std::move(soft);
}

}  // namespace impinge
