// The von Mises stress on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) { draw_heat(context, list, HeatQuantity::stress); }

}  // namespace

Layer stress_layer() {
  return {
      "stress",
      "Surfaces of deformable bodies coloured by von Mises stress; the colour bar gives its range.",
      false,
      draw,
      {},
      HeatSettings{{0.0, 1e15, true}, "Pa", "Stress of the brightest colour; 0 chooses by the frame's own stresses."}};
}

}  // namespace impinge
