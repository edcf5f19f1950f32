#include "engine/lcp/newton_search.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"
#include "engine/lcp/smoothed_alart_curnier.hpp"

namespace impinge {
namespace {

constexpr int kHalvings = 7;
constexpr double kLittle = 0.6;              // of ‖F‖²: what a step leaves that is not held back
constexpr double kAlike = 0.01;              // of the same: what may differ from what α asked for
constexpr std::size_t kMostContacts = 6000;  // W written out takes 2.6 GB then

}  // namespace

NewtonSearch::NewtonSearch(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
    : problem_(problem),
      settings_(settings),
      lambda_(lambda),
      n_(lambda.size()),
      system_(newton_system(problem)),
      u_(n_),
      trial_(n_),
      a_(n_),
      b_(n_),
      kept_(n_) {
  for (std::size_t i = 0; i < n_; ++i) {
    rho_.push_back(alart_curnier_scale(problem, i));
    scale_.push_back(diagonal_scale(problem, i));
  }
}

bool NewtonSearch::sweep() {
  problem_.w->begin(lambda_);
  gauss_seidel_sweep(problem_, lambda_);
  ++iterations_;
  return measure();
}

bool NewtonSearch::measure() {
  std::vector<Vec3> inside(n_);
  for (std::size_t i = 0; i < n_; ++i) inside[i] = problem_.nearest(i, lambda_[i]);
  problem_.w->begin(inside);
  velocities(problem_, u_);
  residual_ = relative_residual(problem_, u_, inside, settings_.measure);
  note(residual_);
  if (best_.empty() || residual_ < best_residual_) {
    best_ = std::move(inside);
    best_residual_ = residual_;
  }
  return residual_ <= settings_.tolerance;
}

void NewtonSearch::note(double residual) const {
  if (settings_.history != nullptr) settings_.history->push_back(residual);
}

LcpResult NewtonSearch::finish(StopReason reason) {
  lambda_ = best_;
  return {iterations_, reason};
}

void NewtonSearch::find_velocities(const std::vector<Vec3>& lambda) {
  problem_.w->begin(lambda);
  velocities(problem_, u_);
  if (compliance_ > 0.0)
    for (std::size_t i = 0; i < n_; ++i)
      if (problem_.kind_of(i) == RowKind::contact) u_[i] += compliance_ * scale_[i] * lambda[i];
}

double NewtonSearch::merit(const std::vector<Vec3>& lambda) {
  check_interrupt();
  find_velocities(lambda);
  double sum = 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    const Vec3 f = width_ > 0.0 ? smoothed_alart_curnier_value(problem_, i, u_[i], lambda[i], rho_[i], width_)
                                : alart_curnier_value(problem_, i, u_[i], lambda[i], rho_[i]);
    if (rho_[i].x() > 0.0) sum += f.x() * f.x() / (rho_[i].x() * rho_[i].x());
    if (rho_[i].y() > 0.0) sum += f.tail<2>().squaredNorm() / (rho_[i].y() * rho_[i].y());
  }
  return sum;
}

bool NewtonSearch::find_direction(double alpha) {
  VecX f(static_cast<Eigen::Index>(3 * n_));
  for (std::size_t i = 0; i < n_; ++i) {
    const AlartCurnier e = width_ > 0.0 ? smoothed_alart_curnier(problem_, i, u_[i], lambda_[i], rho_[i], width_)
                                        : alart_curnier(problem_, i, u_[i], lambda_[i], rho_[i]);
    const double soft = problem_.kind_of(i) == RowKind::contact ? alpha + compliance_ : alpha;
    a_[i] = e.by_u;
    b_[i] = e.by_lambda + soft * scale_[i] * e.by_u;
    kept_[i] = !e.open;
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) = -e.value;
  }
  system_->factorize(a_, b_, kept_);
  system_->solve(f, direction_);
  return direction_.allFinite();
}

bool NewtonSearch::is_held_back(double alpha, double now, double before) const {
  if (!(now > kLittle * before)) return false;
  double sum = 0.0;
  for (std::size_t i = 0; i < n_; ++i) {
    const Vec3 f = width_ > 0.0 ? smoothed_alart_curnier_value(problem_, i, u_[i], lambda_[i], rho_[i], width_)
                                : alart_curnier_value(problem_, i, u_[i], lambda_[i], rho_[i]);
    // (A W + B) d = -F with α D in B: of linear equations -α A D d is left; those of open contacts have no A
    const Vec3 other = kept_[i] ? Vec3(f + alpha * scale_[i] * (a_[i] * direction(i))) : f;
    if (rho_[i].x() > 0.0) sum += other.x() * other.x() / (rho_[i].x() * rho_[i].x());
    if (rho_[i].y() > 0.0) sum += other.tail<2>().squaredNorm() / (rho_[i].y() * rho_[i].y());
  }
  return sum <= kAlike * now;
}

double NewtonSearch::search(double& now) {
  double worst = now;
  const std::size_t compared = std::min(course_.size(), kMemory - 1);
  for (auto m = course_.end() - static_cast<std::ptrdiff_t>(compared); m != course_.end(); ++m)
    worst = std::max(worst, *m);
  double length = 1.0;
  for (int k = 0; k <= kHalvings; ++k, length *= 0.5) {
    for (std::size_t i = 0; i < n_; ++i) trial_[i] = lambda_[i] + length * direction(i);
    const double there = merit(trial_);
    if (!(there <= (1.0 - 1e-4 * length) * worst)) continue;
    lambda_ = trial_;
    course_.push_back(now);
    if (course_.size() > kMemory + 1) course_.pop_front();
    now = there;
    return length;
  }
  find_velocities(lambda_);
  return 0.0;
}

std::string newton_applies(const ConeProblem& problem) {
  if (problem.q.size() <= kMostContacts) return "";
  if (problem.w != nullptr && (problem.w->body_space() != nullptr || problem.w->node_space() != nullptr)) return "";
  return std::to_string(problem.q.size()) + " contacts; it writes W out, which is done up to " +
         std::to_string(kMostContacts);
}

}  // namespace impinge
