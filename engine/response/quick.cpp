// The game engines' way at its best: contacts are found once, then a few short solver steps follow the bodies within the
// sub-step ("small steps"), each with a sweep or two over packed contacts. A solver step gives its share of the forces,
// starts from the last one's impulses, answers to gaps as they are by now, moves, and then relaxes the velocities without
// recovery, so that what was pushed out doesn't fly on. Recovery on positions alone was tried in its place: it starts from
// nothing each time, and piles sink. What a stack owes its rest to (tests/README.md, "What keeps stacks awake"): a
// sub-step starts from the last solver step's impulses, not from the mean of all, which is half a sub-step late, and the
// springs are no stiffer than a sweep can follow. Built for a frame rate, so to be known exactly:
// - the number of steps and sweeps is fixed, and nothing is said of convergence: the judge says how far it came.
// - arms and normals stay those of the sub-step's start, so Δv = A⁻¹ J^T λ to rounding, with λ the sum of all steps.
// - what is only pinned to others moves by its velocity at the end, as with the exact methods: by the mean over the solver steps, as
//   what touches does, a pendulum would win energy from arms of the start (its amplitude doubled in a minute).
// - friction is Coulomb's cone in each solver step, by projection. Impacts come first, each as a collision of its pair.
// - joints of rigid bodies that share one are factored as one system, answered after the contacts of each sweep: from joint to
//   joint a chain lost what each link hands on, and won it back as energy. A group that is only attached is solved in one step.
// - groups with deformable bodies, whose positions follow from A as a whole, go to sequential impulses.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/response/packed_contacts.hpp"
#include "engine/response/response.hpp"

namespace impinge {

Entry<Response> sequential_impulse_response();

namespace {

class Quick : public Response {
 public:
  void declare(const Rows& rows) override {
    rows.add("steps", settings_.steps, {1, 1000, true}, "",
             "Solver steps of a sub-step: contacts are found once for all of them.");
    rows.add("sweeps", settings_.sweeps, {1, 1000}, "", "Sweeps of a solver step that move the bodies.");
    rows.add("relax_sweeps", settings_.relax_sweeps, {0, 1000}, "",
             "Sweeps of a solver step after the motion, which take out the velocity that recovery brought.");
    rows.add("frequency", settings_.frequency, {0.0, 1e6, true}, "Hz",
             "Of the spring that takes overlap out; at most 0.22 of the solver steps' rate is used.");
    rows.add("damping_ratio", settings_.damping_ratio, {0.0, 1e6}, "", "Of that spring, 1 is critical.");
    others_limit_ = rows.add("deformable_iterations", *others_->iteration_setting().count, {1, 1000000, true}, "",
                             "Sweeps at most for a group with deformable bodies, which goes to sequential impulses.")
                        .path();
  }

  bool uses_cone_solver() const override { return false; }
  bool is_approximate() const override { return true; }
  IterationSetting iteration_setting() override { return {&settings_.steps, true}; }
  std::string summary(const LcpSettings&) const override {
    return fmt::format("{} steps of {} + {} sweeps", settings_.steps, settings_.sweeps, settings_.relax_sweeps);
  }

  ResponseResult solve(GroupSystem& group, const LcpSolver& solver, const ResponseContext& context) const override {
    // one solve of joints is exact, and linear in the forces; what is only pinned moves by the velocity at the end
    const bool is_only_joined = PackedContacts::is_only_joined(group);
    if (!group.deformable.empty() || (context.recovers_overlap && !is_only_joined)) {
      ResponseResult of_others = others_->solve(group, solver, context);
      if (of_others.ended == StopReason::iteration_cap) of_others.limit = others_limit_;
      return of_others;
    }
    const int steps = is_only_joined ? 1 : settings_.steps;
    const double h = context.time_step / steps;
    const Vec3 change = context.time_step * context.gravity, part = change / steps;
    group.clear_delta();
    PackedContacts packed(group, change, context.share / steps, context.max_push_out, context.restitution_threshold);
    ResponseResult result;
    result.iterations = packed.collide(group, change, context.time_step, kMostRounds);
    show(group, packed, Vec3::Zero(), context);
    const double hertz = std::min(settings_.frequency, kStiffest / h);
    SweepLaw law;
    law.time_step = h;
    law.between = soft_law(hertz, settings_.damping_ratio, h);
    law.fixed = soft_law(2.0 * hertz, settings_.damping_ratio, h);
    for (int k = 1; k <= steps; ++k) {
      packed.accelerate(part);
      packed.warm_start();
      law.recovers = true;
      for (int i = 0; i < settings_.sweeps; ++i, ++result.iterations) packed.sweep(law);
      packed.move(h);
      law.elapsed = k * h;
      law.recovers = false;
      for (int i = 0; i < settings_.relax_sweeps; ++i, ++result.iterations) packed.sweep(law);
      packed.close_step();
      show(group, packed, k * part, context);
    }
    packed.write(group, change, context.time_step);
    return result;
  }

 private:
  static constexpr int kMostRounds = 200;    // of impacts
  static constexpr double kStiffest = 0.22;  // of the solver steps' rate

  static void show(GroupSystem& group, const PackedContacts& packed, const Vec3& change,
                   const ResponseContext& context) {
    if (!context.observe) return;
    packed.write(group, change, 0.0);
    context.observe(group);
  }

  struct Settings {
    int steps = 6;
    int sweeps = 1, relax_sweeps = 1;
    double frequency = 1e6;  // Hz
    double damping_ratio = 1.0;
  } settings_;
  std::string others_limit_;
  std::unique_ptr<Response> others_ = sequential_impulse_response().make();
};

}  // namespace

Entry<Response> quick_response() {
  return entry<Response, Quick>("quick", "short solver steps over packed contacts: piles at a frame rate");
}

}  // namespace impinge
