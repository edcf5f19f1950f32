// How near two bodies are, wherever they are: what detection would find if contacts were sought as far away as that. It
// asks the same tests of shapes and triangles that contacts come from.
#pragma once

#include <memory>
#include <optional>

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"

namespace impinge {

struct NearestFeatures {
  double distance = 0.0;  ///< metres; negative: how deep they overlap, by the deepest contact
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< world
  Vec3 normal = Vec3::UnitY();                          ///< unit, from B towards A
  TriangleIndex triangle_a, triangle_b;                 ///< none: an exact shape
  Feature kind_a = Feature::shape, kind_b = Feature::shape;
  int index_a = 0,
      index_b = 0;  ///< of a vertex, edge or face of the mesh, or of the shape; of a compound with its part
};

/// Between the boxes of two colliders, metres; 0: they overlap.
double box_gap(const Aabb& a, const Aabb& b);

class NearestSearch {
 public:
  NearestSearch();
  /// None: nothing is nearer than `limit` metres, or the two are planes, or one body. a < b.
  std::optional<NearestFeatures> find(std::span<const Collider> colliders, BodyIndex a, BodyIndex b, double limit);

 private:
  std::optional<NearestFeatures> within(std::span<const Collider> colliders, BodyPair pair, bool looks_for_overlap);

  std::unique_ptr<NarrowPhase> triangles_;
};

/// The features that a contact joins.
NearestFeatures features_of(const Collision& contact);

}  // namespace impinge
