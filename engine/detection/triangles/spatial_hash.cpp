// Optimized spatial hashing [Haapaoja16 §3.2.2], [Teschner03]: triangles are entered in the cells of a
// uniform grid that their boxes cover; cells are found through a hash table; triangles that meet in a cell are tested.
//
// What this adds to the seed's description:
// - Triangles are clipped to where their body's box meets a partner's; what lies outside costs one box test.
// - Two rounds. The first only marks which bodies come to which table entry; the second enters a triangle in those of
//   its cells that another body comes to as well. Two surfaces that cross along a curve share few cells, so the lists
//   stay short, and the round over all triangles writes one word of a table that fits the cache. A mark has a bit for
//   each colour of body (partners differ in colour) and, where few colours are needed, for several classes of cells:
//   with the seed's table size two cells in five share an entry with a cell of the other body, and only one in forty a
//   class too.
// - A pair is tested in one cell only: the one with the smallest coordinates that both boxes cover. The list keeps the
//   cell of each item, so that different cells in one entry neither lose pairs nor report them twice.
// - A triangle over more than kMostCells cells is not entered but tested against its partners' boxes directly. Only a
//   triangle much larger than the mean gets there.
// - Boxes are widened by half the margin, and cells by the margin, so that a large margin does not multiply the cells.
//   Cells count from the corner of all regions, which keeps their numbers small far from the origin.
// Marks and counts carry the number of the step that wrote them, so that nothing is cleared between steps.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/triangles/cell_hash.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"

namespace impinge {
namespace {

constexpr std::size_t kBlock = 2048;  // triangles in a task
constexpr std::size_t kEntriesATask = 64;
constexpr std::int64_t kMostCells = 1024;
constexpr int kColours = 32;  // bits of a mark

struct Item {
  Aabb box;        // widened by half of the body's largest margin
  Cell low, high;  // cells of the clipped box
  int body, triangle;
  bool is_large;
};
// an item in one cell
struct Node {
  Cell cell;
  std::uint32_t entry, item;
  std::uint32_t body : 29, first : 3;  // first: on which axes the cell is the lowest that the item covers
};
struct Partner {
  int body;
  double margin;
};

// grows and never shrinks: after the first steps nothing is allocated
template <class T>
void grow(std::vector<T>& v, std::size_t size) {
  if (v.size() < size) v.resize(size);
}

template <class Visit>
void for_each_cell(const Item& item, Visit&& visit) {
  for (std::int32_t i = item.low.i; i <= item.high.i; ++i)
    for (std::int32_t j = item.low.j; j <= item.high.j; ++j)
      for (std::int32_t k = item.low.k; k <= item.high.k; ++k) visit(Cell{i, j, k});
}

class SpatialHash final : public NarrowPhase {
 public:
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    found.clear();
    if (pairs.empty()) return;
    colliders_ = colliders;
    prepare(pairs);
    if (active_.empty()) return;  // no two boxes meet
    collect_and_mark();
    make_lists();
    query(found);
    test_large(found);
    std::sort(found.begin(), found.end());
  }

