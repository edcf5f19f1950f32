#ifdef IMPINGE_OPENVDB
// One mesh of a pair is looked up in the other's field of distances: what of its tree is farther away than the margin is
// passed over, and so no node of the other's tree is looked at for it. The field belongs to a surface that doesn't
// deform, and is made once. What is left is tested as everywhere; pairs without such a surface go through `bvh`.
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/detection/triangles/triangle_pair_test.hpp"
#include "engine/geometry/distance_field.hpp"
#include "engine/geometry/fitted_tree.hpp"

namespace impinge {

Entry<NarrowPhase> bvh_narrow_phase();

namespace {

struct FieldSettings {
  int voxels = 200000;
};

constexpr int kWorthField = 256;    // triangles that are worth a field
constexpr std::size_t kATask = 64;  // triangles that a thread tests at a time

bool is_rigid(const Collider& c) { return c.vertex_velocities.empty(); }
int count_of(const Collider& c) { return static_cast<int>(c.mesh().mesh.triangles.size()); }

/// A pair, seen from the mesh whose triangles are looked up.
struct Lookup {
  BodyPair pair;
  bool is_a_asked = false;  ///< the surface of A has the field
  BodyIndex asking() const { return is_a_asked ? pair.b : pair.a; }
  BodyIndex asked() const { return is_a_asked ? pair.a : pair.b; }
};

class DistanceFieldPhase final : public NarrowPhase {
 public:
  void declare(const Rows& rows) override {
    rows.add("voxels", settings_.voxels, {1000, 1000000000}, "",
             "Most voxels of a surface's field, some 10 bytes each: the more, the narrower what it tells apart.");
  }

  void find(std::span<const Collider> colliders, std::span<const BodyPair> pairs,
            std::vector<TrianglePair>& found) override {
    std::vector<BodyPair> without;
    std::vector<Lookup> lookups;
    for (const BodyPair& pair : pairs) {
      const Collider &a = colliders[pair.a], &b = colliders[pair.b];
      const auto can_be_asked = [&](const Collider& c) { return is_rigid(c) && count_of(c) >= kWorthField; };
      const bool may_a = can_be_asked(a), may_b = can_be_asked(b);
      if (pair.a == pair.b || !(may_a || may_b))
        without.push_back(pair);
      else
        lookups.push_back({pair, may_a && (!may_b || count_of(a) > count_of(b))});
    }
    trees_->find(colliders, without, found);
    fit_deforming(colliders, lookups);
    for (const Lookup& lookup : lookups) look_up(colliders, lookup, found);
    std::sort(found.begin(), found.end());
  }

 private:
  void fit_deforming(std::span<const Collider> colliders, std::span<const Lookup> lookups) {
    if (fitted_.size() < colliders.size()) fitted_.resize(colliders.size());
    std::vector<char> is_fitted(colliders.size(), 0);
    for (const Lookup& lookup : lookups) {
      const auto body = static_cast<std::size_t>(lookup.asking().value());
      const Collider& collider = colliders[lookup.asking()];
      if (is_rigid(collider) || is_fitted[body] != 0) continue;
      fitted_[body].fit(triangle_boxes(collider.mesh().mesh.triangles, collider.vertices));
      is_fitted[body] = 1;
    }
  }

  void look_up(std::span<const Collider> colliders, const Lookup& lookup, std::vector<TrianglePair>& found) const {
    const Collider &asking = colliders[lookup.asking()], &asked = colliders[lookup.asked()];
    const double magnitude = std::max(largest_coordinate(asking.bounds), largest_coordinate(asked.bounds));
    // as search_box has it, and what poses round
    const double margin = lookup.pair.margin * (1.0 + 1e-9) + (4.0 * kTouchTolerance + 1e-13) * magnitude;
    const std::vector<int> near = near_triangles(lookup, asking, asked, margin);
    std::vector<std::vector<TrianglePair>> out((near.size() + kATask - 1) / kATask);
    parallel_for(out.size(), 1, [&](std::size_t task) {
      InterruptPoll poll;
      for (std::size_t i = task * kATask; i < std::min(near.size(), (task + 1) * kATask); ++i)
        test(lookup, asking, asked, near[i], margin, poll, out[task]);
    });
    for (const std::vector<TrianglePair>& list : out) found.insert(found.end(), list.begin(), list.end());
  }

