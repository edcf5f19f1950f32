// What a refusal of the program looks like, checked to the letter.
#pragma once

#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Everything in a folder, so that nothing new in it goes unseen.
inline std::vector<std::string> listing(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Runs the program: exit code 2, one message that begins with `start`, holds `contains` and a remedy, and nothing
/// written.
inline void check_refused(const TempFolder& folder, const std::vector<std::string>& arguments, const std::string& start,
                          const std::string& contains) {
  const auto before = listing(folder.path());
  const Outcome outcome = impinge_run(folder.path(), arguments);
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.out.empty());
  CHECK(outcome.err.rfind(start, 0) == 0);
  CHECK(outcome.err.find(contains) != std::string::npos);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), ';') >= 1);
  CHECK(listing(folder.path()) == before);
}

}  // namespace impinge::test
