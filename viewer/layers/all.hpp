// The layers' makers, one a file.
#pragma once

#include "viewer/layers/layer.hpp"

namespace impinge {

Layer meshes_layer();
Layer groups_layer();
Layer stress_layer();
Layer strain_layer();
Layer tetrahedra_layer();
Layer wireframe_layer();
Layer triangle_pairs_layer();
Layer aabbs_layer();
Layer broad_pairs_layer();
Layer gaps_layer();
Layer normals_layer();
Layer contact_forces_layer();
Layer velocities_layer();
Layer embedding_layer();
Layer fixed_nodes_layer();
Layer attachments_layer();
Layer mass_centers_layer();
Layer contacts_layer();
Layer labels_layer();

}  // namespace impinge
