// The moving bodies' names, above them.
#include "viewer/layers/all.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) {
  for (const BodyRecord& body : context.record.bodies) {
    if (body.kind == BodyKind::fixed || body.bounds.is_empty()) continue;
    Vec3 top = body.bounds.center();
    top.y() = body.bounds.max.y();
    list.labels.push_back({top, std::string(body.name), role::kInk});
  }
}

}  // namespace

Layer labels_layer() { return {"labels", "The names of dynamic and scripted bodies.", false, draw, {}}; }

}  // namespace impinge
