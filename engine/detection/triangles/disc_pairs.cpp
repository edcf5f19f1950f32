#include "engine/detection/triangles/disc_pairs.hpp"

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr std::size_t kPartsAPair = 32;
constexpr int kFewest = 256;  // triangles of both that are worth more than one part

/// A pair of triangles as a number that sorts like it.
std::uint64_t key_of(int a, int b, bool is_intersecting) {
  return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b) << 1 | (is_intersecting ? 1u : 0u);
}

TrianglePair pair_of(const BodyPair& bodies, std::uint64_t key) {
  return {bodies.a, bodies.b, TriangleIndex(static_cast<int>(key >> 32)),
          TriangleIndex(static_cast<int>(key >> 1 & 0x7fffffffu)), (key & 1u) != 0};
}

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
  std::vector<int> used;
  for (const BodyPair& pair : pairs)
    for (const BodyIndex body : {pair.a, pair.b}) used.push_back(body.value());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  parallel_for(used.size(), 1, [&](std::size_t i) {
    const auto body = static_cast<std::size_t>(used[i]);
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
  const std::size_t most = a.triangle_count() + b.triangle_count() < kFewest ? 1 : kPartsAPair;
  const DiscWalk& walk = walks_[static_cast<std::size_t>(pair)];
  std::vector<DiscWalk::Task> waiting = {walk.start()}, next;
  std::vector<std::uint64_t> found;
  while (!waiting.empty() && waiting.size() < most) {
    next.clear();
    for (const DiscWalk::Task& task : waiting)
      walk.expand(task, next, [&](int i, int j) { test(colliders, bodies, i, j, found); });
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
  InterruptPoll poll;
  while (!part.tasks.empty()) {
    const DiscWalk::Task task = part.tasks.back();
    part.tasks.pop_back();
    poll();
    walk.expand(task, part.tasks, [&](int i, int j) { test(colliders, pair, i, j, part.found); });
  }
}

void DiscPairs::test(std::span<const Collider> colliders, const BodyPair& pair, int i, int j,
                     std::vector<std::uint64_t>& found) const {
  int first = trees_[pair.a]->order()[i], second = trees_[pair.b]->order()[j];
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  if (pair.a == pair.b) {
    if (second < first) std::swap(first, second);
    const std::vector<Triangle>& triangles = a.mesh().mesh.triangles;
    if (share_a_vertex(triangles[first], triangles[second])) return;
  }
  const TriangleCorners own = corners_of(a, first), other = corners_of(b, second);
  if (!overlap(search_box(own, pair.margin), search_box(other, pair.margin))) return;
  const PairState state = test_triangles(own, other, pair.margin);
  if (state != PairState::apart) found.push_back(key_of(first, second, state == PairState::intersecting));
}

}  // namespace impinge
