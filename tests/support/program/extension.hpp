// The program with something more: built as a README tells, without touching the tree.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

namespace impinge::test {

/// A piece of code in a README with the file that it is said to go into: the last path in back quotes before it.
struct Recipe {
  std::string file, code;
};
/// The pieces of code between the paragraph that begins with **`what` and the next such paragraph or heading.
std::vector<Recipe> recipes(const std::string& readme, const std::string& what);

class ExtendedProgram {
 public:
  /// Code for a file that is there goes to the end of the list in it whose lines begin in the same way; other code is a
  /// new file.
  void add(const Recipe& recipe);
  /// Compiles what was added by the build's own commands, and links it before the libraries. What the compiler has to
  /// say is in `err`.
  Outcome build();
  Outcome run(const std::filesystem::path& folder, const std::vector<std::string>& words) const;
  int new_files() const { return new_files_; }
  int new_lines() const { return new_lines_; }  ///< in files that were there

 private:
  TempFolder folder_;
  std::map<std::string, std::string> texts_;  // by file
  int new_files_ = 0, new_lines_ = 0;
};

}  // namespace impinge::test
