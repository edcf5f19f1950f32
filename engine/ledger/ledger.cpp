#include "engine/ledger/ledger.hpp"

#include <cmath>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/rigid_body.hpp"
#include "engine/step/act.hpp"
#include "engine/step/tasks.hpp"

namespace impinge {
namespace {

LedgerEntry& of(std::array<LedgerEntry, kLedgerSources>& entries, LedgerSource source) {
  return entries[static_cast<std::size_t>(source)];
}

double spin_energy(const RigidBody& body, const Mat3& rotation, const Vec3& spin) {
  const Vec3 own = rotation.transpose() * spin;
  return 0.5 * own.dot(body.inertia_inverse * own);
}

Balance change(const Balance& before, const Balance& after) {
  return {after.kinetic - before.kinetic, after.elastic - before.elastic, after.potential - before.potential,
          after.momentum - before.momentum, after.angular_momentum - before.angular_momentum};
}

/// A v − b of the open sub-step. Newton iterations that ended at their cap have A and b of another v than their last.
VecX missing_of(DeformableBody& soft, const TimeIntegration& how, bool is_elsewhere) {
  const DeformableStep& step = soft.open_step();
  if (!is_elsewhere) return step.a * step.v_star - step.b;
  DeformableStep again = step;
  how.integrator.linearize(soft, again.v_star, again);
  return again.a * again.v_star - again.b;
}

/// Of impulses on nodes that stand at `places` and move at `mean`.
LedgerEntry entry_of_nodes(const VecX& impulse, const VecX& mean, const VecX& places) {
  LedgerEntry entry;
  entry.motion = dot(impulse, mean);
  for (Eigen::Index i = 0; i + 2 < impulse.size(); i += 3) {
    const Vec3 p = impulse.segment<3>(i), x = places.segment<3>(i);
    entry.momentum += p;
    entry.angular_momentum += x.cross(p);
  }
  return entry;
}

/// What a velocity gains, or loses again, by being led on: before the motion, at the nodes' places there.
void take_lead(const DeformableBody& soft, double sign, LedgerEntry& entry) {
  if (soft.lead().size() == 0) return;
  VecX momentum;
  soft.fem.multiply_mass(sign * soft.lead(), momentum);
  entry += entry_of_nodes(momentum, soft.velocity - 0.5 * sign * soft.lead(), soft.open_step().start);
}

}  // namespace

Balance Ledger::measured(Body& body) const { return body.has_freedom() ? body.balance(gravity_) : Balance(); }

void Ledger::know(Body& body, Known& known) const {
  known.pose = body.pose;
  known.twist = body.twist();
  if (const RigidBody* rigid = body.as<RigidBody>()) known.spin = rigid->angular_momentum;
  if (const DeformableBody* soft = body.as<DeformableBody>()) known.nodes = soft->position;
}

/// Between frames, beside what acts did.
void Ledger::take_parameters(const Balance& before, const Balance& now, BodyLedger& books) const {
  const Balance done = change(books.rise, change(before, now));
  books[LedgerSource::script] += {done.kinetic, done.potential + done.elastic, done.momentum, done.angular_momentum};
  books.rise += done;
}

void Ledger::open_frame(Bodies& bodies, const Vec3& gravity, std::span<const Balance> before) {
  gravity_ = gravity;
  const auto n = static_cast<std::size_t>(bodies.size().value());
  frame_ = {};
  frame_.bodies = std::move(acts_);
  frame_.bodies.resize(n);  // bodies that come later may have been announced since
  acts_ = {};
  begin_.assign(n, {});
  elastic_.assign(n, 0.0);
  known_.resize(n);
  pull_.assign(n, Vec3::Zero());
  flight_.assign(n, std::nullopt);
  motion_.assign(n, {});
  substep_.assign(n, {});
  largest_.assign(n, {});
  before_rest_.assign(n, {});
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    begin_[b] = measured(body);
    elastic_[b] = begin_[b].elastic;
    if (body.has_freedom() && static_cast<std::size_t>(b.value()) < before.size())
      take_parameters(before[static_cast<std::size_t>(b.value())], begin_[b], frame_.bodies[b]);
  });
}

