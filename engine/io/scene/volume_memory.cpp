#include "engine/io/scene/volume_memory.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/tets/tet_cage.hpp"

namespace impinge {
namespace {

// A body's elements, patterns and matrices, with what is held twice while they are made, a tetrahedron. Measured from
// 40,000 to 6 million of them: 1,220 to 1,280 in lattices and cages.
constexpr double kPerTet = 1260.0;
constexpr double kPerTriangle = 150.0;  // of the surface carried: topology, embedding, two copies of the vertices

struct Extent {
  Vec3 size = Vec3::Zero();
  double area = 0.0, volume = 0.0;
};

Extent extent_of(const TriangleMesh& surface) {
  Extent extent;
  Aabb box;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    box.include(bounds_of(a, b, c));
    extent.area += 0.5 * (b - a).cross(c - a).norm();
  }
  extent.size = box.extent();
  extent.volume = signed_volume(surface);
  return extent;
}

}  // namespace

double deformable_memory(double tets, double triangles) { return kPerTet * tets + kPerTriangle * triangles; }

double cage_memory(const TriangleMesh& surface, int cells) {
  const Extent extent = extent_of(surface);
  const double cell = extent.size.maxCoeff() / cells, triangles = static_cast<double>(surface.triangles.size());
  // the lattice has a layer round the surface, each cell twelve tetrahedra, of which those inside stay and, of those
  // that the surface passes through, about five a square of a cell's side beyond its volume's share
  const Vec3 count = (extent.size / cell).array().ceil() + 2.0;
  const double lattice = 12.0 * count.prod();
  const double tets = std::min(lattice, 12.0 * extent.volume / std::pow(cell, 3) + 5.0 * extent.area / (cell * cell));
  // while it is made: marks, fractions and indices of the whole lattice; the rays along its shortest side and where
  // they cross the surface
  int axis = 0;
  extent.size.minCoeff(&axis);
  const double face = count[(axis + 1) % 3] * count[(axis + 2) % 3];
  const double rays =
      std::clamp(std::floor(std::sqrt(4e6 / face)), 4.0, static_cast<double>(TetCageSettings().rays_per_cell));
  const double spacing = cell / rays, crossings = 0.5 * extent.area / (spacing * spacing);
  const double making = 14.0 * lattice + 20.0 * face * rays * rays + 36.0 * crossings + 60.0 * tets;
  return std::max(making, deformable_memory(tets, triangles));
}

double tetrahedralize_memory(const TriangleMesh& surface, double max_size) {
  const Extent extent = extent_of(surface);
  // the longest edge is aimed at, so that a tetrahedron has far less than a regular one's 0.118 of its cube
  const double tets = 21.0 * extent.volume / std::pow(max_size, 3) + 9.0 * extent.area / (max_size * max_size);
  return deformable_memory(tets, static_cast<double>(surface.triangles.size()));
}

}  // namespace impinge
