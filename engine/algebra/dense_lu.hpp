// LU of a dense matrix with partial pivoting, on all cores.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// The same bits for any number of threads, and on processors with wide vectors as on others.
class DenseLu {
 public:
  /// P A = L U, in a's place.
  void compute(MatX a);
  /// x = A⁻¹ b; not finite where A is singular.
  VecX solve(const VecX& b) const;

 private:
  MatX lu_;
  std::vector<int> swaps_;  // row k went to row swaps_[k] before column k was eliminated
};

}  // namespace impinge
