#include "engine/world/group_assembly.hpp"

#include <algorithm>
#include <cmath>

#include "engine/geometry/distance.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {
namespace {

double pair_restitution(const RigidBody& a, const RigidBody& b, const Parameters& parameters) {
  const auto of = [&](const RigidBody& body) {
    return body.restitution < 0.0 ? parameters.contact.restitution : body.restitution;
  };
  return std::max(of(a), of(b));
}

/// Overlap below this is rounding, not overlap: pushing it out would cost a solve a sub-step for nothing.
double push_out_slop(const Parameters& parameters) { return 1e-6 * parameters.contact.activation_distance; }

double row_bound(double gap, double free_velocity, double velocity_before, double restitution,
                 const Parameters& parameters, double h) {
  const bool split = parameters.contact.push_out == PushOut::split;
  const double bound = gap >= 0.0 ? -gap / h : (split ? 0.0 : std::min(-gap / h, parameters.contact.max_push_out));
  const bool closes = gap + h * free_velocity < 0.0;
  if (!closes || restitution == 0.0 || velocity_before > -parameters.contact.restitution_threshold) return bound;
  return std::max(bound, -restitution * velocity_before);
}

}  // namespace

double pair_friction(const RigidBody& a, const RigidBody& b, const Parameters& parameters) {
  const auto of = [&](const RigidBody& body) {
    return body.friction < 0.0 ? parameters.contact.friction : body.friction;
  };
  return std::sqrt(of(a) * of(b));
}

Vec3 triangle_weights(const RigidBody& body, int triangle, const Vec3& point) {
  const Triangle& t = body.shape->mesh()->mesh.triangles[triangle];
  const Vec3 &a = body.world_vertices[t[0]], &b = body.world_vertices[t[1]], &c = body.world_vertices[t[2]];
  const Vec3 e0 = b - a, e1 = c - a, x = closest_on_triangle(point, {a, b, c}).point - a;
  const double d00 = e0.dot(e0), d01 = e0.dot(e1), d11 = e1.dot(e1), d20 = x.dot(e0), d21 = x.dot(e1);
  const double denominator = d00 * d11 - d01 * d01;
  if (!(denominator > 0.0)) return Vec3::Unit(0);
  const double v = (d11 * d20 - d01 * d21) / denominator, w = (d00 * d21 - d01 * d20) / denominator;
  return {1.0 - v - w, v, w};
}

namespace {

/// Nodes and weights of a point of a deformable surface, every node once.
std::vector<NodeWeight> carrying_nodes(const RigidBody& body, int triangle, const Vec3& point) {
  const Vec3 corner = triangle_weights(body, triangle, point);
  const Triangle& t = body.shape->mesh()->mesh.triangles[triangle];
  std::vector<NodeWeight> list;
  for (int k = 0; k < 3; ++k) {
    if (corner[k] == 0.0) continue;
    const Tet& tet = body.soft->nodes_of(t[k]);
    for (int n = 0; n < 4; ++n) {
      const double weight = corner[k] * body.soft->embedding.weight[t[k]][n];
      if (weight == 0.0) continue;
      const auto at = std::find_if(list.begin(), list.end(), [&](const NodeWeight& w) { return w.node == tet[n]; });
      if (at == list.end())
        list.push_back({tet[n], weight});
      else
        at->weight += weight;
    }
  }
  return list;
}

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
  rows.b.nodes.clear();
  rows.b.soft = -1;
  std::erase_if(rows.a.nodes, [](const NodeWeight& n) { return std::abs(n.weight) < 1e-12; });
}

Vec3 interpolated(const std::vector<NodeWeight>& nodes, const VecX& values) {
  Vec3 sum = Vec3::Zero();
  for (const NodeWeight& n : nodes) sum += n.weight * values.segment<3>(3 * n.node);
  return sum;
}

}  // namespace

namespace {

/// Fills the sides of one contact or attachment and what prescribed motion adds to its rows.
class RowFiller {
 public:
  RowFiller(const SubstepView& view, const std::vector<int>& local, ContactRows& rows)
      : view_(view), local_(local), rows_(rows) {}

