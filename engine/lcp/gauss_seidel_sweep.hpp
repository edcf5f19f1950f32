// What relaxation methods share: one contact solved with the others held, a sweep over all, and when to stop.
#pragma once

#include "engine/lcp/lcp_solver.hpp"

namespace impinge {

/// Solves contact i exactly (the pyramid: row by row) for the operator's present λ, which is `lambda`, and changes
/// both. The velocity at the contact that the change made, m/s.
double relax_contact(const ConeProblem& problem, std::size_t i, std::vector<Vec3>& lambda);

/// relax_contact for each contact in order; the largest change, m/s.
double gauss_seidel_sweep(const ConeProblem& problem, std::vector<Vec3>& lambda);

/// How easily contact i moves: W_ii of one row, of more the mean of its diagonal, 1/kg; 0 where both bodies are held.
double diagonal_scale(const ConeProblem& problem, std::size_t i);

/// u = W λ + q for the operator's present λ.
void velocities(const ConeProblem& problem, std::vector<Vec3>& u);

/// Says when sweeps may end. A residual costs as much as a sweep, so it is only computed when it may be small enough.
class SweepStop {
 public:
  SweepStop(const ConeProblem& problem, const LcpSettings& settings);
  /// Before the first sweep.
  bool solved(const std::vector<Vec3>& lambda);
  /// After a sweep whose largest change was `change`.
  bool solved(const std::vector<Vec3>& lambda, double change);
  /// The last one that was computed, in the settings' measure, relative.
  double residual() const { return residual_; }

 private:
  const ConeProblem& problem_;
  const LcpSettings& settings_;
  double gate_;  // m/s: sweeps that change more than this are not looked at
  double residual_ = 0.0;
  std::vector<Vec3> u_;
};

}  // namespace impinge
