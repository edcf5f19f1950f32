#include "engine/step/impacts.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "engine/bodies/rigid_body.hpp"
#include "engine/contact/contact_frame.hpp"
#include "engine/contact/pair_coefficients.hpp"
#include "engine/contact/pair_scale.hpp"

namespace impinge {
namespace {

constexpr double kBefore = 1e-9;  // of the way: how far from touching the cut is made, so that rounding decides nothing
constexpr double kLeastShare = 1e-5;  // of the sub-step: what closes sooner touches already
constexpr double kWorth = 0.1;        // of an impact's energy: what returns less may as well be braked
constexpr double kRounding = 1e-9;    // of the work that impulses do
constexpr double kRising = 1e-3;      // of the threshold of rebounds: what parts more slowly is rounding

/// Velocities of a step and what impulses make of them.
class Motion {
 public:
  Motion(const Bodies& bodies, const SubStep& step) : bodies_(bodies), step_(step), solved_(step.colliders.size()) {
    for (const BodyIndex b : bodies.active())
      solved_[b] = {step.colliders[b].velocity, step.colliders[b].angular_velocity};
    for (std::size_t g = 0; g < step.groups.size(); ++g)
      for (std::size_t i = 0; i < step.groups[g].bodies.size(); ++i) {
        const Twist& change = step.results[g].velocity[i].twist;
        Twist& twist = solved_[step.groups[g].bodies[i]];
        twist.linear += change.linear, twist.angular += change.angular;
      }
  }

  /// Of A's point from B's along the normal, m/s: by free velocities, by solved ones, and by those without what the two
  /// do to each other.
  double free(const Collision& c) const {
    return c.normal.dot(step_.colliders[c.body_a].velocity_at(c.common_point()) -
                        step_.colliders[c.body_b].velocity_at(c.common_point()));
  }
  double solved(const Collision& c) const { return along(c, solved_[c.body_a], solved_[c.body_b]); }
  bool rebounds(const Collision& c, double threshold) const { return solved(c) > kRising * threshold; }
  double without(const Collision& c, std::span<const SolvedContact* const> of_pair) const {
    Twist a = solved_[c.body_a], b = solved_[c.body_b];
    for (const SolvedContact* other : of_pair) {
      const Vec3 impulse = contact_axes(other->collision.normal).transpose() * other->lambda;
      take(c.body_a, other->collision.common_point(), -impulse, a);
      take(c.body_b, other->collision.common_point(), impulse, b);
    }
    return along(c, a, b);
  }

 private:
  double along(const Collision& c, const Twist& a, const Twist& b) const {
    const auto at = [&](BodyIndex body, const Twist& t) {
      return Vec3(t.linear + t.angular.cross(c.common_point() - step_.colliders[body].pose.position));
    };
    return c.normal.dot(at(c.body_a, a) - at(c.body_b, b));
  }
  void take(BodyIndex index, const Vec3& at, const Vec3& impulse, Twist& twist) const {
    const RigidBody* body = bodies_[index].as<RigidBody>();
    if (body == nullptr) return;
    const Pose& pose = step_.colliders[index].pose;
    twist.linear += impulse / body->mass;
    twist.angular +=
        pose.rotation * (body->inertia_inverse * (pose.rotation.transpose() * (at - pose.position).cross(impulse)));
  }

  const Bodies& bodies_;
  const SubStep& step_;
  std::vector<Twist> solved_;  // by body; zero of all that rest
};

bool is_worth_a_cut(double restitution) { return restitution * restitution >= kWorth; }

}  // namespace

bool wins_energy(const Bodies& bodies, const SubStep& step) {
  const Motion motion(bodies, step);
  double won = 0.0, moved = 0.0;  // J
  for (const GroupResult& result : step.results)
    for (const SolvedContact& c : result.solved) {
      if (c.collision.gap < 0.0) continue;  // what is pushed out may
      const double before = motion.free(c.collision), after = motion.solved(c.collision);
      won += 0.5 * c.lambda.x() * (before + after);
      moved += 0.5 * c.lambda.x() * (std::abs(before) + std::abs(after));
    }
  return won > kRounding * moved;
}

bool has_rebounds(const Bodies& bodies, const ContactSettings& settings) {
  for (const Body& b : bodies)
    if (!b.deleted && is_worth_a_cut(b.restitution.value_or(settings.restitution))) return true;
  return false;
}

std::optional<double> share_to_first_impact(const Bodies& bodies, const SubStep& step, const ContactSettings& settings,
                                            double gravity) {
  std::map<std::pair<BodyIndex, BodyIndex>, std::vector<const SolvedContact*>> pairs;
  for (const GroupResult& result : step.results)
    for (const SolvedContact& c : result.solved) {
      const Body &a = bodies[c.collision.body_a], &b = bodies[c.collision.body_b];
      const bool is_rigid = a.kind() != BodyKind::deformable && b.kind() != BodyKind::deformable;
      if (is_rigid && c.lambda.x() > 0.0 && is_worth_a_cut(pair_restitution(a, b, settings)))
        pairs[{c.collision.body_a, c.collision.body_b}].push_back(&c);
    }
  if (pairs.size() < 2) return std::nullopt;  // one impact brakes nobody but its own two
  const Motion motion(bodies, step);
  const double least = kLeastShare * step.time_step;
  const auto threshold_of = [&](const Collision& c) {
    return settings.restitution_threshold.at(pair_scale(bodies[c.body_a], bodies[c.body_b], gravity).speed);
  };
  double first_blow = step.time_step, first_braked = step.time_step;  // s
  const auto take_closing = [&](const Collision& c, double approach, double& first) {
    if (!(c.gap > 0.0 && approach > threshold_of(c))) return;
    const double time = (1.0 - kBefore) * c.gap / approach;
    if (time >= least) first = std::min(first, time);
  };
  std::set<BodyIndex> struck;
  for (const auto& [pair, contacts] : pairs)
    for (const SolvedContact* c : contacts) {
      if (!motion.rebounds(c->collision, threshold_of(c->collision))) continue;
      for (const BodyIndex b : {pair.first, pair.second})
        if (bodies[b].has_freedom()) struck.insert(b);
      take_closing(c->collision, -motion.free(c->collision), first_blow);
    }
  // what a body that was struck comes upon; and not what its weight alone would press on
  for (const auto& [pair, contacts] : pairs) {
    if (!struck.contains(pair.first) && !struck.contains(pair.second)) continue;
    for (const SolvedContact* c : contacts) {
      if (motion.rebounds(c->collision, threshold_of(c->collision))) continue;
      const double by_itself = std::max(0.0, -motion.free(c->collision));
      const double approach = -motion.without(c->collision, contacts);
      if (approach - by_itself > threshold_of(c->collision)) take_closing(c->collision, approach, first_braked);
    }
  }
  if (first_braked == step.time_step) return std::nullopt;
  // what rebounds has to arrive before it can strike anybody
  return (first_blow < step.time_step ? first_blow : first_braked) / step.time_step;
}

}  // namespace impinge
