#include "engine/preflight/hung_masses.hpp"

#include <algorithm>
#include <cstddef>

namespace impinge {
namespace {

/// Bodies with freedom as nodes of a graph, attachments as its edges; parts without a node by one search in depth.
class AttachedBodies {
 public:
  explicit AttachedBodies(const World& world) : bodies_(world.bodies()) {
    const auto count = static_cast<std::size_t>(bodies_.size().value());
    neighbours_.resize(count), points_.resize(count), nodes_.resize(count);
    for (const Attachment& attachment : world.attachments()) {
      const AttachmentHold hold = hold_of(attachment, bodies_);  // what slides on a surface has no point of it to keep
      join(attachment.a.body, attachment.b.body, hold.point_a);
      join(attachment.b.body, attachment.a.body, hold.point_b);
    }
  }

  std::vector<HungMass> hung() {
    std::vector<HungMass> result(nodes_.size());
    for (std::size_t root = 0; root < nodes_.size(); ++root) {
      if (nodes_[root].order >= 0 || neighbours_[root].empty()) continue;
      const std::vector<std::size_t> found = search(root);
      for (const std::size_t i : found) result[i] = {mass_on(i, root), lever(i)};
    }
    return result;
  }

 private:
  struct Node {
    int order = -1, lowest = -1;  // in which it was found; the first that its part reaches round its parent
    bool is_held = false;         // by the world or what has no freedom
    double mass = 0.0;            // kg, of it and all found from it
    int held = 0;                 // how many of these are held
    std::size_t parent = 0, next = 0;
    std::vector<std::size_t> children;
  };

  bool is_free(BodyIndex i) const { return !i.is_none() && bodies_[i].has_freedom(); }

  void join(BodyIndex own, BodyIndex other, const Vec3& point) {
    if (!is_free(own)) return;
    const auto i = static_cast<std::size_t>(own.value());
    points_[i].push_back(point);
    if (is_free(other))
      neighbours_[i].push_back(static_cast<std::size_t>(other.value()));
    else
      nodes_[i].is_held = true;
  }

  void find(std::size_t i, std::size_t parent, int order) {
    Node& n = nodes_[i];
    n.order = n.lowest = order, n.parent = parent;
    n.mass = bodies_[static_cast<int>(i)].mass, n.held = n.is_held;
  }

  /// All that hangs together with the root; without recursion, since chains are long.
  std::vector<std::size_t> search(std::size_t root) {
    std::vector<std::size_t> path{root}, found{root};
    find(root, root, 0);
    while (!path.empty()) {
      const std::size_t i = path.back();
      Node& n = nodes_[i];
      if (n.next < neighbours_[i].size()) {
        const std::size_t k = neighbours_[i][n.next++];
        if (nodes_[k].order >= 0) {
          if (k != n.parent) n.lowest = std::min(n.lowest, nodes_[k].order);
          continue;
        }
        find(k, i, static_cast<int>(found.size()));
        path.push_back(k), found.push_back(k);
        continue;
      }
      path.pop_back();
      if (path.empty()) break;
      Node& above = nodes_[n.parent];
      above.lowest = std::min(above.lowest, n.lowest);
      above.mass += n.mass, above.held += n.held;
      above.children.push_back(i);
    }
    return found;
  }

  double mass_on(std::size_t i, std::size_t root) const {
    const Node &n = nodes_[i], &all = nodes_[root];
    double rest = all.mass - bodies_[static_cast<int>(i)].mass, loose = 0.0, heaviest = 0.0;
    int rest_held = all.held - n.is_held;
    const auto take = [&](double mass, int held) {
      if (held == 0) loose += mass, heaviest = std::max(heaviest, mass);
    };
    for (const std::size_t k : n.children) {
      if (i != root && nodes_[k].lowest < n.order) continue;  // it hangs together with the rest
      take(nodes_[k].mass, nodes_[k].held);
      rest -= nodes_[k].mass, rest_held -= nodes_[k].held;
    }
    if (i != root) take(rest, rest_held);
    return all.held > 0 ? loose : loose - heaviest;
  }

  double lever(std::size_t i) const {
    double most = 0.0;
    for (const Vec3& a : points_[i]) most = std::max(most, (a - points_[i].front()).norm());
    return most;
  }

  const Bodies& bodies_;
  std::vector<std::vector<std::size_t>> neighbours_;
  std::vector<std::vector<Vec3>> points_;
  std::vector<Node> nodes_;
};

}  // namespace

std::vector<HungMass> hung_masses(const World& world) { return AttachedBodies(world).hung(); }

}  // namespace impinge
