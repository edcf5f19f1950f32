// The scenes of a folder that have a script, as a test suite.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace impinge {

struct SuiteOptions {
  std::filesystem::path folder;   ///< of NAME.toml and NAME.script
  std::filesystem::path out;      ///< for runs and reports; "": out/FOLDER-test
  std::filesystem::path junit;    ///< XML file of the outcome, "" for none
  int width = 320, height = 180;  ///< of pictures without a baseline yet, pixels
  bool update = false;            ///< write pictures that differ or are missing
  std::vector<std::string> only;  ///< names of the tests that are meant; empty: all
  int jobs = 1;                   ///< tests at once; more than one: each in a process of its own
  std::string worker;             ///< the one test that this process is for, "" unless it is such a process
};

/// Prints each test's outcome. Returns the exit code: 1 where one failed. Throws InputError where the suite can't be run,
/// OutputError where something can't be written.
int run_suite(const SuiteOptions& options);

}  // namespace impinge