void Ledger::open_motion(Bodies& bodies) {
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    motion_[b] = {};
    pull_[b].setZero();
    flight_[b].reset();
    if (!body.has_freedom()) return;
    know(body, known_[b]);
    known_[b].elastic = elastic_[b];
  });
}

/// The pull's force where the free velocity leads: that is what the implicit spring solved for.
void Ledger::freed(const Bodies& bodies, const TimeIntegration& how) {
  for (BodyIndex b(0); b < bodies.size(); ++b) {
    const RigidBody* body = bodies[b].as<RigidBody>();
    if (body == nullptr || !body->pull || body->deleted || body->asleep) continue;
    const Vec3 at = body->position_of(body->pull->point);
    const Vec3 velocity = body->velocity + body->angular_velocity().cross(at - body->pose.position);
    pull_[b] = body->kick * body->pull->force(at + how.time_step * velocity, velocity);
  }
}

LedgerEntry Ledger::rigid_entry(BodyIndex index, const Vec3& impulse, const Vec3& torque) const {
  const Known& k = known_[index];
  return {impulse.dot(k.mean.linear) + torque.dot(k.mean.angular), 0.0, impulse,
          Vec3(k.pose.position.cross(impulse) + torque)};
}

LedgerEntry Ledger::node_entry(BodyIndex index, const VecX& impulse) const {
  return entry_of_nodes(impulse, known_[index].node_mean, known_[index].nodes);
}

LedgerEntry Ledger::side_entry(BodyIndex index, const Body& body, const ContactSide& side, const Vec3& way,
                               const Vec3& impulse) {
  if (side.rigid >= 0) {
    LedgerEntry entry = rigid_entry(index, impulse, side.arm.cross(impulse));
    if (way.isZero(0.0)) return entry;
    const Vec3 on_the_way = way.cross(impulse);  // it meets elsewhere than where the books have it
    flight_[index] = flight_[index].value_or(Vec3::Zero()) + on_the_way;
    entry.angular_momentum += on_the_way;
    return entry;
  }
  const DeformableBody& soft = *body.as<DeformableBody>();
  const Known& k = known_[index];
  LedgerEntry entry;
  for (const auto& [node, weight] : side.nodes) {
    const Eigen::Index i = 3 * static_cast<Eigen::Index>(soft.free_node()[static_cast<std::size_t>(node)]);
    const Vec3 p = weight * impulse;
    entry.motion += p.dot(k.node_mean.segment<3>(i));
    entry.momentum += p;
    entry.angular_momentum += Vec3(k.nodes.segment<3>(i)).cross(p);
  }
  return entry;
}

void Ledger::take_rigid(Body& body, BodyIndex b, const TimeIntegration& how) {
  const RigidBody& rigid = *body.as<RigidBody>();
  LedgerEntry& gravity = of(motion_[b], LedgerSource::gravity);
  gravity += rigid_entry(b, rigid.kick * rigid.mass * rigid.mean_gravity(how), Vec3::Zero());
  gravity.stored -= gravity.motion;
  const Stagger& known_ahead = rigid.stagger();  // taken off at the sub-step's start
  of(motion_[b], LedgerSource::integrator) += rigid_entry(b, -rigid.mass * known_ahead.lead, -known_ahead.spin_lead);
  if (!rigid.pull) return;
  const Vec3 arm = rigid.position_of(rigid.pull->point) - rigid.pose.position;
  of(motion_[b], LedgerSource::script) += rigid_entry(b, pull_[b], arm.cross(pull_[b]));
}

