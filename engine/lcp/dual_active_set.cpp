// Contacts without friction, exactly: the dual active-set method of [GoldfarbIdnani83]. Of the velocities with which nothing
// closes further those are sought that are nearest to the free ones, in the measure of the masses: the contact that is violated
// most is taken into the set of those that carry, and those that would have to pull leave it. No set comes back, since what
// is sought only grows: a chain of links whose hundred contacts Newton's method tries in hundreds of steps takes some pivots
// more than contacts carry, each in the square of those.
//
// Redundant contacts make W singular, and forces arbitrary: among those that answer it the ones nearest to what came are
// taken, by steps of a proximal point method with a weight that is next to nothing. The second step takes out what the
// weight of the first did, and rounding; it goes on with the same set, which it changes seldom.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "engine/algebra/growing_cholesky.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/lcp/body_space.hpp"
#include "engine/lcp/gauss_seidel_sweep.hpp"

namespace impinge {
namespace {

constexpr double kProximal = 1e-10;  // of the proximal term, over W's diagonal
constexpr int kMostSteps = 6;
constexpr double kStepGain = 0.3;   // what a step has to leave of the residual of the last
constexpr double kViolated = 0.01;  // of the tolerance
constexpr double kBeyond = 1e3;  // times as fast as all that is asked for: no motion that anybody would call an answer
constexpr double kFlat = 1e-6;   // of W's diagonal: what a row moves beside the others
constexpr double kRounding = 4e-16;
constexpr std::size_t kMostActiveRows = 3000;

/// Entries of W between scalar rows 3 i + k.
class NormalEntries {
 public:
  NormalEntries(Delassus& w, const std::vector<int>& rows) : bodies_(w.body_space()), rows_(rows) {
    if (bodies_ == nullptr)
      dense_ = w.dense();
    else
      masses_ = std::make_unique<InverseMasses>(*bodies_);
  }
  /// Of row p with each of the others.
  VecX column(int p, const std::vector<int>& others) const {
    VecX column(static_cast<Eigen::Index>(others.size()));
    if (bodies_ == nullptr) {
      for (std::size_t k = 0; k < others.size(); ++k) column[k] = dense_(rows_[p], rows_[others[k]]);
      return column;
    }
    std::array<BodySpace::Six, 2> moves;
    const auto& sides = bodies_->sides[rows_[p] / 3];
    for (int s = 0; s < 2; ++s)
      if (sides[s].body >= 0) moves[s] = masses_->of(sides[s].body, sides[s].row[rows_[p] % 3]);
    for (std::size_t k = 0; k < others.size(); ++k) {
      column[k] = 0.0;
      for (const BodySpace::Side& other : bodies_->sides[rows_[others[k]] / 3])
        for (int s = 0; s < 2; ++s)
          if (other.body >= 0 && other.body == sides[s].body)
            column[k] += other.row[rows_[others[k]] % 3].dot(moves[s]);
    }
    return column;
  }

 private:
  const BodySpace* bodies_;
  const std::vector<int>& rows_;
  std::unique_ptr<InverseMasses> masses_;
  MatX dense_;
};

class ActiveSet {
 public:
  ActiveSet(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda)
      : problem_(problem),
        settings_(settings),
        lambda_(lambda),
        u_(lambda.size()),
        rows_(moving_rows(problem)),
        entries_(*problem.w, rows_) {
    for (const int row : rows_) {
      diagonal_.push_back(problem.w->diagonal(row / 3)(row % 3, row % 3));
      is_free_.push_back(problem.kind_of(row / 3) != RowKind::contact);
    }
  }

  LcpResult run() {
    if (settings_.history != nullptr) settings_.history->push_back(0.0);
    double residual = look();
    if (residual <= settings_.tolerance) return {0, StopReason::converged};
    scale_ = velocity_scale(problem_), violated_ = kViolated * settings_.tolerance * scale_;
    std::vector<Vec3> best = lambda_;
    improve(best, residual);
    if (!(residual <= settings_.tolerance) && !contradicts_ &&
        !is_spent()) {  // what it began with may have been in the way
      std::fill(lambda_.begin(), lambda_.end(), Vec3::Zero());
      improve(best, residual);
    }
    if (!contradicts_) lambda_ = std::move(best);
    residual = look();
    if (residual <= settings_.tolerance) return {iterations_, StopReason::converged};
    if (contradicts_) return {iterations_, StopReason::contradiction};
    return {iterations_, is_spent() ? StopReason::iteration_cap : StopReason::stagnated};
  }

 private:
  static std::vector<int> moving_rows(const ConeProblem& problem) {
    std::vector<int> rows = rows_of(problem);
    std::erase_if(rows, [&](int row) { return !(problem.w->diagonal(row / 3)(row % 3, row % 3) > 0.0); });
    return rows;
  }

