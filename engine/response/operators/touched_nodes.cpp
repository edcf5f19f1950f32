#include "engine/response/operators/touched_nodes.hpp"

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {

std::vector<std::vector<int>> touched_nodes(const GroupSystem& group) {
  std::vector<std::vector<int>> nodes(group.deformable.size());
  for (const ContactRows& rows : group.contacts)
    for (const ContactSide* side : {&rows.a, &rows.b})
      for (const NodeWeight& n : side->nodes) nodes[side->deformable].push_back(n.node);
  for (std::vector<int>& of_body : nodes) {
    std::sort(of_body.begin(), of_body.end());
    of_body.erase(std::unique(of_body.begin(), of_body.end()), of_body.end());
  }
  return nodes;
}

MatX gram_of(const DeformableBlock& block, const SparseColumns& columns) {
  MatX w;
  const SolveStatus status = block.solver->gram(columns, w).status;
  if (status == SolveStatus::not_finite || status == SolveStatus::not_positive_definite)
    throw DivergenceError("the system matrix of a deformable body is not positive definite");
  return w;
}

void factorize(const DeformableBlock& block) {
  if (block.solver->factorize(*block.a) != SolveStatus::ok)
    throw DivergenceError("the system matrix of a deformable body is not positive definite");
}

MatX inverse_between(const DeformableBlock& block, const std::vector<int>& nodes) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (int d = 0; d < 3; ++d) entries.emplace_back(3 * nodes[k] + d, static_cast<int>(3 * k) + d, 1.0);
  SparseColumns columns(block.velocity.size(), static_cast<Eigen::Index>(3 * nodes.size()));
  columns.setFromTriplets(entries.begin(), entries.end());
  return gram_of(block, columns);
}

}  // namespace impinge
