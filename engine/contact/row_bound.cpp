#include "engine/contact/row_bound.hpp"

#include <algorithm>

namespace impinge {

double row_bound(const NormalMotion& c, const ContactSettings& settings, double h) {
  const bool split = settings.push_out == PushOut::split;
  const double bound =
      c.gap >= 0.0 ? -c.gap / h : (split ? 0.0 : std::min(-c.gap / h, settings.max_push_out.at(c.speed_scale)));
  const bool closes = c.gap + h * c.free_velocity < 0.0;
  if (!closes || c.restitution == 0.0 || c.velocity_before > -settings.restitution_threshold.at(c.speed_scale))
    return bound;
  return std::max(bound, -c.restitution * c.velocity_before + c.after);
}

}  // namespace impinge
