// Triangle pairs by trees of boxes. A rigid mesh has one tree for good, in its own frame, so that nothing is made anew when
// it moves; boxes of one are looked at from the frame of the other. A deforming mesh's tree keeps the shape it had at
// rest, its boxes are fitted to where the triangles are, and it is built anew once they have grown too large for it.
#pragma once

#include <span>

#include "engine/detection/triangles/tree_pairs.hpp"
#include "engine/geometry/fitted_tree.hpp"

namespace impinge {

/// How two boxes are told apart.
enum class BoxTest { along_one, along_both, by_spheres };

class BoxPairs {
 public:
  /// As NarrowPhase::find.
  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs, BoxTest how,
            std::vector<TrianglePair>& found);

 private:
  /// A tree and where its boxes are now.
  struct Side {
    const BoxTree* tree = nullptr;
    const std::vector<Aabb>* fitted = nullptr;  // null: the tree's own
    const BoxTree::Node& node(int n) const { return tree->nodes()[n]; }
    const Aabb& box(int n) const { return fitted != nullptr ? (*fitted)[n] : node(n).box; }
  };

  /// How two boxes are looked at: those of B from the frame that those of A are in.
  struct View {
    Pose b_in_a;
    Mat3 turned;          // absolute values of its rotation
    double margin = 0.0;  // metres, what rounding takes included
    BoxTest how = BoxTest::along_one;

    bool are_near(const Aabb& a, const Aabb& b) const;
    /// The axes of B and those at right angles to one of each; the latter are shorter than 1, and so is the margin there.
    bool is_between_axes(const Vec3& c, const Vec3& ha, const Vec3& hb) const;
  };

  /// Two nodes of one body pair.
  struct Task {
    int pair, a, b;
  };

  struct Leaf;

  void prepare(std::span<const Collider> colliders, std::span<const BodyPair> pairs, BoxTest how);
  void open(std::span<const Collider> colliders, const BodyPair& pair, int index, std::vector<Task>& tasks) const;
  static void split(const BodyPair& pair, const Side& a, const Side& b, const Task& task, std::vector<Task>& out);
  void walk(std::span<const Collider> colliders, const BodyPair& pair, const View& view, const Task& start,
            std::vector<TrianglePair>& out) const;
  static void test(std::span<const Collider> colliders, const BodyPair& pair, const Side& a, const Side& b,
                   const Task& task, std::vector<TrianglePair>& out);

  std::vector<Side> sides_;         // by body
  std::vector<FittedTree> fitted_;  // by body
  std::vector<View> views_;         // by pair
};

}  // namespace impinge