  /// The relative residual of λ, also for the last line of the history.
  double look() {
    problem_.w->begin(lambda_);
    velocities(problem_, u_);
    const double residual = relative_residual(problem_, u_, lambda_, settings_.measure);
    if (settings_.history != nullptr) settings_.history->back() = residual;
    return residual;
  }
  bool is_spent() const { return iterations_ >= settings_.max_iterations; }
  void spend() {
    ++iterations_;
    if (settings_.history != nullptr) settings_.history->push_back(settings_.history->back());
  }

  void write() {
    for (std::size_t r = 0; r < rows_.size(); ++r)
      lambda_[rows_[r] / 3][rows_[r] % 3] = is_free_[r] != 0 ? x_[r] : std::max(0.0, x_[r]);
  }

  double weight(int r) const { return kProximal * diagonal_[r]; }

  double lambda(int r) const { return lambda_[rows_[r] / 3][rows_[r] % 3]; }
  double q(int r) const { return problem_.q[rows_[r] / 3][rows_[r] % 3]; }

  /// Proximal steps from λ; the best goes to `best`.
  void improve(std::vector<Vec3>& best, double& residual) {
    gather();
    for (int step = 0; step < kMostSteps && minimise(); ++step) {
      write();
      const double now = look(), before = residual;
      const bool is_within = now <= settings_.tolerance;
      if (is_within || now < residual) best = lambda_, residual = now;
      if (step > 0 && (is_within || !(now < kStepGain * before))) break;
    }
  }

  /// The set that λ carries by, equations first.
  void gather() {
    const auto n = static_cast<int>(rows_.size());
    factor_ = {}, active_.clear();
    x_ = VecX::Zero(n), linear_.resize(n);
    for (const bool free : {true, false})
      for (int r = 0; r < n; ++r)
        if ((is_free_[r] != 0) == free && (free || lambda(r) > 0.0))
          add(r, factor_.forward(entries_.column(r, active_)));
    spend();  // all of these at once
  }

  /// ½ xᵀ W x + qᵀ x + ½ Σ weight (x - λ)² with x >= 0 where it isn't free, from the set that there is. Whether the end was
  /// reached.
  bool minimise() {
    for (int r = 0; r < static_cast<int>(rows_.size()); ++r) linear_[r] = q(r) - weight(r) * lambda(r);
    while (!balance())
      if (is_spent()) return false;
    for (;;) {
      const int p = most_violated();
      if (p < 0) return true;
      if (!take_in(p)) return false;
    }
  }

  /// Row r into the set; `row`: of its factor.
  void add(int r, const VecX& row) {
    factor_.add(row, std::max(weight(r), diagonal_[r] + weight(r) - row.squaredNorm()));
    active_.push_back(r);
  }
  void drop(std::size_t place) {
    x_[active_[place]] = 0.0;
    factor_.remove(static_cast<Eigen::Index>(place));
    active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(place));
    spend();
  }

  /// x of the set; false if it had to let one go, which pulled most.
  bool balance() {
    VecX b(static_cast<Eigen::Index>(active_.size()));
    for (std::size_t k = 0; k < active_.size(); ++k) b[k] = -linear_[active_[k]];
    const VecX x = factor_.backward(factor_.forward(b));
    int worst = -1;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      x_[active_[k]] = x[k];
      if (is_free_[active_[k]] == 0 && x[k] < 0.0 && (worst < 0 || x[k] < x[worst])) worst = static_cast<int>(k);
    }
    if (worst >= 0) drop(worst);
    return worst < 0;
  }

  /// Of those outside the set; -1: none. In u_ are the velocities then.
  int most_violated() {
    check_interrupt();
    std::vector<Vec3> x(lambda_.size(), Vec3::Zero());
    for (const int r : active_) x[rows_[r] / 3][rows_[r] % 3] = x_[r];
    problem_.w->begin(x);
    velocities(problem_, u_);
    std::vector<char> is_in(rows_.size(), 0);
    for (const int r : active_) is_in[r] = 1;
    int worst = -1;
    double most = 0.0;
    for (int r = 0; r < static_cast<int>(rows_.size()); ++r) {
      if (is_in[r] != 0) continue;
      const double u = u_[rows_[r] / 3][rows_[r] % 3] + linear_[r] - q(r);
      if (u < -violated_ && u < most * std::sqrt(diagonal_[r]))
        most = u / std::sqrt(diagonal_[r]), worst = r, violation_ = u;
    }
    return worst;
  }

