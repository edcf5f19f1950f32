// A polygon of a file as triangles.
#pragma once

#include <vector>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

/// The fan from the first corner where that lies in the polygon; of a concave one ears, which are cut off one by one
/// [Meisters75]. `corners` has at least three entries; those whose vertices are not known yet are fanned.
void append_polygon(const std::vector<int>& corners, const std::vector<Vec3>& vertices,
                    std::vector<Triangle>& triangles);

}  // namespace impinge
