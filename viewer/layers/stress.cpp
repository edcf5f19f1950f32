// The stress on the surfaces of deformable bodies: of their tetrahedra, averaged at the nodes.
#include "viewer/layers/heat_map.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_stress(const LayerContext& context, DrawList& list) {
  draw_heat(context, list, context.own<StressSettings>().of);
}

}  // namespace

Layer stress_layer() {
  return {
      "stress",
      "Surfaces of deformable bodies coloured by von Mises or mean stress (view.stress.of); the colour bar gives its "
      "range.",
      false,
      draw_stress,
      {},
      StressSettings{}};
}

}  // namespace impinge
