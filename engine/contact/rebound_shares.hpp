// How much of their rebound pairs of bodies give back in a sub-step.
#pragma once

#include <map>
#include <utility>

#include "engine/core/index.hpp"

namespace impinge {

/// By pair, of 1; pairs that aren't there give back all that their restitution says (step/impacts tells where it is less).
using ReboundShares = std::map<std::pair<BodyIndex, BodyIndex>, double>;

}  // namespace impinge
