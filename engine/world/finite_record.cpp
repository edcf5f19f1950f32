#include "engine/world/finite_record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/world/figures.hpp"

namespace impinge {
namespace {

[[noreturn]] void refuse(const StepRecord& record, const std::string& body, const std::string& column, double value) {
  throw DivergenceError(
      fmt::format("frame {}{}: {} is {}, and every figure must be finite; use more sub-steps, or smaller velocities, "
                  "forces and masses",
                  record.stats.frame, body, column, value));
}

/// ", body 'NAME'" of the body whose own share is not finite.
std::string to_blame(const Figure& figure, const StepRecord& record, Bodies& bodies) {
  for (Body& body : bodies) {
    FrameStats own;
    own.take(body.balance(record.gravity));
    if (!std::isfinite(figure.value(own))) return fmt::format(", body '{}'", body.name);
  }
  return "";  // each is finite, their sum is not; or it is no sum over bodies
}

void check_contact(const StepRecord& record, const ContactRecord& c) {
  const BodyRecord *own = &record.bodies[static_cast<std::size_t>(c.body_a)],
                   *other = &record.bodies[static_cast<std::size_t>(c.body_b)];
  if (own->mass == 0.0) std::swap(own, other);  // what can't move is not to blame
  const auto check = [&](const char* column, double value) {
    if (!std::isfinite(value))
      refuse(record, fmt::format(", body '{}'", own->name),
             fmt::format("{} of a contact with '{}'", column, other->name), value);
  };
  const auto check_vector = [&](std::array<const char*, 3> columns, const Vec3& value) {
    for (int k = 0; k < 3; ++k) check(columns[static_cast<std::size_t>(k)], value[k]);
  };
  check_vector({"pa_x", "pa_y", "pa_z"}, c.point_a);
  check_vector({"pb_x", "pb_y", "pb_z"}, c.point_b);
  check_vector({"n_x", "n_y", "n_z"}, c.normal);
  check("gap_m", c.gap), check("gap0_m", c.gap0);
  check_vector({"lambda_n", "lambda_t1", "lambda_t2"}, c.lambda);
  check("mu", c.friction);
}

}  // namespace

void check_finite(const StepRecord& record, Bodies& bodies) {
  if (const Figure* figure = first_not_finite(record.stats, false))
    refuse(record, to_blame(*figure, record, bodies), std::string(figure->name), figure->value(record.stats));
  for (const ContactRecord& contact : record.contacts) check_contact(record, contact);
}

}  // namespace impinge
