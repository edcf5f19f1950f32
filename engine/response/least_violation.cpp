#include "engine/response/least_violation.hpp"

#include "engine/response/contact_springs.hpp"

namespace impinge {
namespace {

constexpr double kSuspicion = 10.0;  // -q^T λ over λ^T W λ: 1 at an answer, without limit along a ray
// of each row's own mobility; springs this stiff differ from their limit by less than shows
constexpr double kCompliance = 1e-5;
constexpr int kNewtonIterations = 200;

/// J v* - bound along n against the impulses, and the energy norm of what they move.
struct Work {
  double against = 0.0, moved = 0.0;
};

Work work_of(const GroupSystem& group) {
  Work work;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    Vec3 q = group.contact_velocity(i, false);
    work.moved += group.lambda[i].dot(group.contact_velocity(i, true) - q);
    q.x() -= group.contacts[i].bound;
    work.against -= group.lambda[i].dot(q);
  }
  return work;
}

}  // namespace

bool settle_contradiction(GroupSystem& group) {
  const Work before = work_of(group);
  if (!(before.against > kSuspicion * before.moved)) return false;
  GroupSystem softened = group;
  softened.clear_delta();
  const GroupOperator a(softened);
  std::vector<SpringLaw> law;
  for (std::size_t i = 0; i < group.contacts.size(); ++i) {
    const double mobility = a.block_mobility(i)(0, 0);
    const double slope = mobility > 0.0 ? 1.0 / (kCompliance * mobility) : 0.0;
    law.push_back({group.contacts[i].kind, slope, slope * group.contacts[i].bound});
  }
  SpringSolver linear(softened, a);
  const bool solved = solve_springs(a, law, 1e-8, kNewtonIterations, softened, linear).converged;
  if (!apply_springs(a, softened, linear) || !solved) return false;
  // an answer exists where springs this stiff are hardly compressed: their work is small beside what they move
  const Work after = work_of(softened);
  if (!(after.against > kSuspicion * after.moved)) return false;
  group.lambda = std::move(softened.lambda);
  group.delta_velocity = std::move(softened.delta_velocity);
  group.delta_angular_velocity = std::move(softened.delta_angular_velocity);
  group.deformable_delta = std::move(softened.deformable_delta);
  return true;
}

}  // namespace impinge
