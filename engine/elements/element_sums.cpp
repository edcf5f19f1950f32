#include "engine/elements/element_sums.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr std::size_t kNodesPerTask = 256;  // a node's sum takes a tenth of a microsecond

}  // namespace

template <int N>
ElementSums<N>::ElementSums(const BlockPattern& pattern, std::span<const std::array<int, N>> elements) {
  constexpr int kBlocks = ElementAnswer<N>::kBlocks;
  const std::size_t count = elements.size();
  IMPINGE_ASSERT(count < std::numeric_limits<int>::max() / (2 * kBlocks));
  // counting sort by node and by block keeps the order of elements
  node_begin_.assign(pattern.rows + 1, 0);
  block_begin_.assign(pattern.blocks() + 1, 0);
  std::vector<int> block_of(kBlocks * count);
  std::size_t block = 0;
  for (const auto& element : elements) {
    for (const int v : element) ++node_begin_[v + 1];
    for (int a = 0; a < N; ++a)
      for (int b = a; b < N; ++b, ++block) {
        block_of[block] = pattern.find(std::min(element[a], element[b]), std::max(element[a], element[b]));
        ++block_begin_[block_of[block] + 1];
      }
  }
  std::partial_sum(node_begin_.begin(), node_begin_.end(), node_begin_.begin());
  std::partial_sum(block_begin_.begin(), block_begin_.end(), block_begin_.begin());
  node_code_.resize(N * count);
  block_code_.resize(block_of.size());
  std::vector<int> node_cursor(node_begin_.begin(), node_begin_.end() - 1),
      block_cursor(block_begin_.begin(), block_begin_.end() - 1);
  int node_code = 0, block_code = 0;
  for (const auto& element : elements)
    for (int a = 0; a < N; ++a) {
      node_code_[node_cursor[element[a]]++] = node_code++;
      for (int b = a; b < N; ++b, ++block_code)
        block_code_[block_cursor[block_of[block_code]]++] = 2 * block_code + (element[a] > element[b] ? 1 : 0);
    }
}

template <int N>
void ElementSums<N>::gather_forces(std::span<const ElementAnswer<N>> slots, VecX& f) const {
  const std::size_t nodes = node_begin_.size() - 1;
  f.resize(3 * static_cast<Eigen::Index>(nodes));
  parallel_for(nodes, kNodesPerTask, [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for (int k = node_begin_[i]; k < node_begin_[i + 1]; ++k)
      sum += slots[node_code_[k] / N].force.col(node_code_[k] % N);
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) = sum;
  });
}

template <int N>
void ElementSums<N>::gather_stiffness(std::span<const ElementAnswer<N>> slots, BlockMatrix& k) const {
  constexpr int kBlocks = ElementAnswer<N>::kBlocks;
  const BlockPattern& pattern = *k.pattern;
  parallel_for(pattern.rows, kNodesPerTask, [&](std::size_t i) {
    for (int block = pattern.diagonal[i]; block < pattern.begin[i + 1]; ++block) {
      Mat3 sum = Mat3::Zero();
      for (int c = block_begin_[block]; c < block_begin_[block + 1]; ++c) {
        const int code = block_code_[c] / 2;
        const Mat3& part = slots[code / kBlocks].stiffness[code % kBlocks];
        if (block_code_[c] % 2 == 0)
          sum += part;
        else
          sum += part.transpose();
      }
      k.values[block] = sum;
      k.values[pattern.mirror[block]] = sum.transpose();
    }
  });
}

template class ElementSums<4>;
template class ElementSums<10>;

}  // namespace impinge
