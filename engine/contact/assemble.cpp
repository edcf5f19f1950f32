#include "engine/contact/assemble.hpp"

#include <algorithm>
#include <cmath>

#include "engine/bodies/rigid_motion.hpp"
#include "engine/contact/contact_frame.hpp"
#include "engine/contact/mobility.hpp"
#include "engine/contact/pair_coefficients.hpp"
#include "engine/contact/pair_scale.hpp"
#include "engine/contact/row_bound.hpp"

namespace impinge {
namespace {

constexpr double kShortest = 1e-6;  // of a sub-step: what is left of it where two meet as it ends
/// Of the activation distance: how far parts of one body are kept apart. What rests on itself with a gap of nothing
/// crosses itself by what a sub-step leaves of it, and a crossing, however shallow, is seen from its other side later.
constexpr double kSelfDistance = 0.01;

/// Where a body stands in the group's system; neither: it has no freedom.
struct BlockIndex {
  int rigid = -1, deformable = -1;
};

/// A body in contact with itself: one side carries the difference of both, since they may share nodes.
void merge_sides(ContactRows& rows) {
  for (const NodeWeight& n : rows.b.nodes) {
    const auto at =
        std::find_if(rows.a.nodes.begin(), rows.a.nodes.end(), [&](const NodeWeight& w) { return w.node == n.node; });
    if (at == rows.a.nodes.end())
      rows.a.nodes.push_back({n.node, -n.weight});
    else
      at->weight -= n.weight;
  }
  rows.a.driven -= rows.b.driven;
  rows.b.driven.setZero();
  rows.b.nodes.clear();
  rows.b.deformable = -1;
  std::erase_if(rows.a.nodes, [](const NodeWeight& n) { return std::abs(n.weight) < 1e-12; });
}

bool responds(const ContactRows& rows) {
  return rows.a.rigid >= 0 || rows.b.rigid >= 0 || !rows.a.nodes.empty() || !rows.b.nodes.empty();
}

/// Fills an AssembledGroup contact by contact.
class Assembly {
 public:
  Assembly(const AssemblyInput& input, const CollisionGroup& group)
      : input_(input), bodies_(input.bodies), group_(group), blocks_(group.bodies.size()) {
    for (std::size_t i = 0; i < group.bodies.size(); ++i) {
      const BodyIndex b = group.bodies[i];
      SystemBlock block = bodies_[b].system_block();
      if (auto* rigid = std::get_if<RigidBlock>(&block)) {
        blocks_[i].rigid = static_cast<int>(system().rigid.size());
        system().rigid.push_back(*rigid);
        result_.rigid.push_back(b);
      } else {
        blocks_[i].deformable = static_cast<int>(system().deformable.size());
        system().deformable.push_back(std::move(std::get<DeformableBlock>(block)));
        result_.deformable.push_back(b);
      }
    }
    system().contacts.reserve(group.contacts.size());
    result_.meeting = find_meeting();
    if (result_.meeting > 0.0) turn_on(result_.meeting);
  }

  void add_collision(ContactIndex index, const Collision& c) {
    ContactRows rows;
    rows.directions = contact_axes(c.normal);
    const MaterialPoint a = bodies_[c.body_a].surface_point(c.triangle_a, c.touches_a()),
                        b = bodies_[c.body_b].surface_point(c.triangle_b, c.touches_b());
    Vec3 velocity_before = Vec3::Zero();
    lead_.setZero();
    const auto [on_a, on_b] = acts_on(c);
    fill_side(c.body_a, a, on_a, 1.0, rows, rows.a, velocity_before);
    fill_side(c.body_b, b, on_b, -1.0, rows, rows.b, velocity_before);
    rows.gap = c.gap;
    if (c.body_a == c.body_b) rows.gap -= kSelfDistance * input_.settings.activation(bodies_[c.body_a].size);
    rows.friction = pair_friction(bodies_[c.body_a], bodies_[c.body_b], input_.settings);
    if (!add(index, std::move(rows), {a, b})) return;
    const double free_velocity = system().contact_velocity(system().contacts.size() - 1, false).x();
    ContactRows& row = system().contacts.back();
    if (!c.meeting || !c.meeting->is_after)
      row.restitution = rebound_share(c) * pair_restitution(bodies_[c.body_a], bodies_[c.body_b], input_.settings);
    row.velocity_before = c.normal.dot(velocity_before);
    row.scale = pair_scale(bodies_[c.body_a], bodies_[c.body_b], input_.gravity);
    NormalMotion motion{row.gap, free_velocity, row.velocity_before, row.restitution, 0.0, row.scale.speed};
    if (result_.meeting > 0.0 && c.meeting) return take_flight(c, row, motion);
    if (input_.velocities == VelocityTime::middle && result_.meeting == 0.0 && row.restitution > 0.0)
      find_impact(c, row, motion);
    row.bound = row_bound(motion, input_.settings, input_.time_step);
    if (!(row.bound > 0.0)) row.impact = 0.0;  // it is too slow to rebound
  }

