// The equivalent strain on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/all.hpp"
#include "viewer/layers/heat_map.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) { draw_heat(context, list, HeatQuantity::strain); }

}  // namespace

Layer strain_layer() {
  return {"strain",
          "Surfaces of deformable bodies coloured by equivalent strain; the colour bar gives its range.",
          false,
          draw,
          {}};
}

}  // namespace impinge
