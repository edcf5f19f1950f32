// Tetrahedra and deformations for tests of materials.
#pragma once

#include "engine/geometry/tets/tet_mesh.hpp"
#include "engine/materials/material.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

struct Element {
  TetRest rest;
  Corners corners;  ///< at rest

  /// Corners after x ↦ F x.
  Corners deformed(const Mat3& f) const { return f * corners; }
};

/// An irregular tetrahedron about `size` large.
inline Element random_element(Random& random, double size = 0.1) {
  for (;;) {
    Element e;
    for (int k = 0; k < 4; ++k) e.corners.col(k) = size * random.vector();
    const Vec3 a = e.corners.col(0), b = e.corners.col(1), c = e.corners.col(2), d = e.corners.col(3);
    if (tet_volume(a, b, c, d) < 0.05 * size * size * size) continue;
    e.rest = make_tet_rest(a, b, c, d);
    return e;
  }
}

inline std::unique_ptr<Material> make_material(std::string_view name, double young = 1e5, double poisson = 0.4,
                                               Tangent tangent = Tangent::automatic) {
  std::unique_ptr<Material> material = find_entry(materials(), name)->make();
  MaterialSettings settings;
  settings.young = young;
  settings.poisson = poisson;
  settings.tangent = tangent;
  material->settings() = settings;
  return material;
}

/// U diag(stretch) Vᵀ with random rotations.
inline Mat3 stretched(Random& random, const Vec3& stretch) {
  const Mat3 u = random.rotation();
  return u * stretch.asDiagonal() * random.rotation().transpose();
}

}  // namespace impinge::test
