// What contacts are made from: the rows `contact.*`.
#pragma once

#include "engine/core/rows.hpp"

namespace impinge {

/// Where contacts come from.
enum class ContactPoints {
  intersection,  ///< triangles that intersect already
  proximity      ///< features closer than the activation distance
};
std::string_view name_of(ContactPoints points);

/// What recovery from overlap changes.
enum class PushOut {
  split,    ///< positions only
  velocity  ///< velocities too, as in the seed
};

/// Which of the contacts found respond.
enum class Reduction {
  none,  ///< all of them
  patch  ///< those that can come to carry: contact_reduction.hpp, flat_crossings.hpp
};

struct ContactSettings {
  ContactPoints points = ContactPoints::proximity;
  Threshold activation_distance{2.4e-3};  ///< part of the length of a pair's scale (pair_scale.hpp)
  double friction = 0.3;
  double restitution = 0.0;
  Threshold restitution_threshold{4.9e-3};  ///< part of its speed
  Threshold max_push_out{0.65};             ///< part of its speed
  PushOut push_out = PushOut::split;
  bool warm_start = true;
  Reduction reduction = Reduction::patch;
  int most_contacts = 30;
  int turning_solves = 4;
  int second_looks = 4;
  int successive_impacts = 8;

  void declare(const Rows& rows);

  /// How far apart features of bodies of a size still are contacts, metres; 0 where only those that intersect are.
  double activation(double size) const {
    return points == ContactPoints::proximity ? activation_distance.at(size) : 0.0;
  }
};

}  // namespace impinge
