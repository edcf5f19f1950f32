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
  double activation_distance = 1e-3;
  double friction = 0.3;
  double restitution = 0.0;
  double restitution_threshold = 0.01;
  double max_push_out = 1.0;
  PushOut push_out = PushOut::split;
  bool warm_start = true;
  Reduction reduction = Reduction::patch;
  int most_contacts = 100;

  void declare(const Rows& rows);

  /// How far apart features still are contacts, metres; 0 where only those that intersect are.
  double activation() const { return points == ContactPoints::proximity ? activation_distance : 0.0; }
};

}  // namespace impinge