  void add_attachment(ContactIndex index, const Attachment& attachment) {
    if (attachment.kind != AttachmentKind::point) return add_slide(index, attachment);
    ContactRows rows;
    rows.kind = RowKind::attachment;
    rows.directions.setIdentity();
    const Vec3 a = attachment.a.position(bodies_), b = attachment.b.position(bodies_), common = 0.5 * (a + b);
    Vec3 velocity_before = Vec3::Zero();
    fill_side(attachment.a.body, attachment.a.point, common, 1.0, rows, rows.a, velocity_before);
    fill_side(attachment.b.body, attachment.b.point, common, -1.0, rows, rows.b, velocity_before);
    set_scale(attachment, rows);
    const Vec3 back = recovery(a - b, input_.settings.max_push_out.at(rows.scale.speed));
    rows.surface += back;
    if (!add(index, std::move(rows), {attachment.a.point, attachment.b.point})) return;
    note(result_.recovery, back);
    if (swift_part() < 1.0) note(result_.drift, (1.0 - swift_part()) * (a - b));
  }

  void add_slide(ContactIndex index, const Attachment& slide) {
    const AttachmentHold hold = hold_of(slide, bodies_);
    ContactRows rows;
    rows.kind = RowKind::sliding;
    const Vec3 common = 0.5 * (hold.point_a + hold.point_b);
    rows.directions =
        contact_axes(slide.kind == AttachmentKind::line ? line_normal(index, slide, hold, common) : hold.normal);
    Vec3 velocity_before = Vec3::Zero();
    fill_side(slide.a.body, slide.a.point, common, 1.0, rows, rows.a, velocity_before);
    fill_side(slide.b.body, hold.at_b, common, -1.0, rows, rows.b, velocity_before);
    set_scale(slide, rows);
    // what leaves its way at a bend may come back as fast: that turns its velocity round and gives it no energy
    const Vec3 error = hold.point_a - hold.point_b;
    const double away = error.norm() > 0.0 ? std::max(0.0, velocity_before.dot(error.normalized())) : 0.0,
                 most = input_.settings.max_push_out.at(rows.scale.speed) + away;
    rows.surface.x() += rows.directions.row(0).dot(recovery(error, most));
    add(index, std::move(rows), {slide.a.point, hold.at_b});
  }

  AssembledGroup finish() {
    system().clear_delta();
    for (std::vector<Vec3>* list : {&result_.recovery, &result_.drift})
      if (!list->empty()) list->resize(result_.contacts.size(), Vec3::Zero());
    return std::move(result_);
  }

 private:
  std::pair<Vec3, Vec3> acts_on(const Collision& c) const {
    const bool a_moves = bodies_[c.body_a].has_freedom(), b_moves = bodies_[c.body_b].has_freedom();
    if (!input_.acts_on_surfaces || c.meeting || c.gap <= 0.0 || a_moves == b_moves)
      return {c.acts_on_a(), c.acts_on_b()};
    const Vec3& at = a_moves ? c.point_a : c.point_b;
    return {at, at};
  }
  double rebound_share(const Collision& c) const {
    if (input_.rebounds == nullptr) return 1.0;
    const auto known = input_.rebounds->find({c.body_a, c.body_b});
    return known == input_.rebounds->end() ? 1.0 : known->second;
  }
  GroupSystem& system() { return result_.system; }

  double find_meeting() const {
    double met = 0.0;
    for (const ContactIndex i : group_.contacts) {
      const Collision* c = input_.contacts.collision(i);
      if (c == nullptr) return 0.0;
      if (c->meeting)
        met = c->meeting->time;
      else if (bodies_[c->body_a].has_freedom() && bodies_[c->body_b].has_freedom())
        return 0.0;
    }
    return met;
  }

