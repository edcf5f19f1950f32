// What Newton's methods on Alart and Curnier's equations share: the equations at a λ, a direction, and a search along
// it. W is taken as W + α D for a direction, with D the scale of its diagonal blocks: α makes redundant contacts (a
// singular W) harmless without moving the solution.
#pragma once

#include <deque>

#include "engine/lcp/alart_curnier.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/lcp/newton_system.hpp"

namespace impinge {

class NewtonSearch {
 protected:
  NewtonSearch(const ConeProblem& problem, const LcpSettings& settings, std::vector<Vec3>& lambda);

  static constexpr double kSmallest = 1e-12, kLargest = 1.0;  // α
  static constexpr std::size_t kMemory = 10;                  // steps that a new one is compared with

  /// Rounds the equations off (smoothed_alart_curnier.hpp) over `width`, m/s, and adds `compliance` D to W; 0 and 0:
  /// they are exact.
  void soften(double width, double compliance) { width_ = width, compliance_ = compliance; }

  /// A Gauss-Seidel sweep, which counts as an iteration; whether it solved the problem.
  bool sweep();
  /// The exact residual of λ brought into its cones; keeps the best. Whether it is within the tolerance.
  bool measure();
  void note(double residual) const;
  LcpResult finish(StopReason reason);

  /// ‖F‖² in velocities, at a λ.
  double merit(const std::vector<Vec3>& lambda);
  /// Newton's, from the present λ, which merit() was asked of last or search() has come to; false if there is none.
  bool find_direction(double alpha);
  /// Goes to the longest of the lengths 1, 1/2, 1/4, ... of which F has shrunk against the worst of the last few, and
  /// returns it; 0 if there is none (λ is as before). `now`: the merit of λ, in and out.
  double search(double& now);
  /// Whether what is left of F after a whole step is what `alpha` asked to be left, and much: the equations are linear so far,
  /// and α is what keeps λ from their answer. `now`: the merit of λ, `before`: where the step began.
  bool is_held_back(double alpha, double now, double before) const;
  Vec3 direction(std::size_t i) const { return direction_.segment<3>(3 * static_cast<Eigen::Index>(i)); }

  const ConeProblem& problem_;
  const LcpSettings& settings_;
  std::vector<Vec3>& lambda_;
  const std::size_t n_;
  std::vector<Vec3> best_;
  std::deque<double> course_;  // merits that were stepped from, kMemory + 1 at most
  double residual_ = 0.0, best_residual_ = 0.0;
  int iterations_ = 0;

 private:
  void find_velocities(const std::vector<Vec3>& lambda);

  std::unique_ptr<NewtonSystem> system_;
  std::vector<Vec2> rho_;
  std::vector<double> scale_;  // D
  std::vector<Vec3> u_, trial_;
  std::vector<Mat3> a_, b_;
  std::vector<char> kept_;
  VecX direction_;
  double width_ = 0.0, compliance_ = 0.0;
};

/// Why Newton's methods can't solve a problem; "" if they can.
std::string newton_applies(const ConeProblem& problem);

}  // namespace impinge
