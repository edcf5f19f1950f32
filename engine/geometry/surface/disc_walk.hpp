// Pairs of discs that may be near each other: two trees of discs, walked together from their roots [GottschalkLin96].
#pragma once

#include <bit>

#include "engine/core/four_floats.hpp"
#include "engine/geometry/surface/disc_tree.hpp"

namespace impinge {

class DiscWalk {
 public:
  /// A node of either tree, and which of its discs are meant, by bit.
  struct Task {
    int level_a, a, level_b, b;
    unsigned discs_a, discs_b;
  };

  /// `b_in_a`: from where the vertices of B were given to its tree to where those of A were; `margin`, metres: discs
  /// that are no farther from each other are near. `is_self`: a surface with itself, every pair once; two bodies may
  /// share a tree too.
  DiscWalk(const DiscTree& a, const DiscTree& b, bool is_self, const Pose& b_in_a, double margin);

  Task start() const { return {0, 0, 0, 0, all(a_, 0, 0), all(b_, 0, 0)}; }

  /// Adds what lies below a task to `next`; found(i, j) for places in the orders whose discs are near.
  template <class Found>
  void expand(const Task& task, std::vector<Task>& next, Found&& found) const;

 private:
  static unsigned all(const DiscTree& tree, int level, int j) { return (1u << tree.disc_count(level, j)) - 1u; }

  /// Node b of B in the frame of A.
  void move(const DiscTree::Node& b, DiscTree::Node& moved) const;
  /// Which of four discs may be within the margin of disc k of another node.
  unsigned near(const DiscTree::Node& four, const DiscTree::Node& one, int k) const;
  /// What is to be looked at below two discs: the larger one is opened, or both if neither is twice the other.
  void open(const Task& task, int k, float radius_a, int m, float radius_b, std::vector<Task>& next) const;

  const DiscTree &a_, &b_;
  bool is_self_;
  float rotation_[3][3], turned_[3][3], position_[3], margin_;
};

inline void DiscWalk::move(const DiscTree::Node& b, DiscTree::Node& moved) const {
  const FourFloats x = FourFloats::at(b.center[0]), y = FourFloats::at(b.center[1]), z = FourFloats::at(b.center[2]);
  const FourFloats nx = FourFloats::at(b.normal[0]), ny = FourFloats::at(b.normal[1]), nz = FourFloats::at(b.normal[2]);
  for (int i = 0; i < 3; ++i) {
    const FourFloats r0(rotation_[i][0]), r1(rotation_[i][1]), r2(rotation_[i][2]);
    (r0 * x + r1 * y + r2 * z + FourFloats(position_[i])).store(moved.center[i]);
    (r0 * nx + r1 * ny + r2 * nz).store(moved.normal[i]);
  }
  const FourFloats hx = FourFloats::at(b.half[0]), hy = FourFloats::at(b.half[1]), hz = FourFloats::at(b.half[2]);
  for (int i = 0; i < 3; ++i)
    (FourFloats(turned_[i][0]) * hx + FourFloats(turned_[i][1]) * hy + FourFloats(turned_[i][2]) * hz)
        .store(moved.half[i]);
  FourFloats::at(b.thickness).store(moved.thickness);
  FourFloats::at(b.radius).store(moved.radius);
}

inline unsigned DiscWalk::near(const DiscTree::Node& four, const DiscTree::Node& one, int k) const {
  const FourFloats dx = FourFloats::at(four.center[0]) - FourFloats(one.center[0][k]),
                   dy = FourFloats::at(four.center[1]) - FourFloats(one.center[1][k]),
                   dz = FourFloats::at(four.center[2]) - FourFloats(one.center[2][k]);
  // one of the two is taken as wider by the margin
  unsigned apart = is_larger(magnitude(dx), FourFloats::at(four.half[0]) + FourFloats(one.half[0][k] + margin_)) |
                   is_larger(magnitude(dy), FourFloats::at(four.half[1]) + FourFloats(one.half[1][k] + margin_)) |
                   is_larger(magnitude(dz), FourFloats::at(four.half[2]) + FourFloats(one.half[2][k] + margin_));
  if (apart == 0b1111) return 0;
  const FourFloats radius = FourFloats::at(four.radius), own_radius(one.radius[k] + margin_),
                   reach = radius + own_radius;
  apart |= is_larger(dx * dx + dy * dy + dz * dz, reach * reach);
  if (apart == 0b1111) return 0;
  // along either normal a disc reaches as far as its slab and its ball together: t cos + r sin of the angle between them
  const FourFloats nx = FourFloats::at(four.normal[0]), ny = FourFloats::at(four.normal[1]),
                   nz = FourFloats::at(four.normal[2]), own_x(one.normal[0][k]), own_y(one.normal[1][k]),
                   own_z(one.normal[2][k]), thickness = FourFloats::at(four.thickness),
                   own_thickness(one.thickness[k] + margin_);
  const FourFloats cosine = magnitude(nx * own_x + ny * own_y + nz * own_z),
                   sine = square_root(larger(FourFloats(1.0f + 2e-6f) - cosine * cosine, FourFloats(0.0f)));
  apart |=
      is_larger(magnitude(dx * own_x + dy * own_y + dz * own_z), own_thickness + thickness * cosine + radius * sine);
  apart |= is_larger(magnitude(dx * nx + dy * ny + dz * nz), thickness + own_thickness * cosine + own_radius * sine);
  return ~apart & 0b1111u;
}

template <class Found>
void DiscWalk::expand(const Task& task, std::vector<Task>& next, Found&& found) const {
  const DiscTree::Node& a = a_.node(task.level_a, task.a);
  DiscTree::Node b;
  move(b_.node(task.level_b, task.b), b);
  const bool is_same = is_self_ && task.level_a == task.level_b && task.a == task.b,
             is_last = task.level_a + 1 == a_.levels() && task.level_b + 1 == b_.levels();
  const auto meet = [&](int k, int m) {
    if (is_same && (is_last ? m <= k : m < k)) return;
    if (is_last)
      found(4 * task.a + k, 4 * task.b + m);
    else
      open(task, k, a.radius[k], m, b.radius[m], next);
  };
  const bool is_by_b = std::has_single_bit(task.discs_b);
  for (unsigned ones = is_by_b ? task.discs_b : task.discs_a; ones != 0; ones &= ones - 1u) {
    const int one = std::countr_zero(ones);
    for (unsigned hit = is_by_b ? near(a, b, one) & task.discs_a : near(b, a, one) & task.discs_b; hit != 0;
         hit &= hit - 1u)
      is_by_b ? meet(std::countr_zero(hit), one) : meet(one, std::countr_zero(hit));
  }
}

inline void DiscWalk::open(const Task& task, int k, float radius_a, int m, float radius_b,
                           std::vector<Task>& next) const {
  const bool a_ends = task.level_a + 1 == a_.levels(), b_ends = task.level_b + 1 == b_.levels();
  const bool only_a = b_ends || (!a_ends && radius_a > 2.0f * radius_b),
             only_b = !only_a && (a_ends || radius_b > 2.0f * radius_a);
  Task below = {task.level_a, task.a, task.level_b, task.b, 1u << k, 1u << m};
  if (!only_b) ++below.level_a, below.a = 4 * task.a + k, below.discs_a = all(a_, below.level_a, below.a);
  if (!only_a) ++below.level_b, below.b = 4 * task.b + m, below.discs_b = all(b_, below.level_b, below.b);
  next.push_back(below);
}

}  // namespace impinge