  /// Triangles that the field doesn't tell to be farther than the margin.
  std::vector<int> near_triangles(const Lookup& lookup, const Collider& asking, const Collider& asked,
                                  double margin) const {
    const FittedTree* fitted = is_rigid(asking) ? nullptr : &fitted_[static_cast<std::size_t>(lookup.asking().value())];
    const BoxTree& tree = fitted != nullptr ? fitted->tree() : asking.mesh().tree();
    std::vector<int> near;
    const Pose frame = fitted != nullptr ? Pose() : asking.pose;
    const std::shared_ptr<const DistanceField> field = asked.mesh().field(static_cast<std::size_t>(settings_.voxels));
    DistanceField::Reader reader(*field);
    const auto is_far = [&](const Vec3& center, double radius) {
      return reader.at_least(asked.pose.apply_inverse(center)) > radius * (1.0 + 1e-9) + margin;
    };
    InterruptPoll poll;
    tree.search(
        [&](int n) {
          poll();
          const Aabb& box = fitted != nullptr ? fitted->boxes()[n] : tree.nodes()[n].box;
          return !is_far(frame.apply(box.center()), 0.5 * box.extent().norm());
        },
        [&](int t) {
          const TriangleCorners c = corners_of(asking, t);
          const Vec3 center = (c[0] + c[1] + c[2]) / 3.0;
          double radius = 0.0;
          for (const Vec3& corner : c) radius = std::max(radius, (corner - center).norm());
          if (!is_far(center, radius)) near.push_back(t);
        });
    return near;
  }

  /// One triangle against those of the other surface that are near it.
  static void test(const Lookup& lookup, const Collider& asking, const Collider& asked, int own, double margin,
                   InterruptPoll& poll, std::vector<TrianglePair>& out) {
    const TriangleCorners corners = corners_of(asking, own);
    const Aabb box = search_box(corners, lookup.pair.margin);
    const Vec3 local[3] = {asked.pose.apply_inverse(corners[0]), asked.pose.apply_inverse(corners[1]),
                           asked.pose.apply_inverse(corners[2])};
    const Aabb around = bounds_of(local[0], local[1], local[2]).inflated(margin);
    const BoxTree& tree = asked.mesh().tree();
    const auto meets = [&](int n) {
      poll();
      return overlap(tree.nodes()[n].box, around);
    };
    tree.search(meets, [&](int other) {
      const TriangleCorners others = corners_of(asked, other);
      if (!overlap(box, search_box(others, lookup.pair.margin))) return;
      const bool is_a = !lookup.is_a_asked;  // the own triangle is of A
      const PairState state = is_a ? test_triangles(corners, others, lookup.pair.margin)
                                   : test_triangles(others, corners, lookup.pair.margin);
      if (state == PairState::apart) return;
      out.push_back({lookup.pair.a, lookup.pair.b, TriangleIndex(is_a ? own : other), TriangleIndex(is_a ? other : own),
                     state == PairState::intersecting});
    });
  }

  FieldSettings settings_;
  std::unique_ptr<NarrowPhase> trees_ = bvh_narrow_phase().make();
  std::vector<FittedTree> fitted_;  // by body
};

}  // namespace

Entry<NarrowPhase> distance_field_narrow_phase() {
  return entry<NarrowPhase, DistanceFieldPhase>(
      "distance_field", "Fields of distances round surfaces that keep their form; what is far by them is left out.");
}

}  // namespace impinge
#endif
