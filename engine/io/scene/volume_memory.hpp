// What making a deformable body's volume takes, before it is taken.
#pragma once

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

// All of them: most that is resident at once until the body stands in its world, bytes, measured by `impinge check`.

/// A body of so many tetrahedra that carries a surface of so many triangles.
double deformable_memory(double tets, double triangles);
/// A cage of `cells` round the surface, and the body.
double cage_memory(const TriangleMesh& surface, int cells);
/// Tetrahedra with edges of at most `max_size` metres that fill the surface, and the body; what the program that makes
/// them takes is taken by a process of its own, but of the same machine.
double tetrahedralize_memory(const TriangleMesh& surface, double max_size);

}  // namespace impinge
