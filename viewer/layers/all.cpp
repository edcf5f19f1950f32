// The list of layers in the order they are drawn: one line each.
#include "engine/core/registry.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {

const std::vector<Layer>& layers() {
  static const std::vector<Layer> list = [] {
    std::vector<Layer> all;
    IMPINGE_LIST(all, meshes_layer);
    IMPINGE_LIST(all, groups_layer);
    IMPINGE_LIST(all, stress_layer);
    IMPINGE_LIST(all, strain_layer);
    IMPINGE_LIST(all, heat_layer);
    IMPINGE_LIST(all, tetrahedra_layer);
    IMPINGE_LIST(all, wireframe_layer);
    IMPINGE_LIST(all, embedding_layer);
    IMPINGE_LIST(all, triangle_pairs_layer);
    IMPINGE_LIST(all, aabbs_layer);
    IMPINGE_LIST(all, broad_pairs_layer);
    IMPINGE_LIST(all, gaps_layer);
    IMPINGE_LIST(all, normals_layer);
    IMPINGE_LIST(all, contact_forces_layer);
    IMPINGE_LIST(all, velocities_layer);
    IMPINGE_LIST(all, fixed_nodes_layer);
    IMPINGE_LIST(all, attachments_layer);
    IMPINGE_LIST(all, mass_centers_layer);
    IMPINGE_LIST(all, contacts_layer);
    IMPINGE_LIST(all, pulls_layer);
    IMPINGE_LIST(all, labels_layer);
    return all;
  }();
  return list;
}

ViewSettings make_view_settings() {
  ViewSettings settings;
  for (const Layer& layer : layers())
    settings.layers.push_back({std::string(layer.name), std::string(layer.doc), layer.on, layer.settings});
  return settings;
}

}  // namespace impinge
