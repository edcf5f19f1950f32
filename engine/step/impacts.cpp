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
constexpr double kLeastShare = 1e-5;    // of the sub-step: what closes sooner touches already
constexpr double kSoon = 0.1;           // of the time until the next impact: a cut so short before it brings nothing
constexpr std::size_t kFewBodies = 16;  // that are on their way: of more nobody looks at one pair's own edges
constexpr double kWorth = 0.1;          // of an impact's energy: what returns less may as well be braked
constexpr double kRounding = 1e-9;      // of the work that impulses do
constexpr double kWon = 1e-6;           // of the same: what friction and rebounds win together
constexpr double kNear = 1e-3;          // of that work, or of a rebound: how near to winning nothing is near enough
constexpr double kShy = 0.02;           // of the shares left: how far from their ends the next one is
constexpr double kRising = 1e-3;        // of the threshold of rebounds: what parts more slowly is rounding

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
  double free(const Collision& c) const { return c.normal.dot(free_slip(c)); }
  double solved(const Collision& c) const { return c.normal.dot(solved_slip(c)); }
  bool rebounds(const Collision& c, double threshold) const { return solved(c) > kRising * threshold; }
  double without(const Collision& c, std::span<const SolvedContact* const> of_pair) const {
    Twist a = solved_[c.body_a], b = solved_[c.body_b];
    for (const SolvedContact* other : of_pair) {
      const Vec3 impulse = contact_axes(other->collision.normal).transpose() * other->lambda;
      take(c.body_a, other->collision.acts_on_a(), -impulse, a);
      take(c.body_b, other->collision.acts_on_b(), impulse, b);
    }
    return c.normal.dot(between(c, a, b));
  }
  /// The first two as vectors.
  Vec3 free_slip(const Collision& c) const {
    return step_.colliders[c.body_a].velocity_at(c.acts_on_a()) - step_.colliders[c.body_b].velocity_at(c.acts_on_b());
  }
  Vec3 solved_slip(const Collision& c) const { return between(c, solved_[c.body_a], solved_[c.body_b]); }

 private:
  Vec3 between(const Collision& c, const Twist& a, const Twist& b) const {
    const auto at = [&](BodyIndex body, const Twist& t, const Vec3& x) {
      return Vec3(t.linear + t.angular.cross(x - step_.colliders[body].pose.position));
    };
    return at(c.body_a, a, c.acts_on_a()) - at(c.body_b, b, c.acts_on_b());
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

/// Of a group's impulses, J.
struct Work {
  double normal = 0.0, friction = 0.0, moved = 0.0;
  bool brakes = false;  ///< what free motion leaves open
  double all() const { return normal + friction; }
  /// Where nothing is braked, and friction takes as much as it should, a slow push of forces may add to a rebound.
  bool is_won(bool was_cut) const {
    return ((was_cut || brakes) && normal > kRounding * moved) || (friction > 0.0 && all() > kWon * moved);
  }
};

Work work_of(const Motion& motion, const GroupResult& result, PushOut push_out) {
  Work work;
  for (std::size_t i = 0; i < result.solved.size(); ++i) {
    const SolvedContact& c = result.solved[i];
    if (c.collision.gap < 0.0 && push_out != PushOut::split) continue;  // what velocities push out may
    const Mat3 axes = contact_axes(c.collision.normal);
    const bool is_flight = !result.slips.empty();
    const Vec3 before = is_flight ? result.slips[i].first : Vec3(axes * motion.free_slip(c.collision)),
               after = is_flight ? result.slips[i].second : Vec3(axes * motion.solved_slip(c.collision));
    const Vec3 done = 0.5 * c.lambda.cwiseProduct(before + after);
    work.normal += done.x(), work.friction += done.y() + done.z();
    work.moved += 0.5 * c.lambda.x() * (std::abs(before.x()) + std::abs(after.x()));
    work.brakes |= c.lambda.x() > 0.0 && before.x() >= 0.0;
  }
  return work;
}

/// What two that strike each other come upon of one another, as a box that lands on one edge comes down on the other: calls
/// `visit` where that is faster than they would come by themselves, with how fast, m/s.
template <class ThresholdOf, class Visit>
void visit_braked_beside(const Motion& motion, const std::vector<const SolvedContact*>& of_pair,
                         ThresholdOf&& threshold_of, Visit&& visit) {
  std::vector<const SolvedContact*> braked;
  for (const SolvedContact* c : of_pair)
    if (!motion.rebounds(c->collision, threshold_of(c->collision))) braked.push_back(c);
  if (braked.size() == of_pair.size()) return;
  for (const SolvedContact* c : braked) {
    const double by_itself = std::max(0.0, -motion.free(c->collision));
    const double approach = -motion.without(c->collision, braked);
    if (approach - by_itself > threshold_of(c->collision)) visit(c->collision, approach);
  }
}

/// Without a part that deforms, whose velocities aren't among those of a motion, and with a contact that rebounds.
bool may_win(const Bodies& bodies, const CollisionGroup& group, const GroupResult& result,
             const ContactSettings& settings) {
  const auto is_rigid = [&](BodyIndex b) { return bodies[b].kind() != BodyKind::deformable; };
  const auto rebounds = [&](const SolvedContact& c) {
    return c.lambda.x() > 0.0 &&
           is_worth_a_cut(pair_restitution(bodies[c.collision.body_a], bodies[c.collision.body_b], settings));
  };
  return std::all_of(group.bodies.begin(), group.bodies.end(), is_rigid) &&
         std::any_of(result.solved.begin(), result.solved.end(), rebounds);
}

}  // namespace

