// All overlapping pairs of boxes from nothing: a sort along x, then sweeps within columns that prune by y and z.
// A sweep along one axis alone tests every pair whose intervals overlap there, O(n^(5/3)) for evenly spread boxes. Here
// y and z are cut into strips at quantiles until a column holds few boxes, or cutting no longer parts them; a box is
// entered in every column that it reaches.
#pragma once

#include <span>

#include "engine/detection/broadphase/broad_phase.hpp"

namespace impinge {

/// Keeps its memory between calls, no results.
class PrunedSweep {
 public:
  /// All pairs of overlapping boxes, sorted and unique, into `pairs`.
  void find(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs);

 private:
  /// A box in single precision, rounded outwards: half the memory to walk through; hits are tested again exactly.
  struct Entry {
    std::array<float, 3> min, max;
    std::uint32_t id;
    std::uint32_t starts;  ///< bit 0: this strip in y, bit 1: in z is the first that the box reaches
  };

  /// Strips of one cut: the entries of strip s are entries[begin[s]] up to entries[begin[s + 1]].
  struct Cut {
    std::vector<Entry> entries;
    std::vector<int> first, last, begin, next;  ///< first and last strip of each entry
    std::vector<float> bounds;                  ///< strip s is bounds[s-1] <= x < bounds[s]
  };
  static constexpr int kMaxDepth = 5;

  void sort_by_x(std::span<const Aabb> boxes);
  /// Finds the pairs among the entries, which are sorted by x; `failures`: how many axes in a row couldn't be cut.
  void divide(std::span<const Entry> entries, int axis, int depth, int failures);
  bool cut(std::span<const Entry> entries, int axis, int strips, Cut& cut);
  void sweep(std::span<const Entry> entries);
  void output(std::span<const Aabb> boxes, std::vector<BoxPair>& pairs);

  std::vector<Entry> sorted_, scratch_;
  std::array<Cut, kMaxDepth> cuts_;
  std::vector<float> sample_;
  static constexpr int kGuesses = 1024;
  std::array<int, kGuesses> guess_;
  std::vector<std::uint64_t> found_, ordered_;
  std::vector<std::uint32_t> row_;
};

}  // namespace impinge
