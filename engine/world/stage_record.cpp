#include "engine/world/stage_record.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/step/find_pairs.hpp"
#include "engine/world/record_parts.hpp"
#include "engine/world/world.hpp"

namespace impinge {
namespace {

std::string several(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

class Writer {
 public:
  Writer(const World& world, const SubStep& step, const StageEntry& entry, const SolveTape& tape)
      : world_(world), bodies_(world.bodies()), step_(step), entry_(entry), tape_(tape) {}

  StepRecord write() {
    for (const Body& body : bodies_)
      if (!body.absent) r_.bodies.push_back(record_of(body));
    show_attachments(world_.attachments(), bodies_, r_);
    r_.gravity = world_.parameters.simulation.gravity;
    r_.frame_time = world_.parameters.simulation.frame_time;
    const StageKind kind = entry_.kind;
    if (kind >= StageKind::broad_phase) pairs();
    if (kind >= StageKind::narrow_phase) r_.triangle_pairs = step_.triangle_pairs;
    if (kind >= StageKind::groups) groups();
    if (kind == StageKind::narrow_phase) found(all_collisions());
    if (kind == StageKind::reduction || kind == StageKind::groups) found(step_.collisions);
    if (kind == StageKind::assembly)
      for (const SolveTape::Group& group : tape_.groups()) add(group.start.contacts);
    if (kind == StageKind::iteration) iteration();
    if (kind >= StageKind::response)
      for (const GroupResult& result : step_.results) add(result.solved);
    if (kind == StageKind::response || kind == StageKind::second_look) add_changes();
    if (kind == StageKind::push_out) show_recovery();
    count();
    return std::move(r_);
  }

 private:
  /// Boxes as the broad phase had them.
  void pairs() {
    r_.broad_pairs = step_.pairs;
    if (entry_.kind > StageKind::narrow_phase) return;
    for (std::size_t b = 0; b < r_.bodies.size(); ++b) r_.bodies[b].bounds = step_.boxes.by_body[b];
  }

  void groups() {
    for (GroupIndex g(0); g < step_.groups.size(); ++g) {
      r_.groups.push_back(step_.groups[g].bodies);
      for (const BodyIndex b : step_.groups[g].bodies) r_.bodies[b].group = g;
    }
  }

  /// Those that reduction took away as well.
  std::vector<Collision> all_collisions() const {
    std::vector<Collision> all = step_.collisions;
    all.insert(all.end(), step_.dropped.begin(), step_.dropped.end());
    std::stable_sort(all.begin(), all.end(), [](const Collision& l, const Collision& r) {
      return std::pair(l.body_a, l.body_b) < std::pair(r.body_a, r.body_b);
    });
    return all;
  }

  void found(const std::vector<Collision>& collisions) {
    std::vector<SolvedContact> contacts;
    for (const Collision& c : collisions) {
      contacts.push_back(found_contact(c, bodies_, world_.parameters.contact));
      if (entry_.kind == StageKind::groups)
        contacts.back().group = step_.group_of(bodies_[c.body_a].has_freedom() ? c.body_a : c.body_b);
    }
    add(contacts);
  }

  void add(const std::vector<SolvedContact>& contacts) {
    for (const SolvedContact& contact : contacts) r_.contacts.push_back(carried(contact, bodies_));
  }

  void add_twist(BodyIndex body, const BodyVector& change) {
    r_.bodies[body].velocity += change.twist.linear;
    r_.bodies[body].angular_velocity += change.twist.angular;
  }

  void iteration() {
    for (GroupIndex g(0); g < tape_.groups().size(); ++g) {
      const SolveTape::Group& group = tape_.groups()[g];
      const SolveTape::Look& look = group.taken ? *group.taken : group.start;
      add(look.contacts);
      for (std::size_t i = 0; i < look.change.size(); ++i) add_twist(step_.groups[g].bodies[i], look.change[i]);
      r_.stats.residual_coulomb = larger(r_.stats.residual_coulomb, look.residual);
    }
  }

  void add_changes() {
    for (GroupIndex g(0); g < step_.groups.size(); ++g)
      for (std::size_t i = 0; i < step_.groups[g].bodies.size(); ++i)
        add_twist(step_.groups[g].bodies[i], step_.results[g].velocity[i]);
  }

  /// Velocities are those by which recovery from overlap moves bodies.
  void show_recovery() {
    for (BodyRecord& body : r_.bodies) body.velocity = body.angular_velocity = Vec3::Zero();
    for (GroupIndex g(0); g < step_.groups.size(); ++g)
      for (std::size_t i = 0; i < step_.results[g].displacement.size(); ++i) {
        const Twist& twist = step_.results[g].displacement[i].twist;
        add_twist(step_.groups[g].bodies[i], {{twist.linear / step_.time_step, twist.angular / step_.time_step}, {}});
      }
  }

  void count() {
    FrameStats& s = r_.stats;
    s.frame = world_.frame();
    s.time = step_.time;
    s.substeps = world_.parameters.simulation.substeps;
    for (const Body& body : bodies_)
      if (!body.deleted) ++s.bodies, s.dofs += body.dofs(), s.asleep += body.asleep ? 1 : 0;
    s.broad_pairs = std::ssize(r_.broad_pairs);
    s.triangle_pairs = std::ssize(r_.triangle_pairs);
    s.contacts = std::ssize(r_.contacts);
    s.groups = std::ssize(r_.groups);
    for (const ContactRecord& c : r_.contacts) s.max_penetration = std::max(s.max_penetration, -c.gap);
    if (entry_.kind >= StageKind::response)
      for (const GroupResult& result : step_.results) {
        s.lcp_iterations += result.iterations;
        s.residual = larger(s.residual, result.verdict.residual());
        s.residual_coulomb = larger(s.residual_coulomb, result.verdict.relative);
      }
  }

  const World& world_;
  const Bodies& bodies_;
  const SubStep& step_;
  const StageEntry& entry_;
  const SolveTape& tape_;
  StepRecord r_;
};

double fastest(const Bodies& bodies) {
  double speed = 0.0;
  for (const Body& body : bodies)
    if (body.has_freedom() && !body.asleep) speed = std::max(speed, body.fastest_point());
  return speed;
}

}  // namespace

StepRecord stage_record(const World& world, const SubStep& step, const StageEntry& entry, const SolveTape& tape) {
  return Writer(world, step, entry, tape).write();
}

void show_passages(const UnsafeMotion& motion, StepRecord& record) {
  record.contacts.clear();
  for (const UnsafeMotion::Pair& pair : motion.pairs)
    for (const Passage& p : pair.passages) {
      ContactRecord& c = record.contacts.emplace_back();
      c.body_a = pair.a, c.body_b = pair.b;
      c.triangle_a = p.triangle_a, c.triangle_b = p.triangle_b;
      c.point_a = p.point_a, c.point_b = p.point_b, c.normal = p.normal;
      c.gap = c.gap0 = p.normal.dot(p.point_a - p.point_b);
      c.pair_id = p.feature;
    }
  record.stats.contacts = std::ssize(record.contacts);
}

std::string stage_words(const World& world, const SubStep& step, StageKind kind, const SolveTape& tape) {
  switch (kind) {
    case StageKind::free_motion:
      return fmt::format("fastest {:.3g} m/s", fastest(world.bodies()));
    case StageKind::broad_phase:
      return several(step.pairs.size(), "pair");
    case StageKind::narrow_phase:
      return fmt::format("{}, {}", several(step.triangle_pairs.size(), "triangle pair"),
                         several(step.collisions.size(), "contact"));
    case StageKind::reduction:
      return fmt::format("{} of {} stay", step.collisions.size(),
                         several(step.collisions.size() + step.dropped.size(), "contact"));
    case StageKind::groups: {
      std::size_t largest = 0;
      for (const CollisionGroup& group : step.groups) largest = std::max(largest, group.bodies.size());
      return step.groups.empty() ? "none"
                                 : fmt::format("{}, at most {} {}", several(step.groups.size(), "group"), largest,
                                               largest == 1 ? "body" : "bodies");
    }
    case StageKind::assembly: {
      std::size_t rows = 0;
      for (const SolveTape::Group& group : tape.groups()) rows += static_cast<std::size_t>(group.rows);
      return several(rows, "row");
    }
    case StageKind::iteration:
      return "";
    case StageKind::response:
    case StageKind::second_look: {
      double residual = 0.0;
      std::size_t contacts = 0, unanswered = 0;
      for (const GroupResult& result : step.results) {
        residual = larger(residual, result.verdict.relative);
        contacts += result.solved.size();
        unanswered += result.is_answered() ? 0 : 1;
      }
      return fmt::format("{}, residual {:.2g}{}", several(contacts, "contact"), residual,
                         unanswered > 0 ? fmt::format(", {} not converged", unanswered) : "");
    }
    case StageKind::push_out: {
      double most = 0.0;
      for (const GroupResult& result : step.results)
        for (const double speed : result.push_out) most = std::max(most, speed);
      return most > 0.0 ? fmt::format("at most {:.3g} m/s", most) : "none";
    }
    case StageKind::integration:
      return fmt::format("through {:.4g} s", step.time_step);
    case StageKind::impact:
    case StageKind::look_back:
    case StageKind::end:
      break;
  }
  return "";
}

}  // namespace impinge
