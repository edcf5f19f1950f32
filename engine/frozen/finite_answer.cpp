#include "engine/frozen/finite_answer.hpp"

#include <fmt/format.h>

#include <cmath>

namespace impinge {
namespace {

std::string body_name(const FrozenStep& step, int b) {
  return b < 0 ? std::string("world") : step.bodies[static_cast<std::size_t>(b)];
}

/// Of a contact's bodies one that moves.
int mover(const FrozenGroup& group, std::size_t contact) {
  const FrozenContact& at = group.geometry[contact];
  const ContactSide& a = group.system.contacts[contact].a;
  return a.rigid >= 0 || a.deformable >= 0 ? at.body_a : at.body_b;
}

/// The first figure of an answer that is no number, with the body it belongs to; "" where all are finite.
std::string first_not_finite(const FrozenStep& step, const std::vector<GroupAnswer>& answers) {
  const auto name = [&](int b) { return body_name(step, b); };
  constexpr const char* kRows[] = {"r_n", "r_t1", "r_t2"};
  std::size_t first = 0;
  for (std::size_t g = 0; g < answers.size(); ++g) {
    const GroupAnswer& answer = answers[g];
    const FrozenGroup& group = step.groups[g];
    for (std::size_t i = 0; i < answer.lambda.size(); ++i)
      for (int d = 0; d < 3; ++d)
        if (!std::isfinite(answer.lambda[i][d]))
          return fmt::format("body '{}': {} of contact {}", name(mover(group, i)), kRows[d], first + i);
    for (std::size_t b = 0; b < answer.delta_velocity.size(); ++b)
      if (!answer.delta_velocity[b].allFinite() || !answer.delta_angular_velocity[b].allFinite())
        return fmt::format("body '{}': its change of velocity", name(group.rigid_bodies[b]));
    for (std::size_t b = 0; b < answer.deformable_delta.size(); ++b)
      if (!answer.deformable_delta[b].allFinite())
        return fmt::format("body '{}': its change of velocity", name(group.deformable_bodies[b]));
    first += answer.lambda.size();
  }
  return "";
}

}  // namespace

std::string not_finite(const FrozenStep& step, const std::vector<GroupAnswer>& answers, const FrozenVerdict& verdict) {
  if (std::string where = first_not_finite(step, answers); !where.empty()) return where + " is not finite";
  if (std::isfinite(verdict.residual)) return "";
  int i = verdict.worst;
  for (const FrozenGroup& group : step.groups) {
    if (i >= 0 && i < static_cast<int>(group.geometry.size()))
      return fmt::format("body '{}': residual at contact {} is not finite", body_name(step, mover(group, i)),
                         verdict.worst);
    i -= static_cast<int>(group.geometry.size());
  }
  return "residual is not finite";
}

}  // namespace impinge
