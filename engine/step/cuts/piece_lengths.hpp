// How much of a sub-step its next piece tries. What cuts one piece is near to the next as a rule, and a long motion that
// comes to nothing is the dearest: it comes upon many bodies, has the most contacts and is looked at the most. So where
// much was made in vain, from then on a piece that follows a cut is no longer than what came of it, and the next one twice as
// long if it was not cut: the sub-step costs about what one divided from the beginning costs.
#pragma once

#include <algorithm>
#include <cstddef>

namespace impinge {

class PieceLengths {
 public:
  /// The most pieces a sub-step may have, and the least share of it that one is tried with.
  PieceLengths(int most_pieces, double least) : most_pieces_(most_pieces), least_(least) {}

  /// A motion with so many contacts was made in vain.
  void made_in_vain(std::size_t contacts) { vain_ += contacts; }
  /// The next one is made with a share of its length.
  void cut() { is_cut_ = true; }
  /// After a piece, of which `rest` of the sub-step is left: the share of the whole that the next one tries at most.
  /// `wanted`: without all this.
  double next(double wanted, double rest) {
    const double share = rest_ - rest;
    rest_ = rest, ++pieces_;
    usual_ = is_cut_ ? share : kGrowth * usual_;
    is_cut_ = false;
    if (pieces_ >= most_pieces_) return 1.0;
    if (vain_ > kMuch) wanted = std::min(wanted, std::max(usual_, kSpare * rest / (most_pieces_ - pieces_)));
    return std::max(least_, wanted);
  }

 private:
  static constexpr std::size_t kMuch = 2048;  // contacts of all motions that came to nothing
  static constexpr double kGrowth = 2.0;
  static constexpr double kSpare = 8.0;  // over an even share of the pieces that are left

  int most_pieces_, pieces_ = 0;
  double least_, rest_ = 1.0, usual_ = 1.0;
  std::size_t vain_ = 0;
  bool is_cut_ = false;
};

}  // namespace impinge
