// The debugger without a screen, run as a program.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

/// A crate and a ball fall on a floor that leans a little.
inline constexpr const char* kRigid = R"([simulation]
substeps = 2
[contact]
friction = 0.4
[[body]]
name = "floor"
kind = "static"
shape = { box = { size = [3, 0.2, 3] } }
position = [0, -0.1, 0]
rotation = [0, 0, 8]
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
material = { density = 500 }
position = [0, 0.5, 0]
rotation = [10, 20, 0]
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.3 } }
position = [0.1, 1.3, 0]
[view]
backdrop = "flat"
)";

/// A soft cube that lies beside them.
inline constexpr const char* kSoftCube = R"([[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [0.5, 0.5, 0.5] } }
volume = { lattice = { cells = 2 } }
material = { young = 3e4, density = 400 }
position = [-0.9, 0.9, 0]
)";

inline constexpr const char* kSize = "960x600";

inline Outcome debug(const TempFolder& folder, const std::string& scene, const std::string& script,
                     std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"debug", scene, "--headless", "--script", script};
  if (std::find(more.begin(), more.end(), "--size") == more.end()) words.insert(words.end(), {"--size", kSize});
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

/// A frame and its state.
using End = std::pair<int, std::string>;

/// "frame 3, state 0123456789abcdef" of the program's last line.
inline End end_of(const Outcome& outcome) {
  int frame = -1;
  char hash[32] = "";
  INFO(outcome.out << outcome.err);
  REQUIRE(std::sscanf(outcome.out.c_str(), "frame %d, state %16[0-9a-f]", &frame, hash) == 2);
  return {frame, hash};
}

/// The end of a session of these lines in s.toml; its recording ends there too, and makes the same recording.
inline End end_of_lines(const TempFolder& folder, const std::string& lines, std::vector<std::string> more = {}) {
  folder.write("a.script", lines);
  const auto recorded = [&](const char* script, const char* into) {
    std::vector<std::string> words = more;
    words.insert(words.end(), {"--record", into});
    return debug(folder, "s.toml", script, words);
  };
  const Outcome outcome = recorded("a.script", "made.script");
  INFO(lines << outcome.err);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(recorded("made.script", "again.script").out == outcome.out);
  const auto lines_of = [&](const char* script) {  // the first line tells the command
    const std::string text = slurp(folder / script);
    return text.substr(text.find('\n'));
  };
  CHECK(lines_of("again.script") == lines_of("made.script"));
  return end_of(outcome);
}

/// The state_hash of a frame in stats.csv, found by its column's name.
inline std::string hash_in(const std::filesystem::path& stats, int frame) {
  std::istringstream text(slurp(stats));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) parts.push_back(cell);
    return parts;
  };
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = cells(line);
  const auto column = static_cast<std::size_t>(std::find(names.begin(), names.end(), "state_hash") - names.begin());
  while (std::getline(text, line))
    if (const auto row = cells(line); row.at(0) == std::to_string(frame)) return row.at(column);
  return "";
}

/// One message that has `part`, exit code 2.
inline void check_refused(const Outcome& outcome, const std::string& part) {
  CAPTURE(part);
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.err.find(part) != std::string::npos);
}

}  // namespace impinge::test