void Ledger::take_deformable(Body& body, BodyIndex b, const TimeIntegration& how, const GroupResult* result,
                             const VecX* row_impulse) {
  DeformableBody& soft = *body.as<DeformableBody>();
  const DeformableStep& step = soft.open_step();
  const VecX after = soft.with_held(step.v_star);
  StepImpulses p;
  how.integrator.impulses(soft, step, after, p);
  Entries& entries = motion_[b];
  const auto exchange = [&](LedgerSource source, const VecX& impulse) {
    LedgerEntry entry = node_entry(b, impulse);
    entry.stored = -entry.motion;
    of(entries, source) += entry;
  };
  exchange(LedgerSource::gravity, p.gravity);
  exchange(LedgerSource::elastic, p.elastic);
  of(entries, LedgerSource::damping) += node_entry(b, p.damping);
  of(entries, LedgerSource::script) += node_entry(b, p.external);
  if (p.integrator.size() > 0) of(entries, LedgerSource::integrator) += node_entry(b, p.integrator);

  take_lead(soft, -1.0, of(entries, LedgerSource::integrator));

  VecX reaction;
  soft.fem.multiply_mass(after - soft.velocity, reaction);
  reaction -= p.gravity + p.elastic + p.damping + p.external;
  if (p.integrator.size() > 0) reaction -= p.integrator;
  for (const int node : soft.free_node()) reaction.segment<3>(3 * node).setZero();
  of(entries, LedgerSource::script) += node_entry(b, reaction);

  VecX missing = missing_of(soft, how, result != nullptr && !result->is_at_root);
  if (row_impulse != nullptr) missing -= *row_impulse;
  VecX all = VecX::Zero(after.size());
  soft.scatter_free(missing, all);
  of(entries, LedgerSource::solver) += node_entry(b, all);
}

void Ledger::take_rows(const Bodies& bodies, const SubStep& step) {
  for (const GroupResult& result : step.results)
    for (const RowImpulse& row : result.rows) {
      const auto normal = row.kind == RowKind::contact ? LedgerSource::impact : LedgerSource::attachment;
      for (const LedgerSource source : {normal, LedgerSource::friction}) {
        const Vec3& on_a = source == normal ? row.normal : row.tangent;
        if (on_a.isZero(0.0)) continue;
        const auto has_part = [](const ContactSide& side) { return side.rigid >= 0 || side.deformable >= 0; };
        const auto take = [&](BodyIndex index, const ContactSide& side, const Vec3& way, const Vec3& impulse,
                              BodyIndex other, bool other_has_part) {
          if (has_part(side)) of(motion_[index], source) += side_entry(index, bodies[index], side, way, impulse);
          // what is driven works on its own body, or on the other one
          const double given = -impulse.dot(side.driven);
          if (given == 0.0) return;
          const BodyIndex to = has_part(side) ? index : other;
          if (!has_part(side) && !other_has_part) return;
          of(motion_[to], LedgerSource::script).motion += given;
          of(motion_[to], source).motion -= given;
        };
        take(row.body_a, row.a, row.way_a, on_a, row.body_b, has_part(row.b));
        take(row.body_b, row.b, row.way_b, -on_a, row.body_a, has_part(row.a));
      }
    }
}

void Ledger::solved(Bodies& bodies, const SubStep& step, const TimeIntegration& how) {
  // by body: its group and place there
  std::vector<std::pair<const GroupResult*, std::size_t>> place(motion_.size(), {nullptr, 0});
  for (std::size_t g = 0; g < step.groups.size(); ++g)
    for (std::size_t i = 0; i < step.groups[g].bodies.size(); ++i)
      place[step.groups[g].bodies[i]] = {&step.results[g], i};
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    if (!body.has_freedom() || body.asleep) return;
    Known& k = known_[b];
    const auto [result, i] = place[b];
    if (body.kind() == BodyKind::deformable) {
      const DeformableBody& soft = *body.as<DeformableBody>();
      k.node_mean = 0.5 * (soft.velocity + soft.with_held(soft.open_step().v_star));
      return take_deformable(body, b, how, result, result != nullptr ? &result->row_impulse[i].nodes : nullptr);
    }
    const Twist now = body.twist();
    k.mean = {0.5 * (k.twist.linear + now.linear), 0.5 * (k.twist.angular + now.angular)};
    const RigidBody& rigid = *body.as<RigidBody>();
    k.spin = rigid.angular_momentum, k.twist.linear = now.linear;  // of the way that follows
    take_rigid(body, b, how);
    if (result == nullptr) return;
    const Twist &change = result->velocity[i].twist, &rows = result->row_impulse[i].twist;
    of(motion_[b], LedgerSource::solver) +=
        rigid_entry(b, rigid.mass * change.linear - rows.linear, rigid.world_inertia() * change.angular - rows.angular);
  });
  take_rows(bodies, step);
}

