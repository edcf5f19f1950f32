#include "engine/geometry/box_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kPartsATree = 64;  // that threads fill
constexpr int kFewest = 4096;    // boxes that are worth a thread

/// A part of the order, and where its node stands. Halving by number says beforehand how many nodes a part has, so that
/// parts can be filled side by side and the tree does not depend on who fills them.
struct Part {
  int node, first, last;
};

class Builder {
 public:
  Builder(std::span<const Aabb> boxes, int leaf, std::vector<BoxTree::Node>& nodes, std::vector<int>& order)
      : boxes_(boxes), leaf_(leaf), nodes_(nodes), order_(order) {
    const int count = static_cast<int>(boxes.size());
    nodes_.resize(static_cast<std::size_t>(nodes_over(count).first));
    centers_.reserve(boxes.size());
    for (const Aabb& box : boxes) centers_.push_back(box.center());
  }

  void build() {
    std::vector<Part> parts = {{0, 0, static_cast<int>(boxes_.size())}};
    for (std::size_t i = 0; i < parts.size() && parts.size() - i < kPartsATree;) {
      const Part part = parts[i];
      if (part.last - part.first < kFewest) break;
      ++i;
      for (const Part& half : split(part)) parts.push_back(half);
      done_ = i;
    }
    parallel_for(parts.size() - done_, 1, [&](std::size_t i) { fill(parts[done_ + i]); });
  }

 private:
  /// Nodes over `count` boxes, and over one more.
  std::pair<int, int> nodes_over(int count) const {
    if (count < leaf_) return {1, 1};
    const auto [half, more] = nodes_over(count / 2);
    const bool is_odd = count % 2 == 1;
    return {count <= leaf_ ? 1 : 1 + half + (is_odd ? more : half), 1 + more + (is_odd ? more : half)};
  }

  void fill(const Part& part) {
    if (part.last - part.first <= leaf_) {
      BoxTree::Node& own = nodes_[part.node];
      for (int i = part.first; i < part.last; ++i) own.box.include(boxes_[order_[i]]);
      own.first = part.first, own.count = part.last - part.first;
      return;
    }
    for (const Part& half : split(part)) fill(half);
  }

  /// By number, not by place: depth stays logarithmic whatever the mesh.
  std::array<Part, 2> split(const Part& part) {
    BoxTree::Node& own = nodes_[part.node];
    Aabb centers;
    for (int i = part.first; i < part.last; ++i)
      own.box.include(boxes_[order_[i]]), centers.include(centers_[order_[i]]);
    int axis = 0;
    centers.extent().maxCoeff(&axis);
    const int half = (part.last - part.first) / 2, middle = part.first + half;
    const auto begin = order_.begin();
    std::nth_element(begin + part.first, begin + middle, begin + part.last, [&](int l, int r) {
      const double x = centers_[l][axis], y = centers_[r][axis];
      return x < y || (x == y && l < r);
    });
    own.second = part.node + 1 + nodes_over(half).first;
    return {Part{part.node + 1, part.first, middle}, Part{own.second, middle, part.last}};
  }

  std::span<const Aabb> boxes_;
  int leaf_;
  std::vector<BoxTree::Node>& nodes_;
  std::vector<int>& order_;
  std::vector<Vec3> centers_;
  std::size_t done_ = 0;
};

}  // namespace

BoxTree::BoxTree(std::span<const Aabb> boxes, int leaf) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes.empty()) Builder(boxes, leaf, nodes_, order_).build();
}

void BoxTree::fit(std::span<const Aabb> boxes, std::vector<Aabb>& fitted) const {
  fitted.resize(nodes_.size());
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children stand behind their parents
    const Node& node = nodes_[n];
    Aabb box;
    if (node.is_leaf())
      for (int i = node.first; i < node.first + node.count; ++i) box.include(boxes[order_[i]]);
    else
      box = fitted[n + 1], box.include(fitted[node.second]);
    fitted[n] = box;
  }
}

std::vector<Aabb> triangle_boxes(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  std::vector<Aabb> boxes;
  boxes.reserve(triangles.size());
  for (const Triangle& t : triangles) boxes.push_back(bounds_of(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
  return boxes;
}

}  // namespace impinge
