#include "engine/detection/triangles/box_pairs.hpp"

#include <array>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kLeaf = 4;  // triangles; trees have at most 2
constexpr std::size_t kTasksAPair = 32;
constexpr int kWorthTasks = 256;  // triangles of both that are worth more than one task

}  // namespace

void BoxPairs::find(std::span<const Collider> colliders, std::span<const BodyPair> pairs, BoxTest how,
                    std::vector<TrianglePair>& found) {
  found.clear();
  prepare(colliders, pairs, how);
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < pairs.size(); ++i) open(colliders, pairs[i], static_cast<int>(i), tasks);
  std::vector<std::vector<TrianglePair>> out(tasks.size());
  parallel_for(tasks.size(), 1, [&](std::size_t i) {
    const Task& task = tasks[i];
    walk(colliders, pairs[static_cast<std::size_t>(task.pair)], views_[static_cast<std::size_t>(task.pair)], task,
         out[i]);
  });
  for (const std::vector<TrianglePair>& list : out) found.insert(found.end(), list.begin(), list.end());
  std::sort(found.begin(), found.end());
}

bool BoxPairs::View::are_near(const Aabb& a, const Aabb& b) const {
  const Vec3 c = b_in_a.apply(b.center()) - a.center(), ha = 0.5 * a.extent(), hb = 0.5 * b.extent();
  if (how == BoxTest::by_spheres) return c.norm() <= ha.norm() + hb.norm() + margin;
  if ((c.cwiseAbs().array() > (ha + product(turned, hb)).array() + margin).any()) return false;
  return how == BoxTest::along_one || !is_between_axes(c, ha, hb);
}

bool BoxPairs::View::is_between_axes(const Vec3& c, const Vec3& ha, const Vec3& hb) const {
  const Mat3& r = b_in_a.rotation;
  for (int j = 0; j < 3; ++j)
    if (std::abs(c.dot(r.col(j))) > hb[j] + turned.col(j).dot(ha) + margin) return true;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double distance = std::abs(c[i2] * r(i1, j) - c[i1] * r(i2, j));
      const double own = ha[i1] * turned(i2, j) + ha[i2] * turned(i1, j),
                   other = hb[j1] * turned(i, j2) + hb[j2] * turned(i, j1);
      if (distance > own + other + margin) return true;
    }
  return false;
}

void BoxPairs::prepare(std::span<const Collider> colliders, std::span<const BodyPair> pairs, BoxTest how) {
  sides_.assign(colliders.size(), {});
  if (fitted_.size() < colliders.size()) fitted_.resize(colliders.size());
  const std::vector<BodyIndex> used = bodies_of(pairs);
  parallel_for(used.size(), 1, [&](std::size_t i) {
    const BodyIndex body = used[i];
    const Collider& collider = colliders[body];
    if (!deforms(collider)) {
      sides_[body] = {&collider.mesh().tree(), nullptr};
      return;
    }
    fitted_[body].fit(triangle_boxes(collider.mesh().mesh.triangles, collider.vertices));
    sides_[body] = {&fitted_[body].tree(), &fitted_[body].boxes()};
  });
  views_.clear();
  for (const BodyPair& pair : pairs) {
    const Collider &a = colliders[pair.a], &b = colliders[pair.b];
    const Pose b_in_a = tree_in_tree(a, b);
    views_.push_back({b_in_a, b_in_a.rotation.cwiseAbs(), tree_margin(a, b, pair.margin), how});
  }
}

/// Node pairs that threads walk side by side; how many there are doesn't depend on the threads.
void BoxPairs::open(std::span<const Collider> colliders, const BodyPair& pair, int index,
                    std::vector<Task>& tasks) const {
  const Side &a = sides_[pair.a], &b = sides_[pair.b];
  if (a.tree->is_empty() || b.tree->is_empty()) return;
  const auto count = [&](BodyIndex i) { return static_cast<int>(colliders[i].mesh().mesh.triangles.size()); };
  const std::size_t most = count(pair.a) + count(pair.b) < kWorthTasks ? 1 : kTasksAPair;
  std::vector<Task> waiting = {{index, 0, 0}}, next;
  while (!waiting.empty() && waiting.size() < most) {
    next.clear();
    bool is_split = false;
    for (const Task& task : waiting) {
      if (!views_[static_cast<std::size_t>(index)].are_near(a.box(task.a), b.box(task.b))) continue;
      if (a.node(task.a).is_leaf() && b.node(task.b).is_leaf())
        next.push_back(task);
      else
        is_split = true, split(pair, a, b, task, next);
    }
    waiting.swap(next);
    if (!is_split) break;
  }
  tasks.insert(tasks.end(), waiting.begin(), waiting.end());
}

