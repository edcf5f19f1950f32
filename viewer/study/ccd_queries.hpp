// Queries for continuous detection with their answers, as others publish them: a row a corner, each coordinate a numerator
// and a denominator, and last 0 or 1 for whether the features meet; eight rows a query. For two edges a0, a1, b0, b1 at
// the start and then at the end; for a vertex and a face x, a, b, c likewise. Files below a folder `edge-edge` are of
// edges, those below `vertex-face` of vertices and faces.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/geometry/continuous.hpp"

namespace impinge {

struct CcdQuery {
  MovingCorners corners;
  bool edges = false;  ///< two edges, else a vertex and a face
  bool meets = false;
};

/// The queries of one set: a folder that holds `edge-edge`, `vertex-face` or both.
struct CcdSet {
  std::string name;
  std::vector<CcdQuery> queries;
};

/// All sets below a folder, by name. Throws InputError `file:line:column: found; allowed; remedy`, and where there is none.
std::vector<CcdSet> read_ccd_sets(const std::filesystem::path& folder);

}  // namespace impinge
