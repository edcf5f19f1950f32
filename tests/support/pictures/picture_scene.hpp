// Runs whose pictures and states are held against each other: a crate on a slab, looked at from the front, and the
// program on it.
#pragma once

#include "tests/support/program/refusal.hpp"

namespace impinge::test {

/// A slab, and a crate that all but lies on it; what follows may add bodies and a [view].
inline constexpr const char* kCrateOnSlab = R"([[body]]
name = "floor"
kind = "static"
shape = { box = { size = [3, 0.2, 3] } }
position = [0, -0.1, 0]
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
)";

inline constexpr const char* kFrontView = "[view]\ncamera = { eye = [2.2, 1.6, 2.8], target = [0, 0.35, 0] }\n";

inline bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// impinge VERB WORDS MORE in the folder; what it says stands beside the next check.
inline Outcome told(const TempFolder& folder, std::vector<std::string> words,
                    const std::vector<std::string>& more = {}) {
  words.insert(words.end(), more.begin(), more.end());
  Outcome outcome = impinge_run(folder.path(), words);
  UNSCOPED_INFO(outcome.out << outcome.err);
  return outcome;
}

}  // namespace impinge::test
