// impinge compare
#include "viewer/compare/runs.hpp"

#include "viewer/app/shared_options.hpp"

namespace impinge {

namespace {

class CompareCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("A", runs_.a, "folder of a run");
    options.word("B", runs_.b, "folder of a run");
    options.path("--out", runs_.out, "folder for difference.csv, its plot, and frames of A and B side by side");
    tolerance_option(options, runs_.tolerance,
                     "of pictures: largest difference of a channel, of 255, that counts as equal (default: 3)");
    threads_option(options);
  }
  int run() override { return compare_runs(runs_); }

 private:
  RunsOptions runs_;
};

}  // namespace

Entry<SubCommand> compare_command() {
  return entry<SubCommand, CompareCommand>(
      "compare", "two runs: what was set differently, and in which frame, body and field they part");
}

}  // namespace impinge