  /// The bodies as they will have turned by then.
  void turn_on(double time) {
    for (std::size_t i = 0; i < result_.rigid.size(); ++i) {
      const RigidBody& body = *bodies_[result_.rigid[i]].as<RigidBody>();
      const Mat3 rotation = free_turn(body, body.pose.rotation, body.angular_momentum, time);
      RigidBlock& block = system().rigid[i];
      block.inverse_inertia = rotation * body.inertia_inverse * rotation.transpose();
      block.angular_velocity = block.inverse_inertia * body.angular_momentum;
    }
  }

  /// By the forces of the sub-step, m/s².
  Vec3 acceleration_of(BodyIndex index) const {
    const RigidBody* body = bodies_[index].as<RigidBody>();
    if (body == nullptr || body->kick == 0.0) return Vec3::Zero();
    const CarriedPoint before = body->carry({}, body->pose.position);
    return (body->velocity - before.velocity_before + before.lead) / body->kick;
  }

  /// What the gap of two is when they meet has to last for the rest of the sub-step, and what rebounds is the velocity that
  /// they have by then. That of the sub-step is what forces make of it half way.
  void take_flight(const Collision& c, ContactRows& row, NormalMotion motion) const {
    const double h = input_.time_step, met = result_.meeting,
                 acceleration = c.normal.dot(acceleration_of(c.body_a) - acceleration_of(c.body_b));
    motion.gap += met * motion.free_velocity;
    motion.velocity_before = motion.free_velocity + acceleration * (met - 0.5 * h);
    motion.after = acceleration * (0.5 * h - met);
    row.velocity_before = motion.velocity_before;
    row.bound = row_bound(motion, input_.settings, std::max(h - met, kShortest * h));
    row.impact = met;
  }

  /// When the gap of two rigid bodies closes, with the velocity that they have by then: what is given back is a part of
  /// that one, and forces go on from there.
  void find_impact(const Collision& c, ContactRows& row, NormalMotion& motion) const {
    const Body &a = bodies_[c.body_a], &b = bodies_[c.body_b], &later = a.kick > b.kick ? a : b;
    if (!(motion.gap + input_.time_step * motion.free_velocity < 0.0) || later.kick == 0.0) return;
    if (a.kind() == BodyKind::deformable || b.kind() == BodyKind::deformable) return;
    const double acceleration = (motion.free_velocity - motion.velocity_before + c.normal.dot(lead_)) / later.kick;
    row.impact = std::max(motion.gap, 0.0) / -motion.free_velocity;
    motion.velocity_before += acceleration * row.impact;
    motion.after = acceleration * (later.kick - later.lag - row.impact);
    row.velocity_before = motion.velocity_before;
  }

  BlockIndex block_of(BodyIndex body) const {
    const auto at = std::lower_bound(group_.bodies.begin(), group_.bodies.end(), body);
    if (at == group_.bodies.end() || *at != body) return {};
    return blocks_[static_cast<std::size_t>(at - group_.bodies.begin())];
  }

  /// Whether it is the second of a line's two rows.
  bool is_second(ContactIndex index) const {
    const std::size_t at = input_.contacts.attachment_at(index);
    const std::span<const Attachment> all = input_.contacts.attachments;
    return at > 0 && all[at - 1].number == all[at].number;
  }

  /// Of the two across a line that don't push one another's point, so that solvers which look at a row at a time need one
  /// look.
  Vec3 line_normal(ContactIndex index, const Attachment& slide, const AttachmentHold& hold, const Vec3& common) const {
    const Mat3 mobility = mobility_at(slide.a.body, common) + mobility_at(slide.b.body, common),
               axes = contact_axes(hold.axis);
    const Vec3 u = axes.row(1), v = axes.row(2);
    const double angle = 0.5 * std::atan2(2.0 * u.dot(mobility * v), u.dot(mobility * u) - v.dot(mobility * v));
    return is_second(index) ? Vec3(std::cos(angle) * v - std::sin(angle) * u)
                            : Vec3(std::cos(angle) * u + std::sin(angle) * v);
  }

  /// What an impulse at a point of a rigid body makes of its velocity, 1/kg.
  Mat3 mobility_at(BodyIndex body, const Vec3& at) const {
    const BlockIndex block = body.is_none() ? BlockIndex() : block_of(body);
    if (block.rigid < 0) return Mat3::Zero();
    const RigidBlock& of = result_.system.rigid[static_cast<std::size_t>(block.rigid)];
    return mobility(of, Mat3::Identity(), at - bodies_[body].pose.position);
  }

