// Soft constraints as in today's game engines [Catto11]: fast and loose. Each contact is a spring and damper by
// frequency and damping ratio, softened by the mass that it feels, in a few sweeps of sequential impulses; sub-steps
// (simulation.substeps) take the place of iterations. Positions move by what these sweeps leave; then sweeps without
// springs relax the velocities, so that recovery from overlap is no motion afterwards (groups of rigid bodies only).
// Built to be compared with, so to be known exactly:
// - regularised: the normal law. At rest a lone contact sinks by W_ii λ/(Δt ω²), a ball by g/ω². A gap closes freely.
// - not regularised: friction, which is the cone by projection, and restitution. Attachments are hard, too.
// - not solved: a bounded number of sweeps, started from the last impulses, is all; nothing is said of convergence. But
//   what joins rigid bodies is, and the few points that join a deformable one to another body: what sweeps leave there would be
//   taken back by a velocity, with energy from nowhere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/interrupt.hpp"
#include "engine/response/joint_system.hpp"
#include "engine/response/operators/delassus_by_contact.hpp"
#include "engine/response/passive_impulses.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

/// What a spring of angular frequency ω and damping ratio ζ becomes over a step of implicit Euler, without a mass in
/// it.
struct Softness {
  double bias_rate, mass_scale, impulse_scale;
};

Softness softness(double hertz, double ratio, double h) {
  const double omega = 2.0 * M_PI * std::min(hertz, 0.25 / h);
  const double a1 = 2.0 * ratio + h * omega, a2 = h * omega * a1, a3 = 1.0 / (1.0 + a2);
  return {omega / a1, a2 * a3, a3};
}

class SoftConstraint : public Response {
 public:
  void declare(const Rows& rows) override {
    rows.add("frequency", settings_.frequency, {0.0, 1e6, true}, "Hz",
             "Of each contact's spring; at most a quarter of the sub-steps' rate is used.")
        .formerly("response.soft_frequency");
    rows.add("damping_ratio", settings_.damping_ratio, {0.0, 1e6}, "", "Of each contact's spring, 1 is critical.")
        .formerly("response.soft_damping_ratio");
    rows.add("iterations", settings_.iterations, {1, 1000000, true}, "", "Sweeps for a group and sub-step.")
        .formerly("response.soft_iterations");
    rows.add("relax_iterations", settings_.relax_iterations, {0, 1000000}, "",
             "Sweeps after the positions, which take out the velocity that recovery from overlap brought.")
        .formerly("response.soft_relax_iterations");
  }

  bool uses_cone_solver() const override { return false; }
  bool lives_on_overlap() const override { return true; }
  IterationSetting iteration_setting() override { return {&settings_.iterations, true}; }
  std::string summary(const LcpSettings&) const override {
    return fmt::format("{} Hz, damping ratio {}, {} sweeps", shortest(settings_.frequency),
                       shortest(settings_.damping_ratio), settings_.iterations);
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver&, const ResponseContext& context) const override {
    DelassusByContact w(group);
    const Joints joints(group, w);
    const Softness soft = softness(settings_.frequency, settings_.damping_ratio, context.time_step);
    ResponseResult result;
    for (; result.iterations < settings_.iterations; ++result.iterations)
      sweep(group, joints, w, [&](std::size_t i, const Vec3& u) {
        return soft_impulse(group.contacts[i], w.diagonal(i), u, group.lambda[i], soft, context);
      });
    if (!w.finish()) result.ended = StopReason::stagnated;
    // a deformable body's elastic forces count on positions that move by its velocities
    if (settings_.relax_iterations == 0 || !group.deformable.empty()) return result;
    group.position_velocity = group.delta_velocity;
    group.position_angular_velocity = group.delta_angular_velocity;
    // overlap may not grow any more; what is apart still is kept as it was, or the next sub-step would have nothing to
    // bounce
    std::vector<double> bound(group.contacts.size());
    for (std::size_t i = 0; i < bound.size(); ++i) {
      const ContactRows& rows = group.contacts[i];
      const double gap = rows.gap + context.time_step * group.contact_velocity(i, true).x();
      bound[i] = rows.kind != RowKind::contact || bounces(rows)
                     ? rows.bound
                     : std::min(0.0, gap > 0.0 ? -rows.gap / context.time_step : 0.0);
    }
    for (int k = 0; k < settings_.relax_iterations; ++k, ++result.iterations)
      sweep(group, joints, w, [&](std::size_t i, Vec3 u) {
        u.x() -= bound[i];
        return relaxed_impulse(group.contacts[i], w.diagonal(i), u, group.lambda[i]);
      });
    if (!w.finish()) result.ended = StopReason::stagnated;
    win_nothing(group);
    for (std::size_t b = 0; b < group.rigid.size(); ++b) {
      group.position_velocity[b] -= group.delta_velocity[b];
      group.position_angular_velocity[b] -= group.delta_angular_velocity[b];
    }
    return result;
  }