 private:
  // partners and regions of each body, the grid and the table
  void prepare(std::span<const BodyPair> pairs) {
    const std::size_t bodies = colliders_.size();
    grow(partners_, bodies);
    grow(regions_, bodies);
    grow(half_margins_, bodies);
    grow(is_self_, bodies);
    grow(colours_, bodies);
    active_.clear();
    for (std::size_t b = 0; b < bodies; ++b) {
      partners_[b].clear();
      regions_[b] = {};
      half_margins_[b] = 0.0;
      is_self_[b] = 0;
    }
    Aabb all;
    double largest_margin = 0.0;
    for (const BodyPair& pair : pairs) {
      largest_margin = std::max(largest_margin, pair.margin);
      for (int side = 0; side < 2; ++side) {
        const int own = side == 0 ? pair.a : pair.b, other = side == 0 ? pair.b : pair.a;
        const Aabb own_box = widened(own, pair.margin), other_box = widened(other, pair.margin);
        if (!overlap(own_box, other_box)) break;
        if (partners_[own].empty()) active_.push_back(own);
        partners_[own].push_back({other, pair.margin});
        half_margins_[own] = std::max(half_margins_[own], pair.margin);
        const Aabb region{own_box.min.cwiseMax(other_box.min), own_box.max.cwiseMin(other_box.max)};
        regions_[own].include(region);
        all.include(region);
        if (own == other) {
          is_self_[own] = 1;
          break;
        }
      }
    }
    if (active_.empty()) return;
    std::sort(active_.begin(), active_.end());
    colour_bodies();
    std::size_t vertices = 0, triangles = 0;
    double edges = 0.0;
    for (int b : active_) {
      std::sort(partners_[b].begin(), partners_[b].end(),
                [](const Partner& l, const Partner& r) { return l.body < r.body; });
      const std::size_t count = colliders_[b].mesh().mesh.triangles.size();
      vertices += colliders_[b].vertices.size();
      triangles += count;
      edges += colliders_[b].mean_edge * static_cast<double>(count);
    }
    const double mean_edge = triangles > 0 ? edges / static_cast<double>(triangles) : 0.0;
    const double extent = all.is_empty() ? 0.0 : all.extent().maxCoeff();
    // the cell is the mean edge; never so small that cell numbers leave 32 bits, and not zero
    const double cell = std::max({mean_edge + largest_margin, extent * 1e-9, 1e-300});
    origin_ = all.is_empty() ? Vec3(Vec3::Zero()) : all.min;
    per_cell_ = 1.0 / cell;
    // 1.2 times the vertices, rounded up to the next hundred, minus one
    const std::size_t size = (std::max<std::size_t>(vertices, 1) * 12 + 999) / 1000 * 100 - 1;
    size_ = static_cast<std::uint32_t>(std::min<std::size_t>(std::max<std::size_t>(size, 99), 0xfffffff0u));
    if (marks_.size() < size_) {
      marks_ = std::vector<std::atomic<std::uint64_t>>(size_);
      counts_.assign(size_, {});
      step_ = 0;
    }
    if (++step_ == 0) {  // after 2^32 steps old marks could look new
      for (std::atomic<std::uint64_t>& m : marks_) m.store(0, std::memory_order_relaxed);
      counts_.assign(counts_.size(), {});
      step_ = 1;
    }
  }

  // partners get different colours, so that a mark of another colour is a mark of another body
  void colour_bodies() {
    int most = 0;
    for (int b : active_) colours_[b] = -1;
    for (int b : active_) {
      std::uint64_t taken = 0;
      for (const Partner& p : partners_[b])
        if (p.body != b && colours_[p.body] >= 0) taken |= std::uint64_t{1} << colours_[p.body];
      colours_[b] = std::min(std::countr_one(taken), kColours);
      most = std::max(most, colours_[b]);
    }
    // kColours itself stands for bodies with too many partners: whatever shares an entry with them is listed
    bits_a_class_ = static_cast<int>(std::bit_ceil(static_cast<unsigned>(most + 1)));
    if (bits_a_class_ > kColours) bits_a_class_ = kColours;
    class_mask_ = static_cast<std::uint32_t>(kColours / bits_a_class_ - 1);
    is_crowded_ = most >= kColours;
  }

  // the place of a cell's class within a mark
  int class_shift(std::uint32_t hash) const {
    return static_cast<int>((hash * 0x9E3779B1u >> 27) & class_mask_) * bits_a_class_;
  }

  // a body's box, widened so that it contains the search boxes of all its triangles
  Aabb widened(int body, double margin) const {
    const Aabb& box = colliders_[body].bounds;
    if (box.is_empty()) return box;
    return box.inflated(0.5 * margin * (1.0 + 1e-9) + 2.0 * kTouchTolerance * largest_coordinate(box));
  }

  // the triangles that reach into their body's region, block by block, and which bodies come to which entry. The order
  // of the threads does not show: every block has its own part of items_, and marks are or-ed
  void collect_and_mark() {
    blocks_.clear();
    for (int b : active_) {
      const std::size_t count = colliders_[b].mesh().mesh.triangles.size();
      for (std::size_t first = 0; first < count; first += kBlock)
        blocks_.push_back({b, first, std::min(count, first + kBlock), 0});
    }
    grow(items_, blocks_.size() * kBlock);
    const Modulo modulo(size_);
    const std::uint64_t stamp = static_cast<std::uint64_t>(step_) << 32;
    parallel_for(blocks_.size(), 1, [&](std::size_t b) {
      Block& block = blocks_[b];
      const Collider& collider = colliders_[block.body];
      const Aabb region = regions_[block.body];
      const double margin = half_margins_[block.body];
      const std::uint64_t colour = std::uint64_t{1} << (colours_[block.body] % kColours);
      Item* item = &items_[b * kBlock];
      for (std::size_t t = block.first; t < block.last; ++t) {
        item->box = search_box(corners_of(collider, static_cast<int>(t)), margin);
        if (!overlap(item->box, region)) continue;
        item->body = block.body;
        item->triangle = static_cast<int>(t);
        item->low = cell_of(item->box.min.cwiseMax(region.min));
        item->high = cell_of(item->box.max.cwiseMin(region.max));
        item->is_large = cells_of(*item) > kMostCells;
        if (!item->is_large)
          for_each_cell(*item, [&](const Cell& cell) {
            const std::uint32_t hash = hash_of(cell);
            std::atomic<std::uint64_t>& mark = marks_[modulo(hash)];
            const std::uint64_t bit = stamp | colour << class_shift(hash);
            std::uint64_t old = mark.load(std::memory_order_relaxed);
            while (true) {
              const std::uint64_t next = (old >> 32) == step_ ? old | bit : bit;
              if (next == old || mark.compare_exchange_weak(old, next, std::memory_order_relaxed)) break;
            }
          });
        ++item;
      }
      block.items = static_cast<std::size_t>(item - &items_[b * kBlock]);
    });
    large_.clear();
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      for (std::size_t i = b * kBlock; i < b * kBlock + blocks_[b].items; ++i)
        if (items_[i].is_large) large_.push_back(static_cast<std::uint32_t>(i));
  }

