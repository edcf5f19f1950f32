// The von Mises stress on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/all.hpp"
#include "viewer/layers/heat_map.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) { draw_heat(context, list, HeatQuantity::stress); }

}  // namespace

Layer stress_layer() {
  return {"stress",
          "Surfaces of deformable bodies coloured by von Mises stress; the colour bar gives its range.",
          false,
          draw,
          {}};
}

}  // namespace impinge
