// What a sweep says of jobs that ended and can't be trusted, and of jobs that somebody judged.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <regex>

#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// By explicit springs: too soft it sinks through, too stiff it is thrown off.
const std::string kSprings = std::string(R"([response]
method = "penalty"
[response.penalty]
form = "explicit"
)") + kTiltedBox;

/// Whether the run of one job alone has something to say that begins so.
bool alone_says(const SweepFiles& files, const std::string& stiffness, const std::string& what) {
  const Outcome alone =
      impinge_run(files.folder.path(), {"run", "springs.toml", "--frames", "30", "--no-images", "--out",
                                        "alone" + stiffness, "--set", "response.penalty.stiffness=" + stiffness});
  REQUIRE(alone.code == 0);
  return alone.out.find(what) != std::string::npos;
}

}  // namespace

TEST_CASE("a job that blew up is done and in doubt, and is nowhere the best") {
  const SweepFiles files;
  files.folder.write("springs.toml", kSprings);
  const Outcome outcome = files.run(
      "out",
      {"--vary", "response.penalty.stiffness=1e5,1e12", "--vary", "response.method=penalty,constraint_anticipation",
       "--reference", "response.method=constraint_anticipation", "simulation.substeps=8", "--frames", "30"},
      "springs.toml");
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "out");
  REQUIRE(rows.size() == 4);
  CHECK(outcome.out.find("4 of 4 jobs done, 2 of them in doubt") != std::string::npos);
  CHECK(outcome.out.find("done, in doubt") != std::string::npos);
  const std::string page = slurp(files.folder / "out/report.html");
  CHECK(page.find("2 are in doubt") != std::string::npos);
  const std::size_t best = page.find("<b>Best:</b>");
  REQUIRE(best != std::string::npos);
  const std::string best_line = page.substr(best, page.find("</li>", best) - best);
  for (const Row& row : rows) {
    CAPTURE(row.at("hash"), row.at("response.method"), row.at("doubts"));
    CHECK(row.at("status") == "done");
    const bool is_penalty = row.at("response.method") == "penalty";
    CHECK(row.at("doubts").empty() != is_penalty);
    if (!is_penalty) CHECK(row.at("unsafe_motions") == "0");
    // what the run said is kept, and it is no part of what is best
    const std::string said = slurp(files.job("out", row) / "output.txt");
    CHECK(said.find("figures:") != std::string::npos);
    CHECK((said.find("energy that nobody gave") != std::string::npos) ==
          (row.at("doubts").find("energy that nobody gave") != std::string::npos));
    if (is_penalty) CHECK(best_line.find(row.at("hash")) == std::string::npos);
  }
  CHECK(alone_says(files, "1e5", "may have passed 'floor'"));
  CHECK(rows[0].at("doubts").find("may have passed 'floor'") != std::string::npos);
  CHECK(std::stod(rows[0].at("unsafe_motions")) > 0);
  CHECK(alone_says(files, "1e12", "energy that nobody gave"));
  CHECK(rows[2].at("doubts").find("energy that nobody gave") != std::string::npos);
}

TEST_CASE("a sweep can be judged, by an option, a file or the run that it varies, and its columns then are there") {
  const SweepFiles files;
  const std::vector<std::string> vary = {"--vary", "simulation.substeps=1,2", "--frames", "5"};
  const auto with = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> words = vary;
    words.insert(words.end(), more);
    return words;
  };
  REQUIRE(files.run("plain", vary).code == 0);
  const std::vector<Row> plain = sweep_results(files.folder / "plain");
  check_refused(files.folder, SweepFiles::words("no", with({"--column", "jp=max(judged_penetration_m)"})),
                "--column:1:", "with --judge of judged_... too");

  const auto judged = [&](const std::string& out, const std::vector<std::string>& words, const std::string& scene) {
    const Outcome outcome = files.run(out, words, scene);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::vector<Row> rows = sweep_results(files.folder / out);
    REQUIRE(rows.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(rows[i].at("frames") == "5");
      CHECK(rows[i].at("state_hash") == plain[i].at("state_hash"));
      CHECK(rows[i].at("energy_drift_max_J") == plain[i].at("energy_drift_max_J"));
      // the largest of the run's own column
      const std::vector<double> depths =
          numbers(csv_rows(files.job(out, rows[i]) / "run/stats.csv"), "judged_penetration_m");
      CHECK(std::stod(rows[i].at("jp")) == *std::max_element(depths.begin(), depths.end()));
    }
    return rows;
  };
  judged("option", with({"--judge", "--column", "jp=max(judged_penetration_m)"}), "s.toml");
  REQUIRE(impinge_run(files.folder.path(), {"run", "s.toml", "--judge", "--frames", "5", "--no-images", "--out", "run"})
              .code == 0);
  judged("of_run", with({"--column", "jp=max(judged_penetration_m)"}), "run/run.toml");
  files.folder.write("sweep.toml",
                     "[sweep]\nscene = \"s.toml\"\njudge = \"substeps\"\nframes = 5\nvary = "
                     "\"simulation.substeps=1,2\"\ncolumns = { jp = \"max(judged_penetration_m)\" }\n");
  judged("file", {}, "sweep.toml");
  CHECK(slurp(files.folder / "file/sweep.toml").find("judge = \"substeps\"") != std::string::npos);
}
