#include "engine/integrators/pull_spring.hpp"

namespace impinge {
namespace {

// of the diagonal of a consistent M: M is at least that, for it is so of each element (linear ones: 1/2)
constexpr double kConsistent = 0.25;
// of the mass at the point, that a pull may make use of in an explicit scheme: elements and contacts want the rest
constexpr double kExplicit = 0.25;

struct PointMotion {
  Vec3 at = Vec3::Zero(), velocity = Vec3::Zero();
};

/// Where the point is after Δq(v), and how it moves.
PointMotion motion_of(const DeformableBody& body, const DeformableStep& step, const VecX& v) {
  PointMotion motion;
  for (const auto& [node, weight] : body.nodes_of(body.pull->point)) {
    const Vec3 of_node = v.segment<3>(3 * node);
    motion.velocity += weight * of_node;
    motion.at +=
        weight * (Vec3(step.start.segment<3>(3 * node)) + step.s * of_node + Vec3(step.offset.segment<3>(3 * node)));
  }
  return motion;
}

void scatter(const DeformableBody& body, const Vec3& at_point, VecX& all) {
  for (const auto& [node, weight] : body.nodes_of(body.pull->point)) all.segment<3>(3 * node) += weight * at_point;
}

}  // namespace

Vec3 add_pull(const DeformableBody& body, const DeformableStep& step, const VecX& v, double factor, VecX& impulse) {
  if (!body.pull) return Vec3::Zero();
  const PointMotion motion = motion_of(body, step, v);
  const Vec3 own = step.acting() * body.pull->force(motion.at, motion.velocity);
  scatter(body, factor * own, impulse);
  return own;
}

double pull_potential(const DeformableBody& body, const DeformableStep& step, const VecX& v) {
  if (!body.pull) return 0.0;
  const PointMotion motion = motion_of(body, step, v);
  return 0.5 * step.acting() *
         (body.pull->stiffness / step.s * (body.pull->target - motion.at).squaredNorm() +
          body.pull->damping * motion.velocity.squaredNorm());
}

void add_pull_to_system(const DeformableBody& body, DeformableStep& step) {
  if (!body.pull) return;
  const double mass = step.acting() * (body.pull->damping + step.s * body.pull->stiffness);
  const std::array<NodeWeight, 4> nodes = body.nodes_of(body.pull->point);
  for (const auto& [i, weight_i] : nodes)
    for (const auto& [j, weight_j] : nodes) {
      const int row = body.free_index()[i], column = body.free_index()[j];
      if (row >= 0 && column >= 0)
        step.a.values[step.a.pattern->find(row, column)].diagonal().array() += mass * weight_i * weight_j;
    }
}

void add_limited_pull(const DeformableBody& body, const DeformableStep& step, VecX& impulse) {
  if (!body.pull) return;
  const bool is_lumped = body.fem.mass_kind() == MassKind::lumped;
  const auto mass_of = [&](int node) {
    return is_lumped ? body.fem.node_mass()[node]
                     : kConsistent * body.fem.block_mass()[body.fem.pattern()->diagonal[node]];
  };
  double mobility = 0.0;
  for (const auto& [node, weight] : body.nodes_of(body.pull->point))
    if (!body.is_held(node)) mobility += weight * weight / (kExplicit * mass_of(node));
  const PointMotion motion = motion_of(body, step, body.velocity);
  scatter(body,
          step.acting() / (1.0 + body.pull->mass(step.acting(), step.time_step) * mobility) *
              body.pull->force(motion.at, motion.velocity),
          impulse);
}

}  // namespace impinge