  Vec3 velocity_before = Vec3::Zero();  ///< of A's point against B's, before the sub-step, m/s

  void soft_side(int index, const std::vector<NodeWeight>& nodes, double sign, ContactSide& side) {
    const DeformableBody& fem = view_.bodies[index].soft->fem;
    const SoftStep& step = *view_.soft[index];
    velocity_before += sign * interpolated(nodes, step.velocity_before);
    side.soft = local_[index];
    for (const NodeWeight& n : nodes) {
      const int free = fem.free_index()[n.node];
      if (free >= 0)
        side.nodes.push_back({free, n.weight});
      else
        rows_.surface += sign * n.weight * rows_.directions * step.displacement_velocity.segment<3>(3 * n.node);
    }
  }

  void rigid_side(int index, const Vec3& common, double sign, ContactSide& side) {
    const RigidBody& body = view_.bodies[index];
    side.arm = common - body.pose.position;
    side.rigid = body.is_dynamic() ? local_[index] : -1;
    velocity_before += sign * (view_.before[index].linear + view_.before[index].angular.cross(side.arm));
    if (side.rigid < 0)
      rows_.surface += sign * rows_.directions * (body.velocity + body.angular_velocity().cross(side.arm));
  }

 private:
  const SubstepView& view_;
  const std::vector<int>& local_;
  ContactRows& rows_;
};

bool responds(const ContactRows& rows) {
  return rows.a.rigid >= 0 || rows.b.rigid >= 0 || !rows.a.nodes.empty() || !rows.b.nodes.empty();
}

ContactRows contact_rows(const SubstepView& view, const std::vector<int>& local, const Collision& collision,
                         Vec3& velocity_before) {
  ContactRows rows;
  const Vec3 t1 = tangent1(collision.normal), common = 0.5 * (collision.point_a + collision.point_b);
  rows.directions << collision.normal.transpose(), t1.transpose(), collision.normal.cross(t1).transpose();
  RowFiller filler(view, local, rows);
  const auto fill = [&](int index, int triangle, const Vec3& point, double sign, ContactSide& side) {
    // a deformable body's row acts at the surface point itself: it is what moves with the nodes
    if (view.bodies[index].soft)
      filler.soft_side(index, carrying_nodes(view.bodies[index], triangle, point), sign, side);
    else
      filler.rigid_side(index, common, sign, side);
  };
  fill(collision.body_a, collision.triangle_a, collision.point_a, 1.0, rows.a);
  fill(collision.body_b, collision.triangle_b, collision.point_b, -1.0, rows.b);
  if (rows.a.soft >= 0 && rows.a.soft == rows.b.soft) merge_sides(rows);
  rows.gap = collision.gap;
  rows.friction = pair_friction(view.bodies[collision.body_a], view.bodies[collision.body_b], view.parameters);
  velocity_before = filler.velocity_before;
  return rows;
}

ContactRows attachment_rows(const SubstepView& view, const std::vector<int>& local, const Attachment& attachment) {
  ContactRows rows;
  rows.kind = RowKind::attachment;
  rows.directions.setIdentity();
  const Vec3 a = attachment.a.position(view.bodies), b = attachment.b.position(view.bodies);
  RowFiller filler(view, local, rows);
  const auto fill = [&](const AttachmentEnd& end, double sign, ContactSide& side) {
    if (end.body < 0) return;
    const RigidBody& body = view.bodies[end.body];
    if (!body.soft) return filler.rigid_side(end.body, 0.5 * (a + b), sign, side);
    std::vector<NodeWeight> nodes;
    for (int k = 0; k < 4; ++k)
      if (end.weight[k] != 0.0) nodes.push_back({body.soft->fem.fem.rest().tets[end.tet][k], end.weight[k]});
    filler.soft_side(end.body, nodes, sign, side);
  };
  fill(attachment.a, 1.0, rows.a);
  fill(attachment.b, -1.0, rows.b);
  if (rows.a.soft >= 0 && rows.a.soft == rows.b.soft) merge_sides(rows);
  Vec3 recovery = (a - b) / view.time_step;
  if (recovery.norm() > view.parameters.contact.max_push_out)
    recovery *= view.parameters.contact.max_push_out / recovery.norm();
  rows.surface += recovery;
  return rows;
}

}  // namespace

