// Friction-contact problems as Siconos publishes them in plain text: W, q and mu of one time step, without geometry.
// The numbers, separated by blanks or line ends, are
//   3                                          dimension of a contact's rows: normal first, then two tangents
//   contacts
//   storage of W: 0 dense, 1 block sparse
//   rows columns                               of W: 3 contacts each
//   dense: rows columns (again), then the values column by column
//   block sparse: blocks, block rows, block columns, the end of each block row and column in scalars, the lengths of
//     index1 and index2, index1 (where each block row begins), index2 (block columns), and each block as its number and
//     9 values column by column
//   q (3 contacts values), mu (contacts values), and possibly one whole number more, a flag without meaning here.
#pragma once

#include <filesystem>

#include "engine/lcp/block_sparse_delassus.hpp"

namespace impinge {

struct FrictionContactProblem {
  std::unique_ptr<BlockSparseDelassus> w;
  ConeProblem problem;  ///< problem.w is `w`
};

/// Throws InputError `file:line:column: found; allowed; remedy`.
FrictionContactProblem read_friction_contact(const std::filesystem::path& path);

}  // namespace impinge
