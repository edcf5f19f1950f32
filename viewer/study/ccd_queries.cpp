#include "viewer/study/ccd_queries.hpp"

#include <algorithm>
#include <map>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargest = 256u << 20;  // bytes of a file
constexpr std::size_t kCells = 7;

struct Row {
  Vec3 x;
  bool meets;
};

Row read_row(const TextLines& lines) {
  if (lines.count() != kCells)
    lines.fail(0, std::to_string(lines.count()) + " values", "7: three fractions of two whole numbers, and 0 or 1",
               "write one corner a line");
  Row row;
  for (std::size_t k = 0; k < 3; ++k) {
    const double below = lines.real(2 * k + 1);
    if (below == 0.0) lines.fail(2 * k + 1, "a denominator of 0", "any other whole number", "correct the fraction");
    row.x[static_cast<int>(k)] = lines.real(2 * k) / below;
  }
  const double answer = lines.real(6);
  if (answer != 0.0 && answer != 1.0) lines.fail(6, quoted(lines.word(6)), "0 or 1", "say whether the features meet");
  row.meets = answer == 1.0;
  return row;
}

void read_queries(const fs::path& file, bool edges, std::vector<CcdQuery>& queries) {
  std::string text = read_file(file, kLargest);
  std::replace(text.begin(), text.end(), ',', ' ');
  TextLines lines(file.string(), text);
  while (lines.next()) {
    CcdQuery query;
    query.edges = edges;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if (corner > 0) lines.need("the next corner of a query: it has eight");
      const Row row = read_row(lines);
      (corner < 4 ? query.corners.start[corner] : query.corners.end[corner - 4]) = row.x;
      if (corner > 0 && row.meets != query.meets)
        lines.fail(6, "another answer than the row before has", "one answer a query", "make all eight rows agree");
      query.meets = row.meets;
    }
    queries.push_back(query);
  }
}

}  // namespace

std::vector<CcdSet> read_ccd_sets(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".csv") files.push_back(entry.path());
  } catch (const fs::filesystem_error& e) {
    throw InputError(folder.string() + ": cannot be read (" + e.code().message() +
                     "); a folder of query files is wanted; give another path");
  }
  std::sort(files.begin(), files.end());
  std::map<std::string, CcdSet> sets;
  for (const fs::path& file : files) {
    const std::string kind = file.parent_path().filename().string();
    if (kind != "edge-edge" && kind != "vertex-face") continue;
    CcdSet& set = sets[file.parent_path().parent_path().filename().string()];
    read_queries(file, kind == "edge-edge", set.queries);
  }
  std::vector<CcdSet> result;
  result.reserve(sets.size());
  for (auto& [name, set] : sets) result.push_back({name, std::move(set.queries)});
  if (result.empty())
    throw InputError(folder.string() +
                     ": no queries; .csv files in folders named edge-edge and vertex-face are wanted; give the folder "
                     "that holds them");
  return result;
}

}  // namespace impinge