GroupSystem make_group_system(const SubstepView& view, CollisionGroup& group) {
  GroupSystem system;
  const std::span<const RigidBody> bodies = view.bodies;
  std::vector<int> kept, local(bodies.size(), -1);
  for (int b : group.bodies) {
    if (bodies[b].soft) {
      local[b] = static_cast<int>(system.soft.size());
      const SoftStep& s = *view.soft[b];
      const DeformableBody& fem = bodies[b].soft->fem;
      const bool diagonal = view.is_explicit && fem.fem.mass_kind() == MassKind::lumped;
      system.soft.push_back({&s.step.a, s.direct.get(), diagonal, s.step.v_star,
                             fem.gather_free(s.displacement_velocity), s.step.s / view.time_step});
    } else {
      local[b] = static_cast<int>(system.bodies.size());
      system.bodies.push_back(
          {1.0 / bodies[b].mass, bodies[b].world_inertia_inverse(), bodies[b].velocity, bodies[b].angular_velocity()});
    }
  }
  system.contacts.reserve(group.contacts.size());
  const int collisions = static_cast<int>(view.collisions.size());
  for (int c : group.contacts) {
    Vec3 velocity_before = Vec3::Zero();
    ContactRows rows = c < collisions ? contact_rows(view, local, view.collisions[c], velocity_before)
                                      : attachment_rows(view, local, view.attachments[c - collisions]);
    if (!responds(rows)) continue;
    kept.push_back(c);
    system.contacts.push_back(std::move(rows));
    if (c >= collisions) continue;
    const Collision& collision = view.collisions[c];
    const double free_velocity = system.contact_velocity(system.contacts.size() - 1, false).x();
    ContactRows& row = system.contacts.back();
    row.restitution = pair_restitution(bodies[collision.body_a], bodies[collision.body_b], view.parameters);
    row.velocity_before = collision.normal.dot(velocity_before);
    row.bound =
        row_bound(collision.gap, free_velocity, row.velocity_before, row.restitution, view.parameters, view.time_step);
  }
  group.contacts = std::move(kept);
  system.lambda.assign(system.contacts.size(), Vec3::Zero());
  system.clear_delta();
  return system;
}

bool needs_push_out(const GroupSystem& solved, const Parameters& parameters, double time_step) {
  if (parameters.contact.push_out != PushOut::split || parameters.contact.max_push_out <= 0.0) return false;
  // rows whose positions move by Δt v leave no overlap that wasn't there; others (Newmark) are asked
  const bool all_move = std::all_of(solved.soft.begin(), solved.soft.end(),
                                    [](const SoftBlock& b) { return b.displacement_scale == 1.0; });
  for (std::size_t i = 0; i < solved.contacts.size(); ++i) {
    const ContactRows& c = solved.contacts[i];
    if (c.kind != RowKind::contact) continue;
    const double gap = all_move ? c.gap : std::min(c.gap, c.gap + time_step * solved.displacement_velocity(i).x());
    if (gap < -push_out_slop(parameters)) return true;
  }
  return false;
}

GroupSystem make_push_out_system(const GroupSystem& solved, const Parameters& parameters, double time_step) {
  GroupSystem push = solved;
  for (BodyBlock& body : push.bodies) body.velocity.setZero(), body.angular_velocity.setZero();
  for (SoftBlock& block : push.soft) block.velocity.setZero();
  for (std::size_t i = 0; i < push.contacts.size(); ++i) {
    ContactRows& rows = push.contacts[i];
    push.lambda[i].setZero();
    if (rows.kind != RowKind::contact) {
      rows.surface.setZero();
      continue;
    }
    const double gap_after = rows.gap + time_step * solved.displacement_velocity(i).x();
    rows.surface.setZero();
    rows.friction = rows.restitution = 0.0;
    // an overlap is measured after the velocities have moved the bodies: separation that they bring is not added twice
    rows.bound =
        gap_after >= 0.0 ? -gap_after / time_step : std::min(-gap_after / time_step, parameters.contact.max_push_out);
  }
  return push;
}

}  // namespace impinge
