// Sweeps through the program, and their tables read back.
#pragma once

#include <map>

#include "tests/support/program/refusal.hpp"

namespace impinge::test {

using Row = std::map<std::string, std::string>;

/// A crate thrown on a floor: something happens in each frame.
inline constexpr const char* kCrateScene = R"([simulation]
substeps = 2
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
position = [0, 0.4, 0]
rotation = [0, 30, 10]
velocity = [1, 0, 0]
)";

/// A tilted box that falls on a floor.
inline constexpr const char* kTiltedBox = R"([[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "b"
kind = "dynamic"
shape = { box = { size = [0.2, 0.2, 0.2] } }
material = { density = 100 }
position = [0, 0.11, 0]
rotation = [3, 0, 1]
)";

/// The cells of a line; one in quotes may hold commas.
inline std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> list(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      list.emplace_back();
    else
      list.back() += c;
  }
  return list;
}

/// A table by the names of its columns.
inline std::vector<Row> csv_rows(const std::filesystem::path& file) {
  std::vector<Row> rows;
  std::vector<std::string> names;
  const std::string text = slurp(file);
  INFO(file);
  REQUIRE(!text.empty());
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::vector<std::string> list = csv_cells(text.substr(begin, end - begin));
    if (names.empty()) {
      names = list;
      continue;
    }
    REQUIRE(list.size() == names.size());
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = list[i];
  }
  return rows;
}

/// results.csv without the columns that measure time.
inline std::vector<Row> sweep_results(const std::filesystem::path& sweep) {
  std::vector<Row> rows = csv_rows(sweep / "results.csv");
  for (Row& row : rows) std::erase_if(row, [](const auto& cell) { return cell.first.ends_with("_ms"); });
  return rows;
}

inline std::vector<std::string> column(const std::vector<Row>& rows, const std::string& name) {
  std::vector<std::string> cells;
  for (const Row& row : rows) cells.push_back(row.at(name));
  return cells;
}

inline std::vector<double> numbers(const std::vector<Row>& rows, const std::string& name) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(std::stod(row.at(name)));
  return values;
}

/// A folder with the crate as s.toml, and sweeps of it into its sub-folders.
struct SweepFiles {
  TempFolder folder;
  SweepFiles() { folder.write("s.toml", kCrateScene); }
  static std::vector<std::string> words(const std::string& out, const std::vector<std::string>& more,
                                        const std::string& scene = "s.toml") {
    std::vector<std::string> words = {"sweep", scene, "--out", out, "--no-images", "--jobs", "2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Outcome run(const std::string& out, const std::vector<std::string>& more, const std::string& scene = "s.toml") const {
    return impinge_run(folder.path(), words(out, more, scene));
  }
  std::filesystem::path job(const std::string& out, const Row& row) const {
    return folder / out / "jobs" / row.at("hash");
  }
};

}  // namespace impinge::test
