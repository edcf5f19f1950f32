// The normal of every contact, from body B towards body A, of constant length on the screen; fainter where it is open.
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

void draw_normals(const LayerContext& context, DrawList& list) {
  const std::vector<ContactRecord>& contacts = context.record.contacts;
  const float length = static_cast<float>(context.settings.arrow_length),
              width = 1.5f * static_cast<float>(context.settings.line_width);
  for (const bool open : {true, false})  // those that carry something lie over the many that are merely near
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if ((contacts[i].state == ContactState::open) == open)
        list.arrows.push_back({0.5 * (contacts[i].point_a + contacts[i].point_b), contacts[i].normal,
                               open ? with_alpha(role::kNormal, 0.55f) : role::kNormal, (open ? 0.65f : 1.0f) * length,
                               (open ? 0.7f : 1.0f) * width, Depth::on_top, contact_pick(i)});
}

}  // namespace

Layer normals_layer() {
  return {"normals",
          "Contact normals, from body B towards body A.",
          false,
          draw_normals,
          {{LegendRow::arrow, role::kNormal, "contact normal (B to A)"}}};
}

}  // namespace impinge
