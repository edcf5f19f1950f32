#include "engine/geometry/box_tree.hpp"

#include <algorithm>
#include <numeric>

namespace impinge {
namespace {

/// Fills nodes depth first.
class Builder {
 public:
  Builder(std::span<const Aabb> boxes, int leaf, std::vector<BoxTree::Node>& nodes, std::vector<int>& order)
      : boxes_(boxes), leaf_(leaf), nodes_(nodes), order_(order) {}

  int build(int first, int last) {
    const int own = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Aabb box, centers;
    for (int i = first; i < last; ++i) box.include(boxes_[order_[i]]), centers.include(boxes_[order_[i]].center());
    nodes_[own].box = box;
    if (last - first <= leaf_) {
      nodes_[own].first = first, nodes_[own].count = last - first;
      return own;
    }
    int axis = 0;
    centers.extent().maxCoeff(&axis);
    const int middle =
        first + (last - first) / 2;  // by number, not by place: depth stays logarithmic whatever the mesh
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int l, int r) {
      return std::pair(boxes_[l].center()[axis], l) < std::pair(boxes_[r].center()[axis], r);
    });
    build(first, middle);
    nodes_[own].second = build(middle, last);
    return own;
  }

 private:
  std::span<const Aabb> boxes_;
  int leaf_;
  std::vector<BoxTree::Node>& nodes_;
  std::vector<int>& order_;
};

}  // namespace

BoxTree::BoxTree(std::span<const Aabb> boxes, int leaf) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!boxes.empty()) Builder(boxes, leaf, nodes_, order_).build(0, static_cast<int>(boxes.size()));
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

std::vector<Aabb> triangle_boxes(const TriangleMesh& mesh, std::span<const Vec3> vertices) {
  std::vector<Aabb> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) boxes.push_back(bounds_of(vertices[t[0]], vertices[t[1]], vertices[t[2]]));
  return boxes;
}

}  // namespace impinge
