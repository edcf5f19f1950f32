// What detection hands on to response: a list of collisions, each one point pair with a normal. [Haapaoja16 §3.2.1]
#pragma once

#include <memory>
#include <tuple>

#include "engine/core/index.hpp"
#include "engine/core/types.hpp"

namespace impinge {

/// Two bodies (scene order, a < b; a == b asks for self-collision) that may touch, and how far apart still counts.
struct BodyPair {
  BodyIndex a, b;
  double margin = 0.0;  ///< metres; features closer than this are wanted (0: intersections only)
  friend bool operator==(const BodyPair& l, const BodyPair& r) { return l.a == r.a && l.b == r.b; }
  friend bool operator<(const BodyPair& l, const BodyPair& r) { return l.a != r.a ? l.a < r.a : l.b < r.b; }
};

/// A triangle of body a and one of body b. In self-collision triangle_a < triangle_b.
struct TrianglePair {
  BodyIndex a, b;
  TriangleIndex triangle_a, triangle_b;
  bool intersecting = false;  ///< the closed triangles share a point (else: only closer than the pair's margin)
  friend bool operator==(const TrianglePair& l, const TrianglePair& r) {
    return l.a == r.a && l.b == r.b && l.triangle_a == r.triangle_a && l.triangle_b == r.triangle_b &&
           l.intersecting == r.intersecting;
  }
  friend bool operator<(const TrianglePair& l, const TrianglePair& r) {
    return std::tie(l.a, l.b, l.triangle_a, l.triangle_b) < std::tie(r.a, r.b, r.triangle_a, r.triangle_b);
  }
};

/// Where two meet in flight.
struct Meeting {
  double time = 0.0;  ///< s, from now
  /// From the common point to where the row acts on A and on B, metres, which come together then.
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
  /// Where the material is now that touches then, metres: the contact's points went back from there by straight lines, and
  /// what turns did not come by these.
  Vec3 from_a = Vec3::Zero(), from_b = Vec3::Zero();
  bool is_after = false;  ///< the two meet elsewhere before: what this contact meets with is not their free velocity
};

/// One contact found by detection. Everything in world coordinates at the instant of detection.
struct Collision {
  BodyIndex body_a, body_b;              ///< scene order, a <= b
  TriangleIndex triangle_a, triangle_b;  ///< none: an exact shape; the point lies in (or at a corner of) the triangle
  Vec3 point_a = Vec3::Zero();           ///< on A's surface
  Vec3 point_b = Vec3::Zero();           ///< on B's surface
  Vec3 normal = Vec3::UnitY();           ///< unit, from B towards A
  double gap = 0.0;                      ///< normal·(point_a - point_b), metres; negative: overlap
  BodyIndex normal_owner;                ///< the body whose surface gives the normal and turns it along; none: neither
  std::uint64_t feature = 0;  ///< which features touch: stable from step to step, unique within the body pair
  /// None: its row acts from now on, and on both at the common point.
  std::shared_ptr<const Meeting> meeting = nullptr;

  Vec3 common_point() const { return 0.5 * (point_a + point_b); }
  /// Where its row acts on either body.
  Vec3 acts_on_a() const { return meeting ? Vec3(common_point() + meeting->on_a) : common_point(); }
  Vec3 acts_on_b() const { return meeting ? Vec3(common_point() + meeting->on_b) : common_point(); }
  /// The places of either body that touch, as they are now.
  const Vec3& touches_a() const { return meeting ? meeting->from_a : point_a; }
  const Vec3& touches_b() const { return meeting ? meeting->from_b : point_b; }
};

/// Identity of a feature pair for warm starting: kinds and indices of the features on a and b.
enum class Feature : std::uint8_t { vertex = 0, edge = 1, face = 2, shape = 3 };
inline std::uint64_t feature_key(Feature kind_a, int index_a, Feature kind_b, int index_b) {
  return (static_cast<std::uint64_t>(kind_a) << 62) |
         (static_cast<std::uint64_t>(static_cast<std::uint32_t>(index_a) & 0x3fffffffu) << 32) |
         (static_cast<std::uint64_t>(kind_b) << 30) | (static_cast<std::uint32_t>(index_b) & 0x3fffffffu);
}

/// What feature_key was made of.
struct FeaturePair {
  Feature kind_a, kind_b;
  int index_a, index_b;
  bool is(Feature a, Feature b) const { return kind_a == a && kind_b == b; }
};
inline FeaturePair features_of_key(std::uint64_t key) {
  return {static_cast<Feature>(key >> 62), static_cast<Feature>(key >> 30 & 3u),
          static_cast<int>(key >> 32 & 0x3fffffffu), static_cast<int>(key & 0x3fffffffu)};
}

}  // namespace impinge
