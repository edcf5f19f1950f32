// Makes the boundary of a solid of a surface that is none: as little is changed as that takes, and what is done is
// counted. The answer depends on the mesh and the settings alone, to the bit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/mend/skin_check.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {

struct MendSettings {
  /// Metres between border vertices that are one, or of one from an edge that it lies on; none: a millionth of the
  /// diagonal, or up to a thousandth where that closes what else stays open (closing_tolerance).
  std::optional<double> weld;
  bool drop_degenerate = true;  ///< triangles without area or twice there
  bool orient = true;           ///< neighbours alike, closed parts outwards
  bool fill_holes = true;       ///< false: what is open is a sheet
  double largest_hole = 0.25;   ///< all holes of a part, of its area: one that is more open is a sheet
  /// Metres, of sheets; none: a hundredth of the sheet's longest side, with `remesh` two of its cells at least.
  std::optional<double> thickness;
  bool drop_inner = true;  ///< parts that lie in others and face outwards too; false: cavities
  int remesh = 0;          ///< cells along the longest side of a new skin without crossings; 0: none
};

struct MendReport {
  int welded = 0, split_edges = 0, collapsed = 0, duplicates = 0, joined = 0, flipped_flat = 0;
  int turned = 0, cut_edges = 0, added_vertices = 0;
  int holes = 0, hole_triangles = 0;
  int sheets = 0;                       ///< parts that got a thickness
  int turned_parts = 0;                 ///< closed ones that faced inwards
  int inner_parts = 0, flat_parts = 0;  ///< that were dropped
  bool remeshed = false;
  double volume_before = 0.0, volume_after = 0.0;  ///< m³; before: what the triangles span, closed or not
  double largest_move = 0.0;                       ///< metres, of a vertex of the surface
  std::optional<SkinFault> skin_fault;             ///< of the new skin

  bool is_changed() const;
  /// "filled 3 holes with 12 triangles", one step each, in the order in which they were done.
  std::vector<std::string> steps() const;
};

struct MendedMesh {
  TriangleMesh mesh;
  MendReport report;
  std::optional<std::string> problem;  ///< what still keeps it from bounding a solid (check_mesh)
};

/// Indices of `mesh` must be in range and coordinates finite; all else may be wrong.
MendedMesh mend(TriangleMesh mesh, const MendSettings& settings);

}  // namespace impinge
