// One contact of rigid bodies where the sub-step ends.
#pragma once

#include <span>

#include "engine/bodies/bodies.hpp"
#include "engine/detection/collision.hpp"

namespace impinge {

/// A body then; its spin changes on the way though its angular momentum does not.
struct BodyEnd {
  Pose pose;
  double turn = 0.0;                                   ///< radians
  Vec3 spin = Vec3::Zero(), spin_then = Vec3::Zero();  ///< rad/s
};

struct RowEnd {
  const Collision* of = nullptr;
  const BodyEnd *a = nullptr, *b = nullptr;
  Vec3 normal = Vec3::Zero(), point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< of the material that touches now

  /// Of a contact whose normal is that of a face: whether the face is B's, so that A is what rolls on it.
  bool rolls_a() const { return of->normal_owner == of->body_b; }
  BodyIndex body() const { return rolls_a() ? of->body_a : of->body_b; }
  BodyIndex face() const { return rolls_a() ? of->body_b : of->body_a; }
  const BodyEnd& end() const { return rolls_a() ? *a : *b; }
  const BodyEnd& face_end() const { return rolls_a() ? *b : *a; }
  double sign() const { return rolls_a() ? 1.0 : -1.0; }
  const Vec3& now() const { return rolls_a() ? of->point_a : of->point_b; }
  const Vec3& then() const { return rolls_a() ? point_a : point_b; }
  const Vec3& face_then() const { return rolls_a() ? point_b : point_a; }

  /// What J v leaves out half way, m/s, where the place that touches goes from now() to `then`: the mean of both ends less
  /// the first.
  Vec3 half_way(const Bodies& bodies, const Vec3& then) const;
};

/// Calls `visit(first, last)` for the rows of each pair, which follow each other; of a group's list, where others are empty.
template <class Visit>
void for_each_pair(std::span<const RowEnd> rows, Visit&& visit) {
  for (std::size_t first = 0, last = 0; first < rows.size(); first = last) {
    last = first + 1;
    if (rows[first].of == nullptr) continue;
    const auto is_same = [&](const RowEnd& row) {
      return row.of != nullptr && row.of->body_a == rows[first].of->body_a && row.of->body_b == rows[first].of->body_b;
    };
    while (last < rows.size() && is_same(rows[last])) ++last;
    visit(first, last);
  }
}

}  // namespace impinge
