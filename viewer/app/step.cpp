// impinge step: one problem, solved by every method, all judged by the same residual.
#include "engine/frozen/frozen_step_file.hpp"
#include "viewer/app/sub_command.hpp"
#include "viewer/study/methods.hpp"

namespace impinge {

namespace {

class StepCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("FILE", step_.file,
                 "frozen step of impinge run --freeze, or a problem as Siconos writes it in plain text (W, q, mu)");
    options.names(
        "--response", step_.responses,
        "of a frozen step: responses to run, with commas between them (default: all; see impinge list responses)");
    options.names("--lcp", step_.lcp,
                  "solvers to run, with commas between them (default: all that apply; see impinge list lcp_solvers)");
    options.real("--tolerance", step_.tolerance, 1e-16, 1.0,
                 "relative residual to reach: of a frozen step the natural map, of a published problem Siconos' "
                 "(default: 1e-8)");
    options.whole("--max-iterations", step_.max_iterations, 1, 100'000'000, "iterations at most (default: 2000)");
    options.text("--out", step_.out,
                 "folder for methods.csv, solution_METHOD.csv, history_METHOD.csv, work_precision.csv and their plots");
  }

  int run() override {
    is_frozen_step(step_.file) ? step_frozen(step_) : step_published(step_);
    return 0;
  }

 private:
  StepOptions step_;
};

}  // namespace

Entry<SubCommand> step_command() {
  return entry<SubCommand, StepCommand>(
      "step", "solve a frozen step or a published friction-contact problem with every method, and compare them");
}

}  // namespace impinge
