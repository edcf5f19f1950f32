// Whoever looks on while groups are solved. Watching changes nothing: what is looked at is a copy's to try.
#pragma once

#include "engine/contact/assemble.hpp"

namespace impinge {

struct Solving;

class SolveWatcher {
 public:
  virtual ~SolveWatcher() = default;
  /// The group is about to be handed to the response, for the first time in this motion or again. Several threads call
  /// this, each for groups of its own.
  virtual void solving(GroupIndex group, const AssembledGroup& assembled, const Solving& how) = 0;
};

}  // namespace impinge