void BoxPairs::split(const BodyPair& pair, const Side& a, const Side& b, const Task& task, std::vector<Task>& out) {
  const BoxTree::Node &na = a.node(task.a), &nb = b.node(task.b);
  if (pair.a == pair.b && task.a == task.b) {
    out.push_back({task.pair, task.a + 1, task.a + 1});
    out.push_back({task.pair, task.a + 1, na.second});
    out.push_back({task.pair, na.second, na.second});
  } else if (nb.is_leaf() ||
             (!na.is_leaf() && a.box(task.a).extent().squaredNorm() >= b.box(task.b).extent().squaredNorm())) {
    out.push_back({task.pair, task.a + 1, task.b});
    out.push_back({task.pair, na.second, task.b});
  } else {
    out.push_back({task.pair, task.a, task.b + 1});
    out.push_back({task.pair, task.a, nb.second});
  }
}

void BoxPairs::walk(std::span<const Collider> colliders, const BodyPair& pair, const View& view, const Task& start,
                    std::vector<TrianglePair>& out) const {
  const Side &a = sides_[pair.a], &b = sides_[pair.b];
  std::vector<Task> waiting = {start};
  InterruptPoll poll;
  while (!waiting.empty()) {
    const Task task = waiting.back();
    waiting.pop_back();
    poll();
    if (!view.are_near(a.box(task.a), b.box(task.b))) continue;
    if (a.node(task.a).is_leaf() && b.node(task.b).is_leaf())
      test(colliders, pair, a, b, task, out);
    else
      split(pair, a, b, task, waiting);
  }
}

/// The triangles of a leaf, where they are.
struct BoxPairs::Leaf {
  int count = 0;
  std::array<int, kLeaf> triangle;
  std::array<TriangleCorners, kLeaf> corners;
  std::array<Aabb, kLeaf> box;

  Leaf(const Collider& collider, const Side& side, const BoxTree::Node& node, double margin) : count(node.count) {
    IMPINGE_ASSERT(count <= kLeaf);
    for (int i = 0; i < count; ++i) {
      triangle[i] = side.tree->order()[node.first + i];
      corners[i] = corners_of(collider, triangle[i]);
      box[i] = search_box(corners[i], margin);
    }
  }
};

void BoxPairs::test(std::span<const Collider> colliders, const BodyPair& pair, const Side& a, const Side& b,
                    const Task& task, std::vector<TrianglePair>& out) {
  const bool is_self = pair.a == pair.b, is_one = is_self && task.a == task.b;
  const std::vector<Triangle>& triangles = colliders[pair.a].mesh().mesh.triangles;
  const Leaf own(colliders[pair.a], a, a.node(task.a), pair.margin),
      other(colliders[pair.b], b, b.node(task.b), pair.margin);
  for (int i = 0; i < own.count; ++i)
    for (int j = is_one ? i + 1 : 0; j < other.count; ++j) {
      if (!overlap(own.box[i], other.box[j])) continue;
      int first = own.triangle[i], second = other.triangle[j];
      if (is_self && share_a_vertex(triangles[first], triangles[second])) continue;
      const bool is_turned = is_self && second < first;
      const PairState state = is_turned ? test_triangles(other.corners[j], own.corners[i], pair.margin)
                                        : test_triangles(own.corners[i], other.corners[j], pair.margin);
      if (is_turned) std::swap(first, second);
      if (state != PairState::apart)
        out.push_back({pair.a, pair.b, TriangleIndex(first), TriangleIndex(second), state == PairState::intersecting});
    }
}

}  // namespace impinge
