#include "engine/geometry/surface/node_rims.hpp"

#include <algorithm>
#include <tuple>

namespace impinge {
namespace {

constexpr int kFew = 32;  // triangles that are sooner looked at than a rim

/// By its ends, whichever way it runs.
auto ends_of(const NodeRims::Edge& e) { return std::tuple(std::min(e[0], e[1]), std::max(e[0], e[1])); }

/// Leaves out what runs forth and back.
void cancel(std::vector<NodeRims::Edge>& sorted) {
  std::size_t kept = 0;
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    const NodeRims::Edge edge = sorted[first];
    int forth = 0;
    for (; last < sorted.size() && ends_of(sorted[last]) == ends_of(edge); ++last)
      forth += sorted[last][0] == edge[0] ? 1 : -1;
    const NodeRims::Edge left = forth > 0 ? edge : NodeRims::Edge{edge[1], edge[0]};
    for (int i = 0; i < std::abs(forth); ++i) sorted[kept++] = left;
  }
  sorted.resize(kept);
}

}  // namespace

NodeRims::NodeRims(const BoxTree& tree, std::span<const Triangle> triangles) : nodes_(tree.nodes().size()) {
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children stand behind their parents, and their triangles in a row
    const BoxTree::Node& node = tree.nodes()[n];
    nodes_[n].begin = node.is_leaf() ? node.first : nodes_[n + 1].begin;
    nodes_[n].end = node.is_leaf() ? node.first + node.count : nodes_[static_cast<std::size_t>(node.second)].end;
  }
  if (!nodes_.empty()) make(tree, triangles, 0);
}

std::vector<NodeRims::Edge> NodeRims::make(const BoxTree& tree, std::span<const Triangle> triangles, int node) {
  const auto place = static_cast<std::size_t>(node);
  const int count = nodes_[place].end - nodes_[place].begin;
  const auto is_before = [](const Edge& l, const Edge& r) { return ends_of(l) < ends_of(r); };
  std::vector<Edge> edges;
  if (count <= kFew || tree.nodes()[place].is_leaf()) {
    for (int i = nodes_[place].begin; i < nodes_[place].end; ++i) {
      const Triangle& t = triangles[static_cast<std::size_t>(tree.order()[static_cast<std::size_t>(i)])];
      for (int k = 0; k < 3; ++k)
        if (t[k] != t[(k + 1) % 3]) edges.push_back({t[k], t[(k + 1) % 3]});
    }
    std::sort(edges.begin(), edges.end(), is_before);
  } else {
    const std::vector<Edge> one = make(tree, triangles, node + 1);
    const std::vector<Edge> other = make(tree, triangles, tree.nodes()[place].second);
    edges.resize(one.size() + other.size());
    std::merge(one.begin(), one.end(), other.begin(), other.end(), edges.begin(), is_before);
  }
  cancel(edges);
  if (count > kFew && 2 * edges.size() < static_cast<std::size_t>(count)) {
    nodes_[place].first_edge = static_cast<int>(edges_.size()), nodes_[place].edges = static_cast<int>(edges.size());
    edges_.insert(edges_.end(), edges.begin(), edges.end());
  }
  return edges;
}

}  // namespace impinge
