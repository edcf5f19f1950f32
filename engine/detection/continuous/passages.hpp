// Where moving surfaces pass through one another: the earliest features of two that come together in a piece of time and
// go on to overlap by more than is allowed. What ends as deep as allowed or less is left to contacts.
#pragma once

#include "engine/detection/collision.hpp"
#include "engine/detection/continuous/surface_path.hpp"

namespace impinge {

/// Two features of A and B that pass.
struct Passage {
  double time = 0.0;      ///< in [0, 1], of the meeting; never later than the true one
  double approach = 0.0;  ///< along the normal, metres a unit of time, > 0
  TriangleIndex triangle_a, triangle_b;
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< the points that meet, where they are at time 0
  Vec3 normal = Vec3::UnitY();                          ///< from B towards A, at the meeting
  std::uint64_t feature = 0;                            ///< as a Collision has it
};

struct PassageSettings {
  double depth = 1e-7;  ///< overlap along the normal that is not a passage yet, metres, > 0
  double reach = 1e-4;  ///< how far from straight a vertex's path may be taken to be, metres, > 0
  double creep = -1.0;  ///< how much deeper what begins deeper may end, metres; negative: as much again
  double graze = 0.0;   ///< overlap of a solid with a formula (solid_passages) on a way that ends less deep, metres
};

/// The passages of the earliest moment there is one, sorted by feature; empty: none.
std::vector<Passage> first_passages(const SurfacePath& a, const SurfacePath& b, const PassageSettings& settings);

/// The same of one deforming surface with itself. Features that share a vertex never pass each other.
std::vector<Passage> first_self_passages(const SurfacePath& path, const PassageSettings& settings);

}  // namespace impinge
