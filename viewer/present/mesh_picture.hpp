// A picture of a surface with its faults marked.
#pragma once

#include "engine/geometry/mend/mesh_facts.hpp"
#include "viewer/image/image.hpp"

namespace impinge {

/// From the front, above and to the right, so that all of it is seen. `title` stands over it, with what the marks mean.
Image mesh_picture(const MeshMarks& marks, const std::string& title, const std::vector<std::string>& lines, int width,
                   int height);

}  // namespace impinge
