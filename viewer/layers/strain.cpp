// The strain on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_strain(const LayerContext& context, DrawList& list) {
  draw_heat(context, list, context.own<StrainSettings>().of);
}

}  // namespace

Layer strain_layer() {
  return {
      "strain",
      "Surfaces of deformable bodies coloured by equivalent strain or change of volume (view.strain.of); the colour "
      "bar gives its range.",
      false,
      draw_strain,
      {},
      StrainSettings{}};
}

}  // namespace impinge
