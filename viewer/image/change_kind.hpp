// What sort of change a difference is: moved by whole pixels, recoloured, something missing, something new.
#pragma once

#include <string>

#include "viewer/image/difference.hpp"

namespace impinge {

struct ChangeKind {
  enum Kind { none, moved, recolored, missing, added, other };
  Kind kind = none;
  int dx = 0, dy = 0;  ///< of moved: B is A moved by that many pixels, to the right and down
  std::string text;    ///< "moved by 1 pixel to the right"; "" for none
};

/// From the pixels that differ by more than the tolerance and what stands round them. A guess that helps to look in the
/// right place; no verdict depends on it. None where the pictures are of two sizes or don't differ.
ChangeKind change_kind(const Image& a, const Image& b, const Difference& difference);

}  // namespace impinge
