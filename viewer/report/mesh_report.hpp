// What `impinge mesh` says of surface files: a page of one, a table of several, JSON for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/mend/decimate.hpp"
#include "engine/geometry/mend/mend.hpp"
#include "engine/geometry/mend/mesh_facts.hpp"

namespace impinge {

struct MeshReport {
  std::string file;
  std::string error;  ///< why it can't be read; "" where it could
  std::string unit;   ///< "metres (FBX: its unit is 0.01 m)"
  bool says_unit = false;
  std::size_t file_vertices = 0;
  MeshFacts facts;
  std::optional<MendReport> mended;
  std::optional<std::string> problem_left;  ///< of the mended surface
  std::optional<DecimateReport> decimated;
  std::optional<double> enclosed;  ///< m³ of space, of the file's surface; none: not known, or the same as its volume
  std::optional<MeshFacts> after;  ///< of the mended or decimated surface
  std::string written;             ///< where to
};

std::string mesh_page(const MeshReport& report);
std::string mesh_table(const std::vector<MeshReport>& reports);
/// One object for one file, else an array. Lengths in metres.
std::string mesh_json(const std::vector<MeshReport>& reports);

/// The faults in words: "3 border edges round 1 hole", ...; empty where there are none.
std::vector<std::string> fault_lines(const MeshFacts& facts);

}  // namespace impinge