bool PassiveRebounds::weaken(const Bodies& bodies, SubStep& step, const ContactSettings& settings, bool was_cut) {
  bool is_anew = false;
  std::optional<Motion> motion;
  for (std::size_t g = 0; g < step.groups.size(); ++g) {
    const GroupResult& result = step.results[g];
    const auto known = groups_.find(step.groups[g].bodies.front());
    if (known == groups_.end() && !may_win(bodies, step.groups[g], result, settings)) continue;
    if (!motion) motion.emplace(bodies, step);
    const Work work = work_of(*motion, result, settings.push_out);
    if (known == groups_.end() && !work.is_won(was_cut)) continue;
    Search& search = groups_[step.groups[g].bodies.front()];
    if (search.left <= 0) {  // it is over, unless rows have come since that make it win again
      if (search.is_again || !work.is_won(was_cut)) continue;
      search = {0.0, search.share, 0.0, 0.0, search.share, kMotions, true};
    }
    if (work.is_won(was_cut))
      search.high = search.share, search.won = work.all();
    else
      search.low = search.share, search.taken = -work.all();
    --search.left;
    double next = 0.5 * (search.low + search.high);
    if (search.taken > 0.0) {  // a little less than where a line between the two crosses 0
      const double crossing = search.taken / (search.taken + search.won);
      next = search.low + std::clamp(crossing - kShy, kShy, 1.0 - kShy) * (search.high - search.low);
    }
    const bool is_over = search.left == 0 || (search.low > 0.0 && search.high - search.low < kNear) ||
                         (search.share == search.low && search.taken < kNear * work.moved);
    if (is_over) next = search.low, search.left = 0;
    if (next == search.share) continue;
    search.share = next;
    for (const SolvedContact& c : result.solved) step.rebounds[{c.collision.body_a, c.collision.body_b}] = next;
    is_anew = true;
  }
  return is_anew;
}

bool has_rebounds(const Bodies& bodies, const ContactSettings& settings) {
  for (const Body& b : bodies)
    if (!b.deleted && is_worth_a_cut(b.restitution.value_or(settings.restitution))) return true;
  return false;
}

std::optional<double> share_to_first_impact(const Bodies& bodies, const SubStep& step, const ContactSettings& settings,
                                            double gravity) {
  std::map<std::pair<BodyIndex, BodyIndex>, std::vector<const SolvedContact*>> pairs, idle;  // idle: without an impulse
  for (const GroupResult& result : step.results)
    for (const SolvedContact& c : result.solved) {
      const Body &a = bodies[c.collision.body_a], &b = bodies[c.collision.body_b];
      const bool is_rigid = a.kind() != BodyKind::deformable && b.kind() != BodyKind::deformable;
      if (is_rigid && is_worth_a_cut(pair_restitution(a, b, settings)))
        (c.lambda.x() > 0.0 ? pairs : idle)[{c.collision.body_a, c.collision.body_b}].push_back(&c);
    }
  // a cut is one of the whole scene: many bodies that land on their own would cut each other's sub-steps
  const bool looks_beside = bodies.active().size() <= kFewBodies;
  if (pairs.size() < (looks_beside ? 1 : 2)) return std::nullopt;  // one impact brakes nobody but its own two
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
  for (const auto& [pair, contacts] : pairs) {
    // they meet where the first of their gaps closes, whichever carries the blow: others close later or never
    double first = step.time_step;
    bool touches = false;
    const auto take_blow = [&](const SolvedContact& c) {
      const double threshold = threshold_of(c.collision), approach = -motion.free(c.collision);
      if (!(approach > threshold) || !motion.rebounds(c.collision, threshold)) return;
      touches |= (1.0 - kBefore) * c.collision.gap < least * approach;
      take_closing(c.collision, approach, first);
    };
    bool rebounds = false;
    for (const SolvedContact* c : contacts) {
      if (!motion.rebounds(c->collision, threshold_of(c->collision))) continue;
      rebounds = true;
      take_blow(*c);
    }
    if (!rebounds) continue;
    for (const BodyIndex b : {pair.first, pair.second})
      if (bodies[b].has_freedom()) struck.insert(b);
    if (const auto others = idle.find(pair); others != idle.end())
      for (const SolvedContact* c : others->second) take_blow(*c);
    if (!touches) first_blow = std::min(first_blow, first);
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
  for (const auto& [pair, contacts] : pairs)
    if (looks_beside)
      visit_braked_beside(motion, contacts, threshold_of,
                          [&](const Collision& c, double approach) { take_closing(c, approach, first_braked); });
  if (first_braked == step.time_step) return std::nullopt;
  // what rebounds has to arrive before it can strike anybody; what does so soon is as good as there
  const bool is_there = first_blow == step.time_step || first_blow < kSoon * first_braked;
  return (is_there ? first_braked : first_blow) / step.time_step;
}

}  // namespace impinge