  /// Row p, whose u is violation_, into the set, and out of it what would pull. False where the iterations end.
  bool take_in(int p) {
    double u = violation_;
    while (!is_spent()) {
      const VecX row = factor_.forward(entries_.column(p, active_));
      const VecX r = factor_.backward(row);
      const double rest = std::max(weight(p), diagonal_[p] + weight(p) - row.squaredNorm());
      double length = -u / rest;
      int leaves = -1;
      for (std::size_t k = 0; k < active_.size(); ++k)
        if (is_free_[active_[k]] == 0 && r[k] > 0.0 && x_[active_[k]] < length * r[k])
          length = std::max(0.0, x_[active_[k]]) / r[k], leaves = static_cast<int>(k);
      if (leaves < 0 && rest < kFlat * diagonal_[p] && find_contradiction(p, r)) return false;
      for (std::size_t k = 0; k < active_.size(); ++k) x_[active_[k]] -= length * r[k];
      x_[p] += length;
      u += length * rest;
      if (leaves < 0) {
        add(p, row);
        spend();
        return true;
      }
      drop(leaves);
    }
    return false;
  }

  /// Whether rows say the opposite of each other: forces z of which nothing moves push against what is asked for. With any λ
  /// zᵀ u is zᵀ q and at most √(zᵀ W z) times what λ moves, in the measure of the masses, and has to be more than nothing.
  /// λ is a ray of such forces then. `r`: of row p by those of the set.
  bool find_contradiction(int p, VecX r) {
    std::vector<Vec3> z(lambda_.size(), Vec3::Zero());
    const auto take = [&](int row, double share) {
      if (is_free_[row] != 0 || share > 0.0) z[rows_[row] / 3][rows_[row] % 3] = share;
    };
    const auto moves = [&](int row) { return u_[rows_[row] / 3][rows_[row] % 3] - q(row); };  // W z
    for (int pass = 0;; ++pass) {
      take(p, 1.0);
      for (std::size_t k = 0; k < active_.size(); ++k) take(active_[k], -r[k]);
      problem_.w->begin(z);
      velocities(problem_, u_);
      if (pass > 0) break;
      VecX left(static_cast<Eigen::Index>(active_.size()));  // the factor's weights are no part of W
      for (std::size_t k = 0; k < active_.size(); ++k) left[k] = moves(active_[k]);
      r += factor_.backward(factor_.forward(left));
    }
    double moved = 0.0, against = 0.0, sum = 0.0, rounding = 0.0, least = INFINITY, most = 0.0;
    for (int row = 0; row < static_cast<int>(rows_.size()); ++row) {
      const double of = z[rows_[row] / 3][rows_[row] % 3];
      least = std::min(least, diagonal_[row]), most = std::max(most, std::abs(of));
      moved += of * moves(row);
      against -= of * q(row);
      sum += std::abs(of), rounding += kRounding * of * of * diagonal_[row];
    }
    const double in_reach = kBeyond * scale_ / std::sqrt(least);
    contradicts_ = against > settings_.tolerance * scale_ * sum + std::sqrt(std::max(moved, rounding)) * in_reach;
    if (!contradicts_) return false;
    for (std::size_t i = 0; i < z.size(); ++i) lambda_[i] = scale_ / (diagonal_[p] * most) * z[i];
    return true;
  }

  const ConeProblem& problem_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  std::vector<Vec3> u_;
  const std::vector<int> rows_;  // 3 i + k of row k of contact i; below all rows are places in it
  const NormalEntries entries_;
  std::vector<double> diagonal_;
  std::vector<char> is_free_;
  std::vector<int> active_;
  GrowingCholesky factor_;  // of W and the weights, in the order of active_
  VecX x_, linear_;
  double scale_ = 0.0, violated_ = 0.0, violation_ = 0.0;  // m/s
  bool contradicts_ = false;
  int iterations_ = 0;
};

class DualActiveSet : public LcpSolver {
 public:
  LcpResult solve(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda) const override {
    if (problem.q.empty()) return {};
    if (!applies(problem).empty()) return {0, StopReason::refused};
    return ActiveSet(problem, settings, lambda).run();
  }
  std::string applies(const ConeProblem& problem) const override {
    for (std::size_t i = 0; i < problem.q.size(); ++i)
      if (problem.kind_of(i) == RowKind::contact && problem.mu[i] != 0.0)
        return "contact with friction is no quadratic program; it solves problems without";
    const std::size_t rows = rows_of(problem).size();
    if (rows > kMostActiveRows) return std::to_string(rows) + " rows; it goes up to " + std::to_string(kMostActiveRows);
    return "";
  }
};

}  // namespace

Entry<LcpSolver> dual_active_set_solver() {
  return entry<LcpSolver, DualActiveSet>("dual_active_set",
                                         "Goldfarb and Idnani's method, exact: contacts without friction");
}

}  // namespace impinge
