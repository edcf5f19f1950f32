// The bodies' names, in their middle: above it a name would stand on the next body of a stack. In a pale shade of the
// body's colour: whose body is hidden has its name on the one in front.
#include <algorithm>

#include "viewer/layers/body_style.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr float kPale = 0.45f;

struct LabelSettings {
  bool fixed = false;

  void declare(const Rows& rows) { rows.add("static", fixed, "Static bodies too, not only those that are selected."); }
};

void draw_labels(const LayerContext& context, DrawList& list) {
  const std::vector<std::string>& selected = context.settings.selected;
  const std::vector<Color> colors = body_colors(context.record, context.settings.colors);
  for (std::size_t i = 0; i < context.record.bodies.size(); ++i) {
    const BodyRecord& body = context.record.bodies[i];
    const bool is_selected = std::find(selected.begin(), selected.end(), body.name) != selected.end();
    if (body.kind == BodyKind::fixed && !context.own<LabelSettings>().fixed && !is_selected) continue;
    if (body.bounds.is_empty() || !body.bounds.extent().allFinite()) continue;
    list.labels.push_back(
        {body.bounds.center(), std::string(body.name), mix(colors[i], role::kInk, kPale), body_pick(i)});
  }
}

}  // namespace

Layer labels_layer() {
  return {"labels",
          "The names of dynamic and scripted bodies, of what is selected, and of static ones (view.labels.static).",
          false,
          draw_labels,
          {},
          LabelSettings{}};
}

}  // namespace impinge
