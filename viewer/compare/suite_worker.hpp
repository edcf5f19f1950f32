// One test of a suite in a process of its own: what it came to gets back here as bytes on its stdout.
#pragma once

#include <optional>
#include <string>

#include "engine/io/child_process.hpp"
#include "viewer/compare/suite.hpp"
#include "viewer/report/junit.hpp"

namespace impinge {

/// What a test came to, or why the suite can't go on.
struct SuiteResult {
  TestOutcome outcome;
  std::string gave_up;  ///< something can't be written; "": nothing of that kind
};

/// In the worker: prints its result, as nothing but SuiteWorker reads it.
void print_result(const SuiteResult& result);
/// In the worker, before all else: it gets no Ctrl-C of its own and ends with the process that started it.
void belong_to_suite();

class SuiteWorker {
 public:
  /// Starts it. Throws InputError where there can be no more processes.
  SuiteWorker(const SuiteOptions& options, const std::string& name, int threads);
  SuiteWorker(SuiteWorker&& other) noexcept;
  SuiteWorker& operator=(SuiteWorker&&) = delete;
  ~SuiteWorker();

  /// What it came to, once it has ended. One that was ended by a signal is an error of its test.
  std::optional<SuiteResult> poll();
  void interrupt() const;

 private:
  std::string name_;
  int out_ = -1, err_ = -1;  // files in memory: nobody has to empty them meanwhile
  std::optional<ChildProcess> child_;
};

}  // namespace impinge
