#include "tests/support/geometry/ccd_queries.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/geometry/meshes.hpp"

namespace impinge::test {
namespace {

namespace fs = std::filesystem;

/// A row: three fractions and the answer. All fractions of the set are doubles exactly.
std::pair<Vec3, bool> read_row(const std::string& line) {
  std::istringstream in(line);
  std::string cell;
  double value[7] = {};
  for (double& v : value) std::getline(in, cell, ','), v = std::strtod(cell.c_str(), nullptr);
  return {Vec3(value[0] / value[1], value[2] / value[3], value[4] / value[5]), value[6] != 0.0};
}

}  // namespace

std::vector<CcdQuery> read_ccd_queries() {
  std::vector<CcdQuery> queries;
  const std::string readme = shared_file("ccd-queries/README.md");
  if (readme.empty()) return queries;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(readme).parent_path()))
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::ifstream in(file);
    CcdQuery query;
    query.edges = file.parent_path().filename() == "edge-edge";
    query.source = file.parent_path().parent_path().filename().string();
    std::string line;
    for (int row = 0; std::getline(in, line) && !line.empty(); row = (row + 1) % 8) {
      const auto [x, meets] = read_row(line);
      (row < 4 ? query.corners.start[row] : query.corners.end[row - 4]) = x;
      query.meets = meets;
      if (row == 7) queries.push_back(query);
    }
  }
  return queries;
}

}  // namespace impinge::test