  Cell cell_of(const Vec3& x) const {
    const Vec3 c = (x - origin_) * per_cell_;
    return {static_cast<std::int32_t>(std::floor(c.x())), static_cast<std::int32_t>(std::floor(c.y())),
            static_cast<std::int32_t>(std::floor(c.z()))};
  }

  static std::int64_t cells_of(const Item& item) {
    const std::int64_t x = item.high.i - item.low.i + 1, y = item.high.j - item.low.j + 1,
                       z = item.high.k - item.low.k + 1;
    return std::min(x * y, kMostCells + 1) * z;  // each is below 2^31: no overflow
  }

  // the lists of the entries that two bodies come to, one after another in lists_
  void make_lists() {
    const Modulo modulo(size_);
    grow(block_nodes_, blocks_.size());
    parallel_for(blocks_.size(), 1, [&](std::size_t b) {
      std::vector<Node>& nodes = block_nodes_[b];
      nodes.clear();
      const int body = blocks_[b].body;
      const std::uint32_t one_class = static_cast<std::uint32_t>((std::uint64_t{1} << bits_a_class_) - 1);
      const std::uint32_t others =
          is_self_[body] != 0 || is_crowded_ ? one_class : one_class & ~(std::uint32_t{1} << colours_[body]);
      for (std::size_t i = b * kBlock; i < b * kBlock + blocks_[b].items; ++i) {
        if (items_[i].is_large) continue;
        for_each_cell(items_[i], [&](const Cell& cell) {
          const std::uint32_t hash = hash_of(cell), entry = modulo(hash);
          const std::uint32_t mark = static_cast<std::uint32_t>(marks_[entry].load(std::memory_order_relaxed));
          if ((mark >> class_shift(hash) & others) != 0)
            nodes.push_back({cell, entry, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(body),
                             first_axes(items_[i].low, cell)});
        });
      }
    });
    used_.clear();
    std::size_t total = 0;
    for (std::size_t block = 0; block < blocks_.size(); ++block) {
      total += block_nodes_[block].size();
      for (const Node& node : block_nodes_[block]) {
        Count& count = counts_[node.entry];
        if (count.step != step_) {
          count = {step_, 0, 0};
          used_.push_back(node.entry);
        }
        ++count.size;
      }
    }
    grow(lists_, total);
    std::uint32_t begin = 0;
    for (std::uint32_t entry : used_) {
      Count& count = counts_[entry];
      count.end = begin;
      begin += count.size;
    }
    for (std::size_t block = 0; block < blocks_.size(); ++block)
      for (const Node& node : block_nodes_[block]) lists_[counts_[node.entry].end++] = node;
  }

  // every entry with two or more triangles
  void query(std::vector<TrianglePair>& found) {
    const std::size_t tasks = (used_.size() + kEntriesATask - 1) / kEntriesATask;
    grow(task_found_, tasks);
    parallel_for(tasks, 1, [&](std::size_t task) {
      std::vector<TrianglePair>& out = task_found_[task];
      out.clear();
      InterruptPoll poll;
      for (std::size_t u = task * kEntriesATask; u < std::min(used_.size(), (task + 1) * kEntriesATask); ++u) {
        const Count& count = counts_[used_[u]];
        // bodies stand in the list in ascending order: what a triangle can meet begins behind its own body
        std::uint32_t next = count.end - count.size;
        for (std::uint32_t i = next; i < count.end; ++i) {
          const Node& l = lists_[i];
          while (next < count.end && lists_[next].body == l.body) ++next;
          for (std::uint32_t j = is_self_[l.body] != 0 ? i + 1 : next; j < count.end; ++j) {
            poll();
            const Node& r = lists_[j];
            // the smallest cell that both cover is the lowest of one of them on each axis; elsewhere the pair is not
            // tested
            if ((l.first | r.first) == 7u && l.cell == r.cell) test(items_[l.item], items_[r.item], out);
          }
        }
      }
    });
    for (std::size_t task = 0; task < tasks; ++task)
      found.insert(found.end(), task_found_[task].begin(), task_found_[task].end());
  }

