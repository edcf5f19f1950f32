// The layers' makers, one a file.
#pragma once

#include "viewer/layers/layer.hpp"

namespace impinge {

Layer meshes_layer();
Layer aabbs_layer();
Layer contacts_layer();
Layer normals_layer();

}  // namespace impinge
