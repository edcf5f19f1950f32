// The matrix M + Jᵀ G J in the velocities of rigid bodies, six a body, with one 3 x 3 block G a contact: its size knows
// nothing of the contacts' number. Factorized by 6 x 6 blocks in an order that keeps fill small, A = L D U with pivots
// only within a body's block; G needn't be symmetric.
#pragma once

#include <span>

#include "engine/lcp/body_space.hpp"

namespace impinge {

class BodyMatrix {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;

  /// The pattern and its order, once for all G; refers to `bodies`.
  explicit BodyMatrix(const BodySpace& bodies);

  /// Takes G, by contact.
  void factorize(std::span<const Mat3> g);
  /// x = (M + Jᵀ G J)⁻¹ x, 6 numbers a body: linear, then angular. Not finite where the matrix is singular.
  void solve(VecX& x) const;

 private:
  /// Where the blocks of a contact are: its bodies, and which entry couples them.
  struct Place {
    int entry = -1;             ///< of lower_ and upper_; none: only one body, or twice the same
    bool first_is_row = false;  ///< whether the first body's row and the second's column lie in lower_
  };

  void find_order();
  std::vector<std::vector<int>> find_fill() const;
  void put_panels_together(std::vector<std::vector<int>>& below);
  void find_panels(std::vector<std::vector<int>>& below);
  void find_places();
  void assemble(std::span<const Mat3> g);
  void eliminate(int k, int end);
  void eliminate_panel(int first, int end);

  const BodySpace& bodies_;
  std::vector<int> position_;         // of each body in the order of elimination
  std::vector<int> start_, row_;      // below the diagonal, column by column: the rows, ascending
  std::vector<int> panel_;            // where one begins, and the end
  std::vector<Place> places_;         // by contact
  std::vector<Block> diagonal_;       // by position; factorized: its inverse
  std::vector<Block> lower_, upper_;  // A(row, column) and, transposed, A(column, row); factorized: L and U
};

}  // namespace impinge
