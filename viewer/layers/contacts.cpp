// Contact points by what they do.
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

Color color_of(ContactState state) {
  switch (state) {
    case ContactState::stick:
      return role::kStick;
    case ContactState::slip:
      return role::kSlip;
    default:
      return role::kOpen;
  }
}

void draw(const LayerContext& context, DrawList& list) {
  const std::vector<ContactRecord>& contacts = context.record.contacts;
  const float size = static_cast<float>(context.settings.point_size);
  // those that carry something lie over the many that are merely near, and are larger
  for (const ContactState state : {ContactState::open, ContactState::stick, ContactState::slip})
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (contacts[i].state == state)
        list.points.push_back({0.5 * (contacts[i].point_a + contacts[i].point_b), color_of(state),
                               (state == ContactState::open ? 0.65f : 1.0f) * size, Depth::on_top, contact_pick(i)});
}

}  // namespace

Layer contacts_layer() {
  return {"contacts",
          "Contact points: open, sticking, slipping.",
          true,
          draw,
          {{LegendRow::point, role::kOpen, "contact, open"},
           {LegendRow::point, role::kStick, "contact, sticks"},
           {LegendRow::point, role::kSlip, "contact, slips"}}};
}

}  // namespace impinge