/// What being elsewhere than the books know it made of a body's energy, and of its angular momentum about the origin.
void Ledger::take_move(Body& body, Known& known, LedgerEntry& entry) const {
  if (const RigidBody* rigid = body.as<RigidBody>()) {
    const Vec3 d = rigid->pose.position - known.pose.position;
    entry.stored -= rigid->mass * gravity_.dot(d);
    if (rigid->pose.rotation != known.pose.rotation || rigid->angular_momentum != known.spin)
      entry.motion += spin_energy(*rigid, rigid->pose.rotation, rigid->angular_momentum) -
                      spin_energy(*rigid, known.pose.rotation, known.spin);
    entry.angular_momentum += d.cross(rigid->mass * rigid->velocity) + rigid->angular_momentum - known.spin;
    const Vec3 lead = rigid->velocity - known.twist.linear;
    if (lead.isZero(0.0)) return know(body, known);
    entry.motion += 0.5 * rigid->mass * (rigid->velocity.squaredNorm() - known.twist.linear.squaredNorm());
    entry.momentum += rigid->mass * lead;
    entry.angular_momentum += known.pose.position.cross(rigid->mass * lead);
  } else if (DeformableBody* soft = body.as<DeformableBody>()) {
    const VecX d = soft->position - known.nodes;
    if (d.isZero(0.0)) return;
    VecX momenta;
    soft->fem.multiply_mass(soft->velocity, momenta);
    const double elastic = soft->elastic_energy();
    entry.stored += elastic - known.elastic;
    known.elastic = elastic;
    for (int i = 0; i < soft->nodes(); ++i) {
      const Vec3 by = d.segment<3>(3 * i);
      entry.stored -= soft->fem.node_mass()[static_cast<std::size_t>(i)] * gravity_.dot(by);
      entry.angular_momentum += by.cross(Vec3(momenta.segment<3>(3 * i)));
    }
  }
  know(body, known);
}

void Ledger::take_moves(Bodies& bodies, LedgerSource source) {
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    if (body.has_freedom() && !body.asleep) take_move(body, known_[b], of(motion_[b], source));
  });
}

/// The work that gravity and elastic forces did on the way is gone from what is stored already: the rest of the change
/// is the integrator's.
void Ledger::advanced(Bodies& bodies) {
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    const DeformableBody* soft = body.as<DeformableBody>();
    if (soft != nullptr && soft->has_freedom() && !soft->asleep)
      take_lead(*soft, 1.0, of(motion_[b], LedgerSource::integrator));
  });
  take_moves(bodies, LedgerSource::integrator);
  for (Entries& entries : motion_)
    of(entries, LedgerSource::integrator).stored -=
        of(entries, LedgerSource::gravity).stored + of(entries, LedgerSource::elastic).stored;
}

/// Of those that met in flight it is no recovery: their way was another than that of the velocity they end with.
void Ledger::pushed_out(Bodies& bodies) {
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    if (!body.has_freedom() || body.asleep) return;
    LedgerEntry& entry = of(motion_[b], flight_[b] ? LedgerSource::integrator : LedgerSource::push_out);
    take_move(body, known_[b], entry);
    if (flight_[b]) entry.angular_momentum -= *flight_[b];
  });
}

void Ledger::kept(Bodies& bodies) {
  take_moves(bodies, LedgerSource::held_back);
  for_each_body(bodies, [&](BodyIndex b, Body& body) {
    for (std::size_t s = 0; s < kLedgerSources; ++s) substep_[b][s] += motion_[b][s];
    motion_[b] = {};
    elastic_[b] = known_[b].elastic;
    BeforeRest& before = before_rest_[b] = {body.asleep, {}};
    if (!body.has_freedom() || body.asleep) return;
    if (const DeformableBody* soft = body.as<DeformableBody>())  // its elastic energy, which is dear, is not needed
      before.balance = {soft->kinetic_energy(), 0.0, 0.0, soft->momentum(), soft->angular_momentum()};
    else
      before.balance = body.balance(gravity_);
  });
}

