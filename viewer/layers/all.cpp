#include "viewer/layers/all.hpp"

namespace impinge {

const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = {
      meshes_layer(),      groups_layer(),       stress_layer(),         strain_layer(),     tetrahedra_layer(),
      wireframe_layer(),   embedding_layer(),    triangle_pairs_layer(), aabbs_layer(),      broad_pairs_layer(),
      gaps_layer(),        normals_layer(),      contact_forces_layer(), velocities_layer(), fixed_nodes_layer(),
      attachments_layer(), mass_centers_layer(), contacts_layer(),       labels_layer(),
  };
  return all;
}

ViewSettings make_view_settings() {
  ViewSettings settings;
  for (const Layer& layer : layers())
    settings.layers.push_back({std::string(layer.name), std::string(layer.doc), layer.on});
  return settings;
}

}  // namespace impinge
