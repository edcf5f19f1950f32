// Where the exact tests put what they find. They know their two shapes in one fixed order (plane, sphere, box, capsule,
// mesh); the sink turns a contact into scene order and keeps those that the query asks for.
#pragma once

#include <span>

#include "engine/detection/collider.hpp"
#include "engine/detection/collision.hpp"
#include "engine/detection/pairs/primitive.hpp"

namespace impinge {

enum class NormalOwner { first, second, neither };

/// A contact between the first and the second shape of a test.
struct Candidate {
  Vec3 point_first = Vec3::Zero(), point_second = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, from the second towards the first
  NormalOwner owner = NormalOwner::neither;
  Feature kind_first = Feature::shape;
  int index_first = 0;
  Feature kind_second = Feature::shape;
  int index_second = 0;
  int triangle_first = -1, triangle_second = -1;
};

/// Cosine: a crossing of edges whose normal is as near to a face's, 0.08 degrees, is a place of that face.
inline constexpr double kSameWay = 1.0 - 1e-6;

/// Negative: overlap, metres.
inline double gap_of(const Candidate& c) { return c.normal.dot(c.point_first - c.point_second); }

class ContactSink {
 public:
  /// `swapped`: the first shape of the test is body b of the pair.
  ContactSink(std::span<const Collider> colliders, const BodyPair& pair, bool swapped, const ContactQuery& query,
              std::vector<Collision>& contacts);

  const Collider& first() const { return *first_; }
  const Collider& second() const { return *second_; }
  const ContactQuery& query() const { return query_; }
  /// No contact with a larger gap can be of interest, metres; >= 0. For leaving out what is far away.
  double reach() const { return reach_; }
  /// Keeps the contact if it overlaps, or (proximity) is closer than the activation distance or would close within the
  /// time step. Returns whether it was kept.
  bool add(const Candidate& candidate);
  /// The same, unless this sink already has a contact of the same two features.
  bool add_new(const Candidate& candidate);
  /// Whether this sink has a contact no farther than `distance` from a candidate's point on the first shape, whose gap
  /// is no larger than the candidate's by more than `tie`: the candidate would say nothing new.
  bool covers(const Candidate& candidate, double distance, double tie) const;
  /// Forgets contacts of other features no farther than `distance` from a candidate's points, on one of the shapes.
  void forget_beside(const Candidate& candidate, double distance);

 private:
  std::uint64_t key_of(const Candidate& candidate) const;

  const Collider* first_;
  const Collider* second_;
  BodyPair pair_;
  bool swapped_;
  ContactQuery query_;
  double reach_ = 0.0;
  std::vector<Collision>& contacts_;
  std::size_t begin_;  ///< where this pair's contacts start
};

/// Velocity of the material point of a collider at `point`, m/s; `triangle` holds it on a deformable surface.
Vec3 material_velocity(const Collider& collider, const Vec3& point, int triangle);

}  // namespace impinge
