// To what the pixels that differ belong, by the id pictures of both sides.
#pragma once

#include <string>
#include <vector>

#include "viewer/image/difference.hpp"
#include "viewer/image/id_image.hpp"

namespace impinge {

/// What one layer draws of one kind for a body or between two bodies.
struct ObjectChange {
  std::string layer, mark, body, other;
  int missing = 0;           ///< objects seen in A but not in B
  int added = 0;             ///< seen in B but not in A
  int changed = 0;           ///< seen in both, with pixels that differ
  int in_a = 0;              ///< seen in A
  std::int64_t pixels = 0;   ///< that differ and belong to it on either side
  std::string text() const;  ///< "contacts: 1 point between crate and floor missing (of 4; 57 pixels)"
};

/// The most pixels first. A pixel that differs belongs to what stands on top there, in A and in B; the backdrop,
/// planes and static bodies count only where both sides show nothing else. A pixel beside one whose object changed
/// belongs to that change. Empty where the sizes are unlike.
std::vector<ObjectChange> object_changes(const Image& a, const Image& b, const IdImage& ids_a, const IdImage& ids_b,
                                         int tolerance, const Image* mask = nullptr);

}  // namespace impinge
