// Sweeps over methods: all are held against one truth, and a report that does otherwise begins by saying so. Beside it:
// several values after one option, as the help prints it.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A ball of 1 kg rests on a floor. On springs of 1e4 N/m it sinks by g/1e4 m, however small the steps; exactly it
/// stays.
constexpr const char* kBall = R"([simulation]
sleeping = false
[response]
penalty_stiffness = 1e4
penalty_damping = 200
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "ball"
kind = "dynamic"
mass = 1
shape = { sphere = { radius = 0.5 } }
position = [0, 0.5, 0]
)";
constexpr double kSinks = 9.81 / 1e4;

std::vector<std::string> references(const std::vector<Row>& rows) {
  std::set<std::string> all;
  for (const Row& row : rows) all.insert(row.at("reference"));
  return {all.begin(), all.end()};
}

}  // namespace

TEST_CASE("a sweep over methods has the scene's method as its reference unless it names one") {
  const SweepFiles files;
  files.folder.write("ball.toml", kBall);
  const std::vector<std::string> vary = {"--vary",   "response.method=constraint_anticipation,penalty",
                                         "--vary",   "simulation.substeps=4,8",
                                         "--window", "all",
                                         "--frames", "60"};
  const auto sweep = [&](const std::string& out, const std::vector<std::string>& reference) {
    std::vector<std::string> words = vary;
    words.insert(words.end(), reference.begin(), reference.end());
    const Outcome outcome = files.run(out, words, "ball.toml");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return sweep_results(files.folder / out);
  };
  // springs are in place within a frame, so all but frame 0 of 61 are as deep as they get
  const double wanted = kSinks * std::sqrt(60.0 / 61.0);
  for (const auto& [out, reference] :
       {std::pair<std::string, std::vector<std::string>>("default", {"--reference", "simulation.substeps=32"}),
        {"named", {"--reference", "simulation.substeps=32", "response.method=constraint_anticipation"}}}) {
    const std::vector<Row> rows = sweep(out, reference);
    CHECK(references(rows).size() == 1);
    for (int i : {0, 1}) CHECK(std::stod(rows[i].at("error_rms_m")) < 1e-6);
    for (int i : {2, 3}) CHECK(std::stod(rows[i].at("error_rms_m")) == Approx(wanted).epsilon(0.02));
    CHECK(slurp(files.folder / (out + "/summary.txt")).find("response.method=constraint_anticipation") !=
          std::string::npos);
    CHECK(slurp(files.folder / (out + "/summary.txt")).find("caution") == std::string::npos);
    CHECK(slurp(files.folder / (out + "/report.html")).find("Caution:") == std::string::npos);
  }
  // the scene's, whatever it is; and a method that is named
  for (const std::vector<std::string>& reference :
       {std::vector<std::string>{"--reference", "simulation.substeps=32", "--set", "response.penalty_form=implicit"},
        {"--reference", "simulation.substeps=32", "response.method=penalty"}}) {
    const bool named = reference.size() == 3;
    if (!named) files.folder.write("ball.toml", replaced(kBall, "[response]\n", "[response]\nmethod = \"penalty\"\n"));
    const std::vector<Row> rows = sweep(named ? "springs named" : "springs", reference);
    CHECK(references(rows).size() == 1);
    for (int i : {0, 1}) CHECK(std::stod(rows[i].at("error_rms_m")) == Approx(wanted).epsilon(0.02));
    for (int i : {2, 3}) CHECK(std::stod(rows[i].at("error_rms_m")) < 0.1 * wanted);
  }
}

TEST_CASE("a report whose jobs were held against different methods begins by saying so") {
  const SweepFiles files;
  files.folder.write("ball.toml", kBall);
  const auto sweep = [&](const std::string& out, const std::string& first, const std::string& reference) {
    REQUIRE(files
                .run(out,
                     {"--vary", first, "simulation.substeps=2,8", "--reference", reference, "--window", "all",
                      "--frames", "4"},
                     "ball.toml")
                .code == 0);
  };
  sweep("own", "response.method=constraint_anticipation,penalty", "finest");
  CHECK(references(sweep_results(files.folder / "own")).size() == 2);
  const std::string summary = slurp(files.folder / "own/summary.txt"), page = slurp(files.folder / "own/report.html");
  const std::size_t said = summary.find("caution: the jobs were held against 2 different methods");
  CHECK(said < summary.find("response.method  "));
  CHECK(said < 60);
  const std::size_t shown = page.find("<b>Caution:</b> the jobs were held against 2 different methods");
  CHECK(shown != std::string::npos);
  CHECK(shown < page.find("<ul class=\"summary\">"));
  // each against its own, but all by one method
  sweep("pull", "simulation.gravity=[0,-9.81,0],[0,-5,0]", "finest");
  CHECK(references(sweep_results(files.folder / "pull")).size() == 2);
  CHECK(slurp(files.folder / "pull/summary.txt").find("caution") == std::string::npos);
  CHECK(slurp(files.folder / "pull/report.html").find("Caution:") == std::string::npos);
}

TEST_CASE("several values may follow one --vary, --reference, --column and --set, as the help prints them") {
  const SweepFiles files;
  files.folder.write("ball.toml", kBall);
  const std::string help = impinge_run(files.folder.path(), {"sweep", "--help"}).out;
  for (const char* option : {"--vary TEXT ...", "--reference TEXT ...", "--column TEXT ...", "--set TEXT ..."})
    CHECK(help.find(option) != std::string::npos);
  const Outcome one =
      files.run("one",
                {"--vary", "simulation.substeps=1,2", "contact.friction=0,0.5", "--reference", "simulation.substeps=4",
                 "contact.friction=0.25", "--column", "a=last(contacts)", "b=max(contacts)", "--set",
                 "simulation.sleeping=true", "contact.restitution=0.5", "--frames", "3"},
                "ball.toml");
  INFO(one.err);
  REQUIRE(one.code == 0);
  REQUIRE(files
              .run("each",
                   {"--vary", "simulation.substeps=1,2", "--vary", "contact.friction=0,0.5", "--reference",
                    "simulation.substeps=4", "--reference", "contact.friction=0.25", "--column", "a=last(contacts)",
                    "--column", "b=max(contacts)", "--set", "simulation.sleeping=true", "--set",
                    "contact.restitution=0.5", "--frames", "3"},
                   "ball.toml")
              .code == 0);
  CHECK(sweep_results(files.folder / "one").size() == 4);
  CHECK(slurp(files.folder / "one/sweep.toml") == slurp(files.folder / "each/sweep.toml"));
  // the scene may stand behind them, and other words are refused as ever
  const auto ran = [&](const std::vector<std::string>& words) { return impinge_run(files.folder.path(), words); };
  CHECK(ran({"check", "--set", "contact.friction=0.5", "simulation.substeps=2", "ball.toml"}).code == 0);
  CHECK(ran({"check", "--set=contact.friction=0.5", "simulation.substeps=x", "ball.toml"}).err.find("substeps=x") !=
        std::string::npos);
  CHECK(ran({"run", "ball.toml", "--no-images", "--frames", "1", "--set", "contact.friction=0.5",
             "contact.restitution=0.1", "--out", "run"})
            .code == 0);
  CHECK(ran({"info", "ball.toml", "--set", "contact.friction=0.5", "contact.restitution=0.1"}).code == 0);
  CHECK(ran({"check", "ball.toml", "--set", "contact.friction=0.5", "extra"}).code == 2);
}
