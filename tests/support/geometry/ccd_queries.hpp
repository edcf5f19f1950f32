// The published sample of continuous collision queries with exact answers, if the shared data folder has it.
#pragma once

#include "engine/geometry/continuous.hpp"

namespace impinge::test {

struct CcdQuery {
  bool edges = false;  ///< else a vertex and a face
  bool meets = false;  ///< the exact answer
  std::string source;  ///< folder
  MovingCorners corners;
};

/// All of them; empty where there are none.
std::vector<CcdQuery> read_ccd_queries();

}  // namespace impinge::test
