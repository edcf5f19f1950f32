// The equivalent strain on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) { draw_heat(context, list, HeatQuantity::strain); }

}  // namespace

Layer strain_layer() {
  return {"strain",
          "Surfaces of deformable bodies coloured by equivalent strain; the colour bar gives its range.",
          false,
          draw,
          {},
          HeatSettings{{0.0, 1e6, true}, "", "Strain of the brightest colour; 0 chooses by the frame's own strains."}};
}

}  // namespace impinge
