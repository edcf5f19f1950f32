// The scenes of a folder that have a script, as a test suite.
#pragma once

#include <filesystem>

namespace impinge {

struct SuiteOptions {
  std::filesystem::path folder;   ///< of NAME.toml and NAME.script
  std::filesystem::path out;      ///< for runs and reports; "": out/FOLDER-test
  std::filesystem::path junit;    ///< XML file of the outcome, "" for none
  int width = 320, height = 180;  ///< of pictures without a baseline yet, pixels
  bool update = false;            ///< write pictures that differ or are missing
};

/// Prints each test's outcome. Returns the exit code: 1 where one failed. Throws InputError where the suite can't be run,
/// OutputError where something can't be written.
int run_suite(const SuiteOptions& options);

}  // namespace impinge