 private:
  /// Of what joins rigid bodies all, and of what joins a deformable one to another body the points of the two.
  struct Joints {
    Joints(const GroupSystem& group, const DelassusByContact& w) : of_rigid(group), is_of_block(group.contacts.size()) {
      std::map<std::array<std::pair<int, int>, 2>, std::vector<std::size_t>> pairs;
      for (std::size_t i = 0; i < group.contacts.size(); ++i) {
        const ContactRows& row = group.contacts[i];
        const std::pair<int, int> a{row.a.rigid, row.a.deformable}, b{row.b.rigid, row.b.deformable};
        if (row.kind != RowKind::contact && !of_rigid.holds(i)) pairs[{std::min(a, b), std::max(a, b)}].push_back(i);
      }
      for (const auto& [bodies, points] : pairs) {
        if (points.size() < 2 || points.size() > kMostPoints) continue;
        Block block;
        const auto count_of = [&](std::size_t i) { return group.contacts[i].has_one_row() ? 1 : 3; };
        for (const std::size_t i : points) {
          for (int k = 0; k < count_of(i); ++k) block.rows.emplace_back(i, k);
          is_of_block[i] = true;
        }
        const auto count = static_cast<Eigen::Index>(block.rows.size());
        MatX between(count, count);
        for (Eigen::Index r = 0; r < count; r += count_of(block.rows[static_cast<std::size_t>(r)].first))
          for (Eigen::Index c = 0; c < count; c += count_of(block.rows[static_cast<std::size_t>(c)].first)) {
            const std::size_t i = block.rows[static_cast<std::size_t>(r)].first,
                              j = block.rows[static_cast<std::size_t>(c)].first;
            between.block(r, c, count_of(i), count_of(j)) = w.between(i, j).topLeftCorner(count_of(i), count_of(j));
          }
        const MatX basis = basis_of(0.5 * (between + between.transpose()));
        block.inverse = basis * basis.transpose();
        blocks.push_back(std::move(block));
      }
    }

    struct Block {
      std::vector<std::pair<std::size_t, int>> rows;  // of a contact, which of its three
      MatX inverse;                                   // of W between them, kg
    };
    JointSystem of_rigid;
    std::vector<Block> blocks;
    std::vector<bool> is_of_block;  // by contact
  };
  static constexpr std::size_t kMostPoints = 16;  // of two bodies: more hold each other in sweeps

  static bool bounces(const ContactRows& rows) { return rows.restitution > 0.0 && rows.bound > 0.0; }

  /// Of rigid bodies: sweeps that are not at their end may rebound with more than came. All impulses are made less alike
  /// then, so that together they take nothing and give nothing.
  static void win_nothing(GroupSystem& group) {
    if (std::none_of(group.contacts.begin(), group.contacts.end(), bounces)) return;
    double came = 0.0, left = 0.0;
    for (std::size_t i = 0; i < group.contacts.size(); ++i)
      came += group.lambda[i].dot(group.contact_velocity(i, false)),
          left += group.lambda[i].dot(group.contact_velocity(i, true));
    const double share = passive_share(came, left);
    if (share == 1.0) return;
    for (Vec3& lambda : group.lambda) lambda *= share;
    for (std::size_t b = 0; b < group.rigid.size(); ++b)
      group.delta_velocity[b] *= share, group.delta_angular_velocity[b] *= share;
  }

  template <class Next>
  static void sweep(const GroupSystem& group, const Joints& joints, DelassusByContact& w, const Next& next) {
    check_interrupt();
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      if (joints.of_rigid.holds(i) || joints.is_of_block[i]) continue;
      const Vec3 change = next(i, w.velocity(i)) - group.lambda[i];
      if (!change.isZero(0.0)) w.change(i, change);
    }
    for (const Joints::Block& block : joints.blocks) close(group, block, w);
    close(group, joints.of_rigid, w);
  }

  static void close(const GroupSystem& group, const Joints::Block& block, DelassusByContact& w) {
    VecX u(static_cast<Eigen::Index>(block.rows.size()));
    for (Eigen::Index r = 0; r < u.size(); ++r) {
      const auto [i, k] = block.rows[static_cast<std::size_t>(r)];
      u[r] = w.velocity(i)[k] - (k == 0 ? group.contacts[i].bound : 0.0);
    }
    const VecX impulse = -(block.inverse * u);
    for (Eigen::Index r = 0; r < u.size(); ++r) {
      const auto [i, k] = block.rows[static_cast<std::size_t>(r)];
      w.change(i, impulse[r] * Vec3::Unit(k));
    }
  }

  /// What joins rigid bodies, hard and all at once.
  static void close(const GroupSystem& group, const JointSystem& joints, DelassusByContact& w) {
    std::vector<Vec3> u;
    for (const std::size_t i : joints.contacts()) u.push_back(w.velocity(i) - group.contacts[i].bound * Vec3::UnitX());
    const std::vector<Vec3> impulses = joints.answer(u);
    for (std::size_t k = 0; k < impulses.size(); ++k)
      if (!impulses[k].isZero(0.0)) w.change(joints.contacts()[k], impulses[k]);
  }

  static Vec3 soft_impulse(const ContactRows& rows, const Mat3& w, Vec3 u, Vec3 lambda, const Softness& soft,
                           const ResponseContext& context) {
    if (rows.kind != RowKind::contact || bounces(rows)) {
      u.x() -= rows.bound;
      return relaxed_impulse(rows, w, u, lambda);
    }
    if (!(w(0, 0) > 0.0)) return lambda;
    const double bias = rows.gap > 0.0
                            ? rows.gap / context.time_step
                            : std::max(soft.bias_rate * rows.gap, -context.max_push_out.at(rows.scale.speed));
    const double before = lambda.x();
    lambda.x() = std::max(0.0, before - soft.mass_scale * (u.x() + bias) / w(0, 0) - soft.impulse_scale * before);
    if (rows.has_one_row()) return lambda;
    relax_friction(w, u + w.col(0) * (lambda.x() - before), rows.friction, lambda);
    return lambda;
  }

  struct Settings {
    double frequency = 30.0;  // Hz
    double damping_ratio = 10.0;
    int iterations = 2;        // sweeps of a sub-step
    int relax_iterations = 1;  // sweeps without recovery after them
  } settings_;
};

}  // namespace

Entry<Response> soft_constraint_response() {
  return entry<Response, SoftConstraint>("soft_constraint",
                                         "springs by frequency and damping ratio, a few sweeps: the game engines' way");
}

}  // namespace impinge