  void set_scale(const Attachment& attachment, ContactRows& rows) const {
    const BodyIndex first = attachment.a.body.is_none() ? attachment.b.body : attachment.a.body,
                    second = attachment.b.body.is_none() ? first : attachment.b.body;
    rows.scale = pair_scale(bodies_[first], bodies_[second], input_.gravity);
  }

  /// Of an error as it came about in the piece before, what a piece of this length makes anew: ½ ω² Δt² of an arm. Pulling
  /// back more of it by a velocity would win energy; the rest is left to positions.
  double swift_part() const {
    const double shorter = input_.time_step / std::max(input_.time_step, input_.drift_time);
    return shorter * shorter;
  }

  /// Of the row that was added last.
  void note(std::vector<Vec3>& by_row, const Vec3& value) const {
    by_row.resize(result_.contacts.size(), Vec3::Zero());
    by_row.back() = value;
  }

  /// The velocity that takes an error back within the sub-step, m/s, `most` at most.
  Vec3 recovery(const Vec3& error, double most) const {
    Vec3 velocity = swift_part() * error / input_.time_step;
    if (velocity.norm() > most) velocity *= most / velocity.norm();
    return velocity;
  }

  /// And what prescribed motion adds to the rows, and the velocity of A's point against B's before the sub-step.
  void fill_side(BodyIndex body, const MaterialPoint& point, const Vec3& common, double sign, ContactRows& rows,
                 ContactSide& side, Vec3& velocity_before) {
    if (body.is_none()) return;
    CarriedPoint carried = bodies_[body].carry(point, common);
    const BlockIndex block = block_of(body);
    side.rigid = block.rigid;
    side.deformable = block.deformable;
    side.arm = carried.arm;
    side.nodes = std::move(carried.nodes);
    for (const Prescribed& p : carried.prescribed) side.driven += p.weight * p.velocity;
    for (const Prescribed& p : carried.prescribed) rows.surface += sign * p.weight * rows.directions * p.velocity;
    velocity_before += sign * carried.velocity_before;
    lead_ += sign * carried.lead;
  }

  /// Of a line the impulse of both rows: its normals are others in each sub-step.
  Vec3 start_of(ContactIndex index) const {
    const auto at = static_cast<std::size_t>(index.value());
    if (input_.contacts.collision(index) != nullptr || input_.contacts.attachment(index).kind != AttachmentKind::line)
      return input_.start[at];
    return input_.start[at] + input_.start[is_second(index) ? at - 1 : at + 1];
  }

  bool add(ContactIndex index, ContactRows rows, std::pair<MaterialPoint, MaterialPoint> points) {
    if (rows.a.deformable >= 0 && rows.a.deformable == rows.b.deformable) merge_sides(rows);
    if (!responds(rows)) return false;
    Vec3 start = Vec3::Zero();
    if (!input_.start.empty()) {
      start = rows.directions * start_of(index);
      if (rows.has_one_row()) start.tail<2>().setZero();
      if (rows.kind == RowKind::contact && start.x() <= 0.0) start.setZero();
    }
    system().lambda.push_back(start);
    system().contacts.push_back(std::move(rows));
    result_.contacts.push_back(index);
    result_.points.push_back(std::move(points));
    return true;
  }

  const AssemblyInput& input_;
  const Bodies& bodies_;
  const CollisionGroup& group_;
  std::vector<BlockIndex> blocks_;  // by body of the group
  Vec3 lead_ = Vec3::Zero();        // of A's point against B's in the row that is made
  AssembledGroup result_;
};

}  // namespace

std::vector<BodyVector> AssembledGroup::by_body(const CollisionGroup& group, const std::vector<Vec3>& linear,
                                                const std::vector<Vec3>& angular,
                                                const std::vector<VecX>& nodes) const {
  std::vector<BodyVector> list(group.bodies.size());
  std::size_t r = 0, d = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (r < rigid.size() && rigid[r] == group.bodies[i]) {
      list[i].twist = {linear[r], angular[r]};
      ++r;
    } else {
      list[i].nodes = nodes[d++];
    }
  }
  return list;
}

AssembledGroup assemble(const AssemblyInput& input, const CollisionGroup& group) {
  Assembly assembly(input, group);
  for (const ContactIndex i : group.contacts)
    if (const Collision* collision = input.contacts.collision(i))
      assembly.add_collision(i, *collision);
    else
      assembly.add_attachment(i, input.contacts.attachment(i));
  return assembly.finish();
}

}  // namespace impinge
