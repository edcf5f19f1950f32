// impinge verify
#include <fmt/format.h>

#include "viewer/app/sub_command.hpp"
#include "viewer/study/verify_ccd.hpp"

namespace impinge {

namespace {

class VerifyCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("NAME", name_, "the case: ccd, continuous detection on queries whose answers are known");
    options.path(
        "--queries", queries_,
        "ccd: folder of queries; .csv files in folders named edge-edge and vertex-face, eight rows a query, each "
        "three fractions and 0 or 1 for whether the features meet");
    options.real("--tolerance", settings_.tolerance, 1e-15, 1e3,
                 "ccd: how far apart features may be that are still said to meet, metres (default: 1e-6)");
  }

  int run() override {
    if (name_ != "ccd") refuse_option("no case '" + name_ + "'", "ccd", "write 'impinge verify ccd --queries DIR'");
    if (queries_.empty())
      refuse_option("no --queries", "a folder of queries with their answers",
                    "write 'impinge verify ccd --queries DIR'");
    const std::vector<CcdScore> scores = score_ccd(read_ccd_sets(queries_), settings_);
    fmt::print("{}", table_of(scores));
    int missed = 0;
    for (const CcdScore& score : scores) missed += score.missed;
    if (missed > 0) fmt::print(stderr, "verify: meetings are missed\n");
    return missed > 0 ? 1 : 0;
  }

 private:
  std::string name_;
  std::filesystem::path queries_;
  ContinuousSettings settings_{0.0, 1e-6, 1'000'000};
};

}  // namespace

Entry<SubCommand> verify_command() {
  return entry<SubCommand, VerifyCommand>("verify", "hold the program against answers that are known");
}

}  // namespace impinge