void Ledger::rested(const Bodies& bodies) {
  for (BodyIndex b(0); b < bodies.size(); ++b) {
    const auto& [asleep, before] = before_rest_[b];
    if (!bodies[b].asleep || asleep) continue;
    of(substep_[b], LedgerSource::sleep) += {-before.kinetic, 0.0, -before.momentum, -before.angular_momentum};
  }
}

void Ledger::close_substep(int substep) {
  for (std::size_t b = 0; b < substep_.size(); ++b) {
    for (std::size_t s = 0; s < kLedgerSources; ++s) {
      frame_.bodies[b].of[s] += substep_[b][s];
      const double size = std::abs(figure_of(static_cast<LedgerSource>(s), substep_[b][s]));
      if (size > largest_[b][s]) largest_[b][s] = size, frame_.bodies[b].substep[s] = substep;
    }
    substep_[b] = {};
  }
}

std::shared_ptr<const FrameLedger> Ledger::so_far(Bodies& bodies) const {
  auto books = std::make_shared<FrameLedger>(frame_);
  for_each_body(bodies, [&](BodyIndex b, Body& body) { books->bodies[b].rise += change(begin_[b], measured(body)); });
  return books;
}

/// The impulse works on what its point does at the mean of before and after, as every other one.
LedgerEntry Ledger::pushed(Body& body, const Act& act, const std::function<void()>& doing) const {
  if (const RigidBody* rigid = body.as<RigidBody>()) {
    const Vec3 at = act.point.value_or(rigid->pose.position);
    const auto velocity = [&] {
      return Vec3(rigid->velocity + rigid->angular_velocity().cross(at - rigid->pose.position));
    };
    const Vec3 before = velocity();
    doing();
    return {act.vector.dot(0.5 * (before + velocity())), 0.0, act.vector, Vec3(at.cross(act.vector))};
  }
  const DeformableBody& soft = *body.as<DeformableBody>();
  std::vector<NodeWeight> nodes;
  if (act.point)
    for (const NodeWeight& node : soft.nodes_of(soft.nearest_point(*act.point))) nodes.push_back(node);
  const VecX before = soft.velocity;
  doing();
  VecX momentum;
  soft.fem.multiply_mass(soft.velocity - before, momentum);
  if (act.point) {  // free nodes have what was asked for; held ones what keeps them as they were
    for (const int node : soft.free_node()) momentum.segment<3>(3 * node).setZero();
    for (const auto& [node, weight] : nodes)
      if (!soft.is_held(node)) momentum.segment<3>(3 * node) += weight * act.vector;
  }
  return entry_of_nodes(momentum, 0.5 * (before + soft.velocity), soft.position);
}

void Ledger::act(Bodies& bodies, const Act& act, const Vec3& gravity, const std::function<void()>& doing) {
  gravity_ = gravity;
  const BodyIndex index = bodies.find(act.body);
  if (index.is_none() || (act.verb != Act::add && !bodies[index].has_freedom())) return doing();
  acts_.resize(static_cast<std::size_t>(bodies.size().value()));
  Body& body = bodies[index];
  const Balance before = measured(body);
  LedgerEntry& entry = acts_[index][LedgerSource::script];
  switch (act.verb) {
    case Act::push:
      entry += pushed(body, act, doing);
      break;
    case Act::move: {
      Known known;
      know(body, known);
      known.elastic = before.elastic;
      doing();
      take_move(body, known, entry);
      break;
    }
    case Act::remove:
      entry += {-before.kinetic, -before.potential - before.elastic, -before.momentum, -before.angular_momentum};
      doing();
      break;
    case Act::add: {
      doing();
      const Balance now = measured(body);
      entry += {now.kinetic, now.potential + now.elastic, now.momentum, now.angular_momentum};
      break;
    }
    default:
      doing();
  }
  acts_[index].rise += change(before, measured(body));
}

}  // namespace impinge
