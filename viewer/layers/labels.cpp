// The moving bodies' names, in their middle: above it a name would stand on the next body of a stack.
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) {
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    if (body.kind == BodyKind::fixed || body.bounds.is_empty()) continue;
    list.labels.push_back({body.bounds.center(), std::string(body.name), role::kInk, body_pick(i)});
  }
}

}  // namespace

Layer labels_layer() { return {"labels", "The names of dynamic and scripted bodies.", false, draw, {}}; }

}  // namespace impinge
