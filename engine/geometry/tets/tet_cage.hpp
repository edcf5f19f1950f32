// A cage of tetrahedra round a closed surface: a body-centred cubic lattice, cut down to what the surface touches or
// encloses.
//
// It takes any closed surface, however detailed, in seconds; every tetrahedron has the same good shape (dihedral angles
// of 60 and 90 degrees); and the surface is carried at its full resolution. The price: the cage is coarser than the
// surface, so each tetrahedron knows how much of it is filled, and parts of the surface that come closer than a cell
// are glued together.
#pragma once

#include <functional>

#include "engine/geometry/tets/embedding.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct TetCageSettings {
  int cells = 12;  ///< cubic cells along the surface's longest side, >= 1
  int rays_per_cell =
      64;  ///< per cell edge, for filled fractions; lowered where there would be more than 4 million rays
  /// Whether a point is inside, where the surface is not closed enough for rays: asked at 56 points of each tetrahedron
  /// that the surface touches, and in the middle of the others. Called from many threads.
  std::function<bool(const Vec3&)> is_inside = {};
  double smallest_fraction = 0.02;  ///< floor of the fraction, so that no node is left without mass and stiffness
};

struct TetCage {
  TetMesh mesh;                  ///< in the surface's coordinates
  std::vector<double> fraction;  ///< filled fraction of each tetrahedron, in [smallest_fraction, 1]
  Embedding embedding;           ///< of the surface's vertices; none is outside
  double cell_size = 0.0;        ///< m
  double filled_volume =
      0.0;               ///< Σ fraction · volume before the floor: the surface's own volume, to sampling error, m³
  int dropped_rays = 0;  ///< see RayColumns
};

/// surface: closed, oriented outwards, welded (check_mesh finds no problem; self-intersections are allowed); any if the
/// settings say what is inside.
/// Fractions are sampled by parallel rays, exact along each: with 64 rays a cell edge the error of a fraction is below
/// 0.015 (0.003 root mean square), that of the volume about 1e-4 (tests/unit/geometry/tet_cage.cpp). A tetrahedron that the
/// surface doesn't touch has exactly 1.
TetCage make_tet_cage(const TriangleMesh& surface, const TetCageSettings& settings);

}  // namespace impinge
