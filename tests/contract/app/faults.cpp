// The scenes with a fault each (scenes/faults): the fault shows in a figure, the remedy that its page names takes it away,
// and the recording that leads to its cause plays.
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const fs::path kFaults = fs::path(IMPINGE_SOURCE_DIR) / "scenes/faults";

struct Fault {
  std::string scene, column;
  double limit;                     ///< the column's largest value is above it with the fault, below it without
  int frames;                       ///< until then
  std::vector<std::string> remedy;  ///< --set
};

double largest(const TempFolder& folder, const Fault& fault, const std::vector<std::string>& more) {
  const std::string out = more.empty() ? "with" : "without";
  std::vector<std::string> words = {"run",         (kFaults / (fault.scene + ".toml")).string(),
                                    "--no-images", "--quiet",
                                    "--frames",    std::to_string(fault.frames),
                                    "--out",       out};
  for (const std::string& set : more) words.insert(words.end(), {"--set", set});
  const Outcome outcome = impinge_run(folder.path(), words);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const std::vector<double> all = numbers(csv_rows(folder / out / "stats.csv"), fault.column);
  return *std::max_element(all.begin(), all.end());
}

}  // namespace

TEST_CASE("each planted fault shows in its figure, and its remedy takes it away") {
  const std::vector<Fault> faults = {
      {"passed_sheet", "unsafe_motions", 0.5, 3, {"narrow_phase.continuous=auto"}},
      {"start_overlap", "max_penetration_m", 0.1, 1, {"body.right.position=[0.8,0.5,0.2]"}},
      {"inside_solid",
       "max_penetration_m",
       0.1,
       1,
       {"body.red_ball.position=[0.3,2,0]", "body.blue_ball.position=[-0.3,2,0]"}},
      {"mass_ratio", "max_penetration_m", 0.01, 30, {"response.method=constraint_anticipation"}},
      {"few_substeps", "unsafe_motions", 0.5, 40, {"response.method=constraint_anticipation"}},
      {"wrong_unit", "kinetic_J", 1e9, 30, {"body.bunny.scale=1"}},
      {"activation_distance", "contacts", 40, 0, {"contact.activation_distance=auto"}},
      {"contradiction",
       "attachment_error_m",
       1e-3,
       20,
       {"body.left_gripper.motion=[{time=0,position=[-0.56,1,0],rotation=[0,0,0]}]"}},
      {"unconverged", "unconverged", 0.5, 20, {"response.method=constraint_anticipation"}},
  };
  for (const Fault& fault : faults) {
    const TempFolder folder;
    CAPTURE(fault.scene);
    CHECK(largest(folder, fault, {}) > fault.limit);
    CHECK(largest(folder, fault, fault.remedy) < fault.limit);
  }
}

TEST_CASE("elements that a run leaves inside out are named at its end") {
  const TempFolder folder;
  const auto end_with = [&](const std::string& young) {
    return impinge_run(folder.path(), {"run", (kFaults / "inverted_element.toml").string(), "--no-images", "--frames",
                                       "30", "--set", "body.jelly.material.young=" + young, "--out", young})
        .out;
  };
  CHECK(end_with("2000").find("'jelly' ended crushed") != std::string::npos);
  CHECK(end_with("200000").find("crushed") == std::string::npos);
}

TEST_CASE("the recording of each planted fault plays to its end, twice to the same state, and leaves its picture") {
  int played = 0;
  for (const auto& entry : fs::directory_iterator(kFaults)) {
    if (entry.path().extension() != ".script") continue;
    const TempFolder folder;
    const std::string name = entry.path().stem().string();
    CAPTURE(name);
    std::string ends[2];
    for (std::string& end : ends) {
      const Outcome outcome =
          impinge_run(folder.path(), {"debug", (kFaults / (name + ".toml")).string(), "--headless", "--script",
                                      entry.path().string(), "--size", "960x600", "--out", "o"});
      INFO(outcome.err);
      CHECK(outcome.code == 0);
      CHECK(outcome.err.empty());
      end = outcome.out;
    }
    CHECK(ends[0] == ends[1]);
    CHECK(fs::exists(folder / "o" / (name + ".png")));
    ++played;
  }
  CHECK(played == 10);
}
