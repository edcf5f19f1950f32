#include "engine/response/spring_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/response/operators/delassus_of.hpp"
#include "engine/response/operators/factor_worth.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostContacts = 1000;  // with deformable bodies, by whose rows or nodes H W + 1 is dense
// of six sparse rows a body, in steps of gradients: the pattern, and each system
constexpr double kOfRigid = 60.0, kOfRigidSystem = 10.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

SpringSolver::SpringSolver(GroupSystem& group, const GroupOperator& a, double patience) : group_(group), a_(a) {
  left_ = patience < kNever ? patience * steps_of_factor() : kNever;
  if (!(left_ > 0.0)) factorize();
}

double SpringSolver::steps_of_factor() const {
  if (group_.deformable.empty()) return kOfRigid;
  if (group_.contacts.size() > kMostContacts) return kNever;
  const std::optional<FactorWorth> worth = factor_worth(group_);
  return worth ? worth->steps : kNever;
}

double SpringSolver::steps_of_system(const std::vector<Mat3>& h) const {
  if (group_.deformable.empty()) return kOfRigidSystem;
  const auto acting = std::count_if(h.begin(), h.end(), [](const Mat3& m) { return !m.isZero(0.0); });
  return steps_of_work(std::pow(3.0 * static_cast<double>(acting), 3) * 2.0 / 3.0, group_);
}

void SpringSolver::weigh(double steps, const std::vector<Mat3>& h) {
  if (left_ == kNever) return;
  left_ -= std::max(0.0, steps - steps_of_system(h));
  if (left_ <= 0.0) factorize();
}

void SpringSolver::factorize() {
  left_ = kNever;
  ConeProblem problem = make_cone_problem(group_);
  try {
    w_ = delassus_of(group_);
  } catch (const DivergenceError&) {  // A is not positive definite: gradients go on as far as they can
    return;
  }
  problem.w = w_.get();
  system_ = newton_system(problem);
}

void SpringSolver::solve(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x) {
  if (solve_by_factor(h, b, x)) return;
  x = VecX::Zero(b.size());
  int steps = 0;
  a_.solve(h, b, tolerance, x, &steps);
  weigh(steps, h);
}

void SpringSolver::solve_unsymmetric(const std::vector<Mat3>& h, const VecX& b, double tolerance, VecX& x) {
  if (solve_by_factor(h, b, x)) return;
  x = VecX::Zero(b.size());
  int steps = 0;
  a_.solve_unsymmetric(h, b, tolerance, x, &steps);
  weigh(2.0 * steps, h);
}

bool SpringSolver::free(const VecX& b, double tolerance, VecX& x) const {
  if (is_factorized()) {
    x = free_by_factor(b);
    return x.allFinite();
  }
  x = VecX::Zero(b.size());
  return a_.solve({}, b, tolerance, x);
}

bool SpringSolver::solve_by_factor(const std::vector<Mat3>& h, const VecX& b, VecX& x) {
  if (!is_factorized()) return false;
  const auto part = [](std::size_t i) { return 3 * static_cast<Eigen::Index>(i); };
  const std::vector<Mat3> ones(h.size(), Mat3::Identity());
  std::vector<char> act(h.size());
  x = free_by_factor(b);
  VecX right(part(h.size())), y;
  for (std::size_t i = 0; i < h.size(); ++i) {
    act[i] = !h[i].isZero(0.0);
    right.segment<3>(part(i)) = h[i] * a_.row(i, x);
  }
  system_->factorize(h, ones, act);
  system_->solve(right, y);
  VecX rest = b;
  for (std::size_t i = 0; i < h.size(); ++i)
    if (act[i]) a_.add_impulse(i, -y.segment<3>(part(i)), rest);
  x = free_by_factor(rest);
  return x.allFinite();
}

VecX SpringSolver::free_by_factor(const VecX& b) const {
  VecX x(b.size()), part;
  Eigen::Index at = 0;
  for (const RigidBlock& body : group_.rigid) {
    x.segment<3>(at) = body.inverse_mass * b.segment<3>(at);
    x.segment<3>(at + 3) = body.inverse_inertia * b.segment<3>(at + 3);
    at += 6;
  }
  for (const DeformableBlock& block : group_.deformable) {
    const Eigen::Index size = block.velocity.size();
    block.solver->solve(VecX(b.segment(at, size)), part);
    x.segment(at, size) = part;
    at += size;
  }
  return x;
}

}  // namespace impinge
