// Deformable bodies whose elements are not what their material can be trusted with.
#pragma once

#include "engine/bodies/bodies.hpp"

namespace impinge {

struct CrushedBody {
  std::string name, model;
  std::size_t elements = 0;
  std::size_t inverted = 0;   ///< det F <= 0
  std::size_t collapsed = 0;  ///< squeezed below `stretch`, where the material yields
  double stretch = 0.0;
};

/// Those that have such elements as they stand now, in their order.
std::vector<CrushedBody> find_crushed(const Bodies& bodies);

}  // namespace impinge
