#include "engine/step/integrate.hpp"

#include <fmt/format.h>

#include "engine/contact/recovery/free_recovery.hpp"
#include "engine/core/error.hpp"
#include "engine/step/tasks.hpp"

namespace impinge {
namespace {

void displace(Bodies& bodies, const SubStep& step) {
  for (GroupIndex g(0); g < step.groups.size(); ++g) {
    const std::vector<BodyIndex>& group = step.groups[g].bodies;
    const std::vector<BodyVector>& by = step.results[g].displacement;
    if (by.empty()) continue;
    if (const std::optional<double> taken = step.results[g].taken) {
      displace_floating(bodies, group, by, *taken);
      continue;
    }
    for (std::size_t i = 0; i < group.size(); ++i) bodies[group[i]].displace(by[i]);
  }
}

/// Bodies don't know their groups.
template <class Work>
void naming_group(const SubStep& step, BodyIndex body, Work&& work) {
  try {
    work();
  } catch (const DivergenceError& error) {
    throw DivergenceError(fmt::format("group {}, {}", step.group_of(body).value(), error.what()));
  }
}

}  // namespace

void change_velocities(Bodies& bodies, const SubStep& step) {
  for (GroupIndex g(0); g < step.groups.size(); ++g)
    for (std::size_t i = 0; i < step.groups[g].bodies.size(); ++i) {
      const GroupResult& result = step.results[g];
      const bool is_blow = !result.struck.empty() && result.struck[i] != 0;
      bodies[step.groups[g].bodies[i]].change_velocity(result.velocity[i], is_blow);
    }
}

void advance(Bodies& bodies, const TimeIntegration& how, const SubStep& step) {
  const double end = step.time + step.time_step;
  for_each_active(bodies, [&](BodyIndex b, Body& body) {
    if (!body.asleep && !body.deleted) naming_group(step, b, [&] { body.advance(how, end); });
  });
}

void push_out(Bodies& bodies, const SubStep& step) {
  displace(bodies, step);
  for_each_active(bodies, [&](BodyIndex b, Body& body) {
    if (!body.has_freedom() || body.asleep) return;
    naming_group(step, b, [&] { body.check_finite(); });
    body.update_world_vertices();
  });
}

}  // namespace impinge
