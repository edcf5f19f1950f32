#include "engine/detection/triangles/disc_pairs.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr std::size_t kPartsAPair = 32;
constexpr int kWorthParts = 256;  // triangles of both that are worth more than one part

/// A pair of triangles as a number that sorts like it.
std::uint64_t key_of(int a, int b, bool is_intersecting) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b) << 1 | (is_intersecting ? 1u : 0u);
}

TrianglePair pair_of(const BodyPair& bodies, std::uint64_t key) {
  return {bodies.a, bodies.b, TriangleIndex(static_cast<int>(key >> 32)),
          TriangleIndex(static_cast<int>(key >> 1 & 0x7fffffffu)), (key & 1u) != 0};
}

/// Looks at the triangles at places of two orders. The one of a mostly stays while those of b change.
class PlaceTest {
 public:
  PlaceTest(std::span<const Collider> colliders, const BodyPair& pair, const DiscTree& a, const DiscTree& b,
            std::vector<std::uint64_t>& found)
      : a_(colliders[pair.a]),
        b_(colliders[pair.b]),
        order_a_(a.order()),
        order_b_(b.order()),
        is_self_(pair.a == pair.b),
        margin_(pair.margin),
        reach_(tree_margin(a_, b_, pair.margin)),
        found_(found) {}

  void operator()(int i, int j) {
    if (i != place_) take(i);
    const int second = order_b_[static_cast<std::size_t>(j)];
    const TriangleCorners other = corners_of(b_, second);
    // as wide as two search boxes at least, and cheaper: what is between them the exact test finds apart
    if (!overlap(box_, bounds_of(other[0], other[1], other[2]))) return;
    if (is_self_) {
      const std::vector<Triangle>& triangles = a_.mesh().mesh.triangles;
      if (share_a_vertex(triangles[first_], triangles[second])) return;
      if (second < first_) return add(second, first_, test_triangles(other, own_, margin_));
    }
    add(first_, second, test_triangles(own_, other, margin_));
  }

 private:
  void take(int i) {
    place_ = i, first_ = order_a_[static_cast<std::size_t>(i)];
    own_ = corners_of(a_, first_);
    box_ = bounds_of(own_[0], own_[1], own_[2]).inflated(reach_);
  }
  void add(int first, int second, PairState state) {
    if (state != PairState::apart) found_.push_back(key_of(first, second, state == PairState::intersecting));
  }

  const Collider &a_, &b_;
  const std::vector<int>&order_a_, &order_b_;
  bool is_self_;
  double margin_, reach_;
  std::vector<std::uint64_t>& found_;
  int place_ = -1, first_ = -1;
  TriangleCorners own_;
  Aabb box_;
};

}  // namespace

void DiscPairs::find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
                     std::vector<TrianglePair>& found) {
  prepare(colliders, pairs);
  std::vector<int> sorted(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) sorted[i] = static_cast<int>(i);
  std::stable_sort(sorted.begin(), sorted.end(), [&](int l, int r) { return pairs[l] < pairs[r]; });
  std::vector<Part> parts;
  for (const int pair : sorted) open(colliders, pairs, pair, parts);
  parallel_for(parts.size(), 1, [&](std::size_t i) { walk(colliders, pairs[parts[i].pair], parts[i]); });
  found.clear();
  std::vector<std::uint64_t> keys;
  for (std::size_t first = 0, last = 0; first < parts.size(); first = last) {
    keys.clear();
    for (; last < parts.size() && parts[last].pair == parts[first].pair; ++last)
      keys.insert(keys.end(), parts[last].found.begin(), parts[last].found.end());
    std::sort(keys.begin(), keys.end());
    for (const std::uint64_t key : keys) found.push_back(pair_of(pairs[parts[first].pair], key));
  }
}

void DiscPairs::prepare(std::span<const Collider> colliders, std::span<const BodyPair> pairs) {
  trees_.assign(colliders.size(), nullptr);
  if (fitted_.size() < colliders.size()) fitted_.resize(colliders.size());
  const std::vector<BodyIndex> used = bodies_of(pairs);
  parallel_for(used.size(), 1, [&](std::size_t i) {
    const BodyIndex body = used[i];
    const Collider& collider = colliders[body];
    if (!deforms(collider)) {
      trees_[body] = &collider.mesh().discs();
      return;
    }
    fitted_[body].fit(collider.mesh().mesh.triangles, collider.vertices);
    trees_[body] = &fitted_[body].tree();
  });
  walks_.clear();
  for (const BodyPair& pair : pairs) {
    const Collider &a = colliders[pair.a], &b = colliders[pair.b];
    walks_.emplace_back(*trees_[pair.a], *trees_[pair.b], pair.a == pair.b, tree_in_tree(a, b),
                        tree_margin(a, b, pair.margin));
  }
}

void DiscPairs::open(std::span<const Collider> colliders, std::span<const BodyPair> pairs, int pair,
                     std::vector<Part>& parts) const {
  const BodyPair& bodies = pairs[pair];
  const DiscTree &a = *trees_[bodies.a], &b = *trees_[bodies.b];
  if (a.triangle_count() == 0 || b.triangle_count() == 0) return;
  const std::size_t most = a.triangle_count() + b.triangle_count() < kWorthParts ? 1 : kPartsAPair;
  const DiscWalk& walk = walks_[static_cast<std::size_t>(pair)];
  std::vector<DiscWalk::Task> waiting = {walk.start()}, next;
  std::vector<std::uint64_t> found;
  PlaceTest test(colliders, bodies, a, b, found);
  while (!waiting.empty() && waiting.size() < most) {
    next.clear();
    for (const DiscWalk::Task& task : waiting) walk.expand(task, next, test);
    waiting.swap(next);
  }
  // how many parts there are depends on no thread
  const std::size_t share = (waiting.size() + kPartsAPair - 1) / kPartsAPair;
  if (!found.empty()) parts.push_back({pair, {}, std::move(found)});
  for (std::size_t i = 0; i < waiting.size(); i += share) {
    const auto first = waiting.begin() + static_cast<std::ptrdiff_t>(i);
    parts.push_back({pair, {first, first + static_cast<std::ptrdiff_t>(std::min(share, waiting.size() - i))}, {}});
  }
}

void DiscPairs::walk(std::span<const Collider> colliders, const BodyPair& pair, Part& part) const {
  const DiscWalk& walk = walks_[static_cast<std::size_t>(part.pair)];
  PlaceTest test(colliders, pair, *trees_[pair.a], *trees_[pair.b], part.found);
  InterruptPoll poll;
  while (!part.tasks.empty()) {
    const DiscWalk::Task task = part.tasks.back();
    part.tasks.pop_back();
    poll();
    walk.expand(task, part.tasks, test);
  }
}

}  // namespace impinge
