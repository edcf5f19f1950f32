// Which of a number of things are connected, as they are joined one by one.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace impinge {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  void join(int l, int r) {
    l = root(l), r = root(r);
    parent_[std::max(l, r)] = std::min(l, r);
  }
  /// The least of those that it is connected with.
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace impinge
