#include "engine/world/finite_record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/world/ledger.hpp"

namespace impinge {
namespace {

struct Figure {
  const char* column;  ///< of stats.csv
  double (*value)(const FrameStats&);
  double (*share)(const Ledger&);  ///< what a body adds to it; null: it is no sum over bodies
};

constexpr Figure kFigures[] = {
    {"time_s", [](const FrameStats& s) { return s.time; }, nullptr},
    {"max_penetration_m", [](const FrameStats& s) { return s.max_penetration; }, nullptr},
    {"residual", [](const FrameStats& s) { return s.residual; }, nullptr},
    {"kinetic_J", [](const FrameStats& s) { return s.kinetic; }, [](const Ledger& l) { return l.kinetic; }},
    {"potential_J", [](const FrameStats& s) { return s.potential; }, [](const Ledger& l) { return l.potential; }},
    {"elastic_J", [](const FrameStats& s) { return s.elastic; }, [](const Ledger& l) { return l.elastic; }},
    {"momentum_x", [](const FrameStats& s) { return s.momentum.x(); }, [](const Ledger& l) { return l.momentum.x(); }},
    {"momentum_y", [](const FrameStats& s) { return s.momentum.y(); }, [](const Ledger& l) { return l.momentum.y(); }},
    {"momentum_z", [](const FrameStats& s) { return s.momentum.z(); }, [](const Ledger& l) { return l.momentum.z(); }},
    {"angular_momentum_x", [](const FrameStats& s) { return s.angular_momentum.x(); },
     [](const Ledger& l) { return l.angular_momentum.x(); }},
    {"angular_momentum_y", [](const FrameStats& s) { return s.angular_momentum.y(); },
     [](const Ledger& l) { return l.angular_momentum.y(); }},
    {"angular_momentum_z", [](const FrameStats& s) { return s.angular_momentum.z(); },
     [](const Ledger& l) { return l.angular_momentum.z(); }},
};

[[noreturn]] void refuse(const StepRecord& record, const std::string& body, const std::string& column, double value) {
  throw DivergenceError(
      fmt::format("frame {}{}: {} is {}, and every figure must be finite; use more sub-steps, or smaller velocities, "
                  "forces and masses",
                  record.stats.frame, body, column, value));
}

/// ", body 'NAME'" of the body whose own share is not finite.
std::string to_blame(const Figure& figure, const StepRecord& record, std::span<RigidBody> bodies) {
  if (figure.share == nullptr) return "";
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!std::isfinite(figure.share(make_ledger(bodies.subspan(b, 1), record.gravity))))
      return fmt::format(", body '{}'", bodies[b].name);
  return "";  // each is finite, their sum is not
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

void check_finite(const StepRecord& record, std::span<RigidBody> bodies) {
  for (const Figure& figure : kFigures)
    if (const double value = figure.value(record.stats); !std::isfinite(value))
      refuse(record, to_blame(figure, record, bodies), figure.column, value);
  for (const ContactRecord& contact : record.contacts) check_contact(record, contact);
}

}  // namespace impinge
