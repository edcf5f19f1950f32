// Contact points by what they do: coloured by state or by a quantity, as large as each other or by what they carry.
#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/draw/color_map.hpp"
#include "viewer/layers/contact_measures.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {
namespace {

constexpr double kRoom = 0.1, kSpread = 0.5;           // of a body's size: a mark, and what all on a line may cover
constexpr float kLeastSize = 0.35f, kMostSize = 3.0f;  // times view.point_size

enum class ContactColor { state, gap, impulse, slip, residual };
enum class Size { same, force };

struct ContactMarkSettings {
  bool carrying = false, of_selected = false;
  Size size = Size::same;
  ContactColor color = ContactColor::state;
  ScaleSettings colors;

  void declare(const Rows& rows) {
    rows.add("carrying", carrying, "Only contacts that carry something.");
    rows.add("of_selected", of_selected, "Only contacts of the bodies selected in the debugger, if any are.");
    rows.add(
        "size", size, {{Size::same, "same"}, {Size::force, "force"}},
        "Discs of one size, or with areas like their normal forces: view.point_size is the mean one's; from 0.35 to 3 "
        "times that.");
    rows.add(
        "color", color,
        {{ContactColor::state, "state"},
         {ContactColor::gap, "gap"},
         {ContactColor::impulse, "impulse"},
         {ContactColor::slip, "slip"},
         {ContactColor::residual, "residual"}},
        "What colours mean: the state; how deep the bodies overlap (m); the normal impulse (N s); the speed at "
        "which the two points slide along each other (m/s); how far the answer is from Coulomb's law (relative, as "
        "residual_coulomb).");
    colors.declare(rows, 1e15, "");
  }
};

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

ContactMeasure measure_of_color(ContactColor what) {
  if (what == ContactColor::gap) return ContactMeasure::overlap;
  if (what == ContactColor::residual) return ContactMeasure::residual;
  return what == ContactColor::impulse ? ContactMeasure::impulse : ContactMeasure::slip;
}

/// Which are drawn, those that carry something last: they lie over the many that are merely near.
std::vector<std::size_t> drawn(const LayerContext& context, const ContactMarkSettings& own) {
  const std::vector<ContactRecord>& contacts = context.record.contacts;
  const std::vector<std::string>& selected = context.settings.selected;
  const auto is_selected = [&](BodyIndex b) {
    const std::string_view name = context.record.bodies[static_cast<std::size_t>(b.value())].name;
    return std::find(selected.begin(), selected.end(), name) != selected.end();
  };
  // of a selected contact its pair; of a body all that touch it
  const auto is_wanted = [&](const ContactRecord& c) {
    if (!own.of_selected || selected.empty()) return true;
    return selected.size() == 1 ? is_selected(c.body_a) || is_selected(c.body_b)
                                : is_selected(c.body_a) && is_selected(c.body_b);
  };
  std::vector<std::size_t> order;
  for (const ContactState state : {ContactState::open, ContactState::stick, ContactState::slip})
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (contacts[i].state == state && (!own.carrying || contacts[i].lambda.x() > 0.0) && is_wanted(contacts[i]))
        order.push_back(i);
  return order;
}

/// How large marks may be that leave a body to be seen, by body: a tenth of its size, less where it has many. Areas that
/// are like forces are left alone.
std::vector<double> room_on_bodies(const StepRecord& record, const std::vector<std::size_t>& order) {
  std::vector<int> count(record.bodies.size(), 0);
  for (const std::size_t i : order)
    for (const BodyIndex b : {record.contacts[i].body_a, record.contacts[i].body_b})
      ++count[static_cast<std::size_t>(b.value())];
  std::vector<double> room(record.bodies.size(), std::numeric_limits<double>::infinity());
  for (std::size_t b = 0; b < room.size(); ++b) {
    const BodyRecord& body = record.bodies[b];
    if (count[b] == 0 || body.kind == BodyKind::fixed) continue;
    const double size = body.bounds.extent().norm() / std::sqrt(3.0);
    room[b] = size * std::min(kRoom, kSpread / std::sqrt(static_cast<double>(count[b])));
  }
  return room;
}

/// What a disc stands for, in a round force.
void add_disc_scale(const LayerContext& context, double mean_impulse, DrawList& list) {
  const double step = context.record.frame_time / std::max(1, context.record.stats.substeps),
               mean = mean_impulse / step;
  if (!std::isfinite(mean)) return;
  const double value = rounded_up(mean);
  list.scales.push_back({context.layer, role::kInk, value, "N",
                         static_cast<float>(std::sqrt(value / mean) * context.settings.point_size)});
}

void draw_contacts(const LayerContext& context, DrawList& list) {
  const StepRecord& record = context.record;
  const ContactMarkSettings& own = context.own<ContactMarkSettings>();
  const std::vector<std::size_t> order = drawn(context, own);
  const bool by_state = own.color == ContactColor::state;
  const ContactMeasure measure = measure_of_color(own.color);
  double sum = 0.0, most = 0.0;
  int carrying = 0;
  for (const std::size_t i : order) {
    const double force = std::max(0.0, record.contacts[i].lambda.x());
    sum += force, carrying += force > 0.0;
    if (!by_state) most = std::max(most, measure_of(record, record.contacts[i], measure));
  }
  const double mean = carrying > 0 ? sum / carrying : 0.0;
  const ColorScale scale = own.colors.scale(std::max(most, least_shown(record, measure)), false);
  ColorBar bar = bar_of(measure, scale, context.settings.color_map);
  const auto size_of = [&](const ContactRecord& c) {
    if (own.size == Size::same) return c.state == ContactState::open ? 0.65f : 1.0f;
    if (!(mean > 0.0)) return kLeastSize;
    return std::clamp(static_cast<float>(std::sqrt(std::max(0.0, c.lambda.x()) / mean)), kLeastSize, kMostSize);
  };
  const std::vector<double> room = room_on_bodies(record, order);
  for (const std::size_t i : order) {
    const ContactRecord& c = record.contacts[i];
    const double free =
        std::min(room[static_cast<std::size_t>(c.body_a.value())], room[static_cast<std::size_t>(c.body_b.value())]);
    const Color color = by_state ? color_of(c.state) : heat_color(bar.place(measure_of(record, c, measure)), bar.map);
    list.points.push_back({0.5 * (c.point_a + c.point_b), color,
                           size_of(c) * static_cast<float>(context.settings.point_size), Depth::on_top, contact_pick(i),
                           own.size == Size::same && std::isfinite(free) ? size_of(c) * free : 0.0});
  }
  if (!by_state && !order.empty()) list.color_bars.push_back(bar);
  if (own.size == Size::force && mean > 0.0) add_disc_scale(context, mean, list);
}

bool carries_something(const StepRecord& record) {
  return std::any_of(record.contacts.begin(), record.contacts.end(),
                     [](const ContactRecord& c) { return c.lambda.x() > 0.0; });
}

bool shows_forces(const ViewSettings& settings) {
  return settings.of_layer<ContactMarkSettings>("contacts").size == Size::force;
}

bool shows_states(const ViewSettings& settings) {
  return settings.of_layer<ContactMarkSettings>("contacts").color == ContactColor::state;
}

}  // namespace

Layer contacts_layer() {
  return {"contacts",
          "Contact points: open, sticking, or with friction at its limit, where they slip or are about to.",
          true,
          draw_contacts,
          {{LegendRow::point, role::kOpen, "contact, open", nullptr, shows_states},
           {LegendRow::point, role::kStick, "contact, sticks", nullptr, shows_states},
           {LegendRow::point, role::kSlip, "contact, may slip", nullptr, shows_states},
           {LegendRow::disc, role::kInk, "normal force of {}", carries_something, shows_forces}},
          ContactMarkSettings{}};
}

}  // namespace impinge
