// The normal of every contact, from body B towards body A, of constant length on the screen.
#include "viewer/layers/all.hpp"

namespace impinge {
namespace {

void draw(const LayerContext& context, DrawList& list) {
  const std::vector<ContactRecord>& contacts = context.record.contacts;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    list.arrows.push_back({0.5 * (contacts[i].point_a + contacts[i].point_b), contacts[i].normal, role::kNormal,
                           static_cast<float>(context.settings.arrow_length), 1.5f * static_cast<float>(context.settings.line_width),
                           Depth::on_top, contact_pick(i)});
}

}  // namespace

Layer normals_layer() {
  return {"normals", "Contact normals, from body B towards body A.", false, draw, {{LegendRow::arrow, role::kNormal, "contact normal (B to A)"}}};
}

}  // namespace impinge