  static std::uint32_t first_axes(const Cell& low, const Cell& cell) {
    return (low.i == cell.i ? 1u : 0u) | (low.j == cell.j ? 2u : 0u) | (low.k == cell.k ? 4u : 0u);
  }

  // items of one body come in ascending order, bodies too: l is before r
  void test(const Item& l, const Item& r, std::vector<TrianglePair>& out) const {
    if (!overlap(l.box, r.box)) return;
    const auto before = [](const Partner& p, int body) { return p.body < body; };
    const std::vector<Partner>& partners = partners_[l.body];
    const auto partner = std::lower_bound(partners.begin(), partners.end(), r.body, before);
    if (partner == partners.end() || partner->body != r.body) return;
    const Collider &a = colliders_[l.body], &b = colliders_[r.body];
    if (l.body == r.body && share_a_vertex(a.mesh().mesh.triangles[l.triangle], a.mesh().mesh.triangles[r.triangle]))
      return;
    const PairState state = test_triangles(corners_of(a, l.triangle), corners_of(b, r.triangle), partner->margin);
    if (state != PairState::apart)
      out.push_back({BodyIndex(l.body), BodyIndex(r.body), TriangleIndex(l.triangle), TriangleIndex(r.triangle),
                     state == PairState::intersecting});
  }

  // triangles that are in no list against all items of their partners
  void test_large(std::vector<TrianglePair>& found) {
    if (large_.empty()) return;
    grow(task_found_, large_.size());
    parallel_for(large_.size(), 1, [&](std::size_t task) {
      std::vector<TrianglePair>& out = task_found_[task];
      out.clear();
      InterruptPoll poll;
      const std::uint32_t own = large_[task];
      const Item& item = items_[own];
      for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const auto is_block_body = [&](const Partner& p) { return p.body == blocks_[b].body; };
        const std::vector<Partner>& partners = partners_[item.body];
        if (std::none_of(partners.begin(), partners.end(), is_block_body)) continue;
        for (std::size_t i = b * kBlock; i < b * kBlock + blocks_[b].items; ++i) {
          poll();
          if (i == own || (items_[i].is_large && i < own)) continue;  // two large ones meet once
          test(items_[std::min<std::size_t>(own, i)], items_[std::max<std::size_t>(own, i)], out);
        }
      }
    });
    for (std::size_t task = 0; task < large_.size(); ++task)
      found.insert(found.end(), task_found_[task].begin(), task_found_[task].end());
  }

  struct Block {
    int body;
    std::size_t first, last;  // triangles
    std::size_t
        items;  // how many of them reach into the region; they stand in items_ from kBlock times the block's number
  };
  struct Count {
    std::uint32_t step = 0, size = 0, end = 0;
  };

  std::span<const Collider> colliders_;
  // by body
  std::vector<std::vector<Partner>> partners_;
  std::vector<Aabb> regions_;
  std::vector<double> half_margins_;
  std::vector<char> is_self_;
  std::vector<int> colours_;
  std::vector<int> active_;
  int bits_a_class_ = 1;
  std::uint32_t class_mask_ = 0;
  bool is_crowded_ = false;
  // grid and table
  Vec3 origin_ = Vec3::Zero();
  double per_cell_ = 1.0;
  std::uint32_t size_ = 0, step_ = 0;
  std::vector<std::atomic<std::uint64_t>> marks_;  // step in the high half, colours by class of cells in the low
  std::vector<Count> counts_;
  std::vector<std::uint32_t> used_;
  std::vector<Node> lists_;
  // by block of triangles
  std::vector<Block> blocks_;
  std::vector<std::vector<Node>> block_nodes_;
  std::vector<Item> items_;
  std::vector<std::uint32_t> large_;
  std::vector<std::vector<TrianglePair>> task_found_;
};

}  // namespace

Entry<NarrowPhase> spatial_hash_narrow_phase() {
  return entry<NarrowPhase, SpatialHash>("spatial_hash",
                                         "Triangles hashed by the grid cells they cover, tested where they meet.");
}

}  // namespace impinge
