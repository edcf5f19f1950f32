// Which jobs a sweep has and in which order they run: filters, coarse first, repeats, and sweeps written down in files.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

// hashes in the order in which their jobs ended
std::vector<std::string> by_end(const SweepFiles& files, const std::string& out, const std::vector<Row>& rows) {
  std::vector<std::pair<fs::file_time_type, std::string>> ends;
  for (const Row& row : rows) ends.emplace_back(fs::last_write_time(files.job(out, row) / "done"), row.at("hash"));
  std::sort(ends.begin(), ends.end());
  std::vector<std::string> hashes;
  for (const auto& [time, hash] : ends) hashes.push_back(hash);
  return hashes;
}

double total(const fs::path& run, const std::string& name) {
  double sum = 0.0;
  for (const double value : numbers(csv_rows(run / "stats.csv"), name)) sum += value;
  return sum;
}

}  // namespace

TEST_CASE("a filter keeps the combinations for which it holds, with numbers and with words") {
  const SweepFiles files;
  const std::vector<std::string> vary = {"--vary",   "response.method=penalty,sequential_impulse",
                                         "--vary",   "simulation.substeps=1,2,4",
                                         "--vary",   "contact.friction=0,0.5",
                                         "--frames", "1"};
  const auto kept = [&](const std::string& out, const std::string& filter) {
    std::vector<std::string> words = vary;
    words.insert(words.end(), {"--filter", filter});
    const Outcome outcome = files.run(out, words);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    std::vector<std::string> jobs;
    for (const Row& row : sweep_results(files.folder / out))
      jobs.push_back(row.at("response.method").substr(0, 1) + row.at("simulation.substeps") +
                     (row.at("contact.friction") == "0" ? "-" : "+"));
    return jobs;
  };
  CHECK(kept("a", "simulation.substeps > 1 && !(contact.friction > 0)") ==
        std::vector<std::string>{"p2-", "p4-", "s2-", "s4-"});
  CHECK(kept("b", "response.method == penalty || simulation.substeps * contact.friction == 2") ==
        std::vector<std::string>{"p1-", "p1+", "p2-", "p2+", "p4-", "p4+", "s4+"});
  CHECK(kept("c", "response.method != 'penalty' && simulation.substeps != 2 && contact.friction == 0") ==
        std::vector<std::string>{"s1-", "s4-"});
  // a filtered job is the job it would be without the filter
  REQUIRE(files.run("all", vary).code == 0);
  const std::vector<Row> all = sweep_results(files.folder / "all"), some = sweep_results(files.folder / "c");
  CHECK(std::count(all.begin(), all.end(), some[0]) == 1);
  CHECK(std::count(all.begin(), all.end(), some[1]) == 1);
  // a filter makes a large product small enough not to be asked about
  CHECK(files
            .run("few", {"--vary", "contact.friction=0:1:1000", "--vary", "simulation.substeps=1:1000:1000", "--frames",
                         "0", "--filter", "contact.friction == 1 && simulation.substeps <= 2"})
            .code == 0);
  CHECK(sweep_results(files.folder / "few").size() == 2);
}

TEST_CASE("coarse first runs ends, then middles, then quarters, and changes nothing in the table") {
  const SweepFiles files;
  REQUIRE(impinge_run(files.folder.path(), {"sweep", "s.toml", "--no-images", "--out", "plain", "--vary",
                                            "contact.friction=0:0.8:9", "--frames", "2", "--jobs", "1"})
              .code == 0);
  REQUIRE(
      impinge_run(files.folder.path(), {"sweep", "s.toml", "--no-images", "--out", "coarse", "--vary",
                                        "contact.friction=0:0.8:9", "--frames", "2", "--jobs", "1", "--coarse-first"})
          .code == 0);
  const std::vector<Row> rows = sweep_results(files.folder / "plain");
  CHECK(sweep_results(files.folder / "coarse") == rows);
  std::vector<std::string> in_turn, expected;
  for (const Row& row : rows) in_turn.push_back(row.at("hash"));
  for (const int i : {0, 8, 4, 2, 6, 1, 3, 5, 7}) expected.push_back(in_turn[i]);
  CHECK(by_end(files, "plain", rows) == in_turn);
  CHECK(by_end(files, "coarse", rows) == expected);
  // of two paths the corners come first; words have no middle
  REQUIRE(impinge_run(files.folder.path(),
                      {"sweep", "s.toml", "--no-images", "--out", "two", "--vary", "simulation.substeps=1,2,3",
                       "--vary", "response.method=penalty,soft_constraint,sequential_impulse", "--frames", "1",
                       "--jobs", "1", "--coarse-first"})
              .code == 0);
  const std::vector<Row> two = sweep_results(files.folder / "two");
  std::vector<std::string> hashes;
  for (const int i : {0, 1, 2, 6, 7, 8, 3, 4, 5}) hashes.push_back(two[i].at("hash"));
  CHECK(by_end(files, "two", two) == hashes);
}

TEST_CASE("repeats make times medians with a spread, and change no other column") {
  const SweepFiles files;
  const std::vector<std::string> words = {"--vary",   "simulation.substeps=1,2",   "--frames", "20",
                                          "--column", "step_mean_ms=mean(step_ms)"};
  REQUIRE(files.run("once", words).code == 0);
  std::vector<std::string> thrice = words;
  thrice.insert(thrice.end(), {"--repeat", "3"});
  REQUIRE(files.run("thrice", thrice).code == 0);
  CHECK(sweep_results(files.folder / "thrice") == sweep_results(files.folder / "once"));
  const std::vector<Row> rows = csv_rows(files.folder / "thrice/results.csv");
  for (const Row& row : rows) {
    const fs::path job = files.job("thrice", row);
    std::vector<double> sums = {total(job / "run", "step_ms"), total(job / "repeats/2/run", "step_ms"),
                                total(job / "repeats/3/run", "step_ms")};
    std::sort(sums.begin(), sums.end());
    CHECK(sums[0] < sums[2]);
    CHECK(std::stod(row.at("step_ms")) == Approx(sums[1]).epsilon(1e-12));
    // of the processor: no more than the clock saw, but for what it counts in whole ticks
    CHECK(std::stod(row.at("step_cpu_ms")) > 0.0);
    CHECK(std::stod(row.at("step_cpu_ms")) < 1.5 * sums[2] + 5.0);
    CHECK(std::stod(row.at("spread_step_ms")) == Approx(sums[2] - sums[0]).epsilon(1e-9));
    CHECK(std::stod(row.at("step_mean_ms")) == Approx(sums[1] / 21).epsilon(1e-12));
    CHECK(std::stod(row.at("spread_wall_ms")) > 0);
  }
  CHECK(csv_rows(files.folder / "once/results.csv")[0].count("spread_step_ms") == 0);

  // more repeats of the same sweep run only what is missing
  const auto first = fs::last_write_time(files.job("thrice", rows[0]) / "run/stats.csv");
  REQUIRE(files.run("thrice", {"--vary", "simulation.substeps=1,2", "--frames", "20", "--repeat", "4"}).code == 0);
  CHECK(fs::last_write_time(files.job("thrice", rows[0]) / "run/stats.csv") == first);
  CHECK(fs::exists(files.job("thrice", rows[0]) / "repeats/4/done"));

  // a repeat that went another way is told, loudly
  const fs::path stats = files.job("thrice", rows[1]) / "repeats/3/run/stats.csv";
  const std::string hash = csv_rows(stats)[17].at("state_hash");
  const std::string text = slurp(stats);
  std::ofstream(stats, std::ios::binary) << replaced(
      text, hash, hash == "0123456789abcdef" ? "f123456789abcdef" : "0123456789abcdef");
  const Outcome outcome = files.run("thrice", thrice);
  CHECK(outcome.code == 1);
  const std::vector<Row> after = sweep_results(files.folder / "thrice");
  CHECK(after[0].at("status") == "done");
  CHECK(after[1].at("status") == "unequal");
  CHECK(after[1].at("reason").find("repeat 3 has another state in frame 17") != std::string::npos);
  CHECK(outcome.out.find("repeat 3 has another state in frame 17") != std::string::npos);
}

TEST_CASE("a sweep in a file is the sweep of the same words, and the command line wins") {
  const SweepFiles files;
  files.folder.write("plans/one.toml", R"T([sweep]
scene = "../s.toml"
set = ["contact.restitution=0.25"]
filter = "simulation.substeps != 3"
reference = "simulation.substeps=8"
window = "all"
frames = 3
images = false
jobs = 2
repeat = 2
coarse_first = true
[sweep.vary]
simulation.substeps = [1, 2, 3]
body.crate.velocity = [[1, 0, 0], [2, 0, 0]]
contact.friction = "0:0.5:2"
[sweep.columns]
deepest = "max(max_penetration_m)"
)T");
  const Outcome outcome = impinge_run(files.folder.path(), {"sweep", "plans/one.toml", "--out", "file"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const std::vector<std::string> words = {"--set",       "contact.restitution=0.25",
                                          "--vary",      "simulation.substeps=1,2,3",
                                          "--vary",      "body.crate.velocity=[1,0,0],[2,0,0]",
                                          "--vary",      "contact.friction=0:0.5:2",
                                          "--filter",    "simulation.substeps != 3",
                                          "--reference", "simulation.substeps=8",
                                          "--window",    "all",
                                          "--frames",    "3",
                                          "--repeat",    "2",
                                          "--column",    "deepest=max(max_penetration_m)"};
  REQUIRE(files.run("words", words).code == 0);
  CHECK(sweep_results(files.folder / "file") == sweep_results(files.folder / "words"));
  CHECK(sweep_results(files.folder / "file").size() == 8);
  CHECK(csv_rows(files.folder / "file/results.csv")[0].count("spread_step_ms") == 1);
  // what a sweep leaves of itself repeats it
  REQUIRE(impinge_run(files.folder.path(), {"sweep", "words/sweep.toml", "--window", "all", "--column",
                                            "deepest=max(max_penetration_m)", "--out", "again"})
              .code == 0);
  CHECK(sweep_results(files.folder / "again") == sweep_results(files.folder / "words"));

  REQUIRE(impinge_run(files.folder.path(), {"sweep", "plans/one.toml", "--vary", "simulation.substeps=2,4", "--filter",
                                            "simulation.substeps > 2", "--frames", "1", "--out", "less"})
              .code == 0);
  const std::vector<Row> less = sweep_results(files.folder / "less");
  REQUIRE(less.size() == 1);
  CHECK(less[0].at("simulation.substeps") == "4");
  CHECK(less[0].at("frames") == "1");

  const std::string example = IMPINGE_SOURCE_DIR "/scenes/minimal_sweep.toml";
  REQUIRE(
      impinge_run(files.folder.path(), {"sweep", example, "--frames", "2", "--repeat", "1", "--out", "example"}).code ==
      0);
  CHECK(sweep_results(files.folder / "example").size() == 14);
  check_refused(files.folder, {"run", "plans/one.toml", "--out", "no"}, "plans/one.toml:2:1: ", "impinge sweep");

  // the table in the scene itself, which runs and checks as before
  files.folder.write("both.toml", std::string(kCrateScene) +
                                      "[sweep]\nvary = [\"contact.friction=0,1\"]\nframes = 2\nimages = false\n");
  REQUIRE(impinge_run(files.folder.path(), {"sweep", "both.toml", "--out", "both"}).code == 0);
  CHECK(sweep_results(files.folder / "both").size() == 2);
  CHECK(impinge_run(files.folder.path(), {"run", "both.toml", "--frames", "1", "--no-images", "--out", "run"}).code ==
        0);
}

TEST_CASE("sweep files, filters and columns that can't be are refused at their place") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const auto refused = [&](const std::string& table, const std::string& start, const std::string& contains) {
    folder.write("p.toml", "[sweep]\nscene = \"s.toml\"\n" + table + "\n");
    check_refused(folder, {"sweep", "p.toml", "--out", "out"}, start, contains);
  };
  refused("vary = [\"contact.friction=0,1\"]\nrepat = 2", "p.toml:4:1: ", "did you mean 'repeat'?");
  refused("vary = [\"contact.frictoin=0,1\"]", "p.toml:3:9: ", "did you mean 'contact.friction'?");
  refused("[sweep.vary]\ncontact.frictoin = [0, 1]", "p.toml:4:20: ", "did you mean 'contact.friction'?");
  refused("[sweep.vary]\ncontact.friction = []", "p.toml:4:20: ", "no values");
  refused("[sweep.vary]\ncontact.friction = [0.5, 0.50]", "p.toml:4:20: ", "twice");
  refused("[sweep.vary]\nbody.crate.mass = [1, -2]", "p.toml:4:19: ", "[1e-15, 1e+15] kg");
  refused("[sweep.vary]\ncontact.friction = \"0:1:0\"", "p.toml:4:20: ", "empty range");
  refused("[sweep.vary]\ncontact.friction = \"0:1:1000\"\nsimulation.substeps = \"1:1000:1000\"",
          "p.toml:4:20: ", "--yes");
  refused("vary = [\"contact.friction=0,1\"]\nfilter = \"contact.friction > x\"", "p.toml:4:30: ", "contact.friction");
  refused("vary = [\"contact.friction=0,1\"]\nrepeat = 0", "p.toml:4:10: ", "1 to");
  refused("vary = [\"contact.friction=0,1\"]\nwindow = -1", "p.toml:4:10: ", "seconds");
  refused("vary = [\"contact.friction=0,1\"]\nreference = \"fines\"", "p.toml:4:13: ", "finest");
  refused("vary = [\"contact.friction=0,1\"]\n[sweep.columns]\na = \"max(contact)\"",
          "p.toml:5:6: ", "did you mean 'max(contacts)'?");
  refused("", "command line: no --vary, and no [sweep] vary in p.toml", "--vary");
  folder.write("p.toml", "[sweep]\nscene = \"s.toml\"\nvary = [\"contact.friction=0,1\"]\n[contact]\nfriction = 1\n");
  check_refused(folder, {"sweep", "p.toml", "--out", "out"}, "p.toml:4:2: ", "'contact' beside");
  folder.write("p.toml", "[sweep]\nscene = \"none.toml\"\nvary = [\"contact.friction=0,1\"]\n");
  check_refused(folder, {"sweep", "p.toml", "--out", "out"}, "p.toml:2:9: ", "no scene none.toml");

  const auto words = [&](const std::vector<std::string>& more, const std::string& start, const std::string& contains) {
    std::vector<std::string> all = SweepFiles::words(
        "out", {"--vary", "contact.friction=0,1", "--vary", "response.method=penalty,soft_constraint"});
    all.insert(all.end(), more.begin(), more.end());
    check_refused(folder, all, start, contains);
  };
  words({"--filter", "contact.frictoin > 0"}, "--filter:1:1: ", "did you mean 'contact.friction'?");
  words({"--filter", "response.method == penalti"}, "--filter:1:20: ", "did you mean 'penalty'?");
  words({"--filter", "response.method > 1"}, "--filter:1:1: ", "a number should stand here");
  words({"--filter", "response.method == 1"}, "--filter:1:20: ", "a text should stand here");
  words({"--filter", "contact.friction"}, "--filter:1:1: ", "a condition is wanted");
  words({"--filter", "contact.friction > 3"}, "--filter contact.friction > 3: ", "none of 4 combinations");
  words({"--column", "a"}, "--column a: ", "NAME=EXPR");
  words({"--column", "2a=1"}, "--column 2a=1: ", "no digit first");
  words({"--column", "residual_max=max(residual)"}, "--column residual_max=", "a second column");
  words({"--column", "a=max(contact)"}, "--column:1:3: ", "did you mean 'max(contacts)'?");
  words({"--column", "a=max(step_ms)"}, "--column a=max(step_ms): ", "end in _ms");
  words({"--column", "a_ms=max(contacts)"}, "--column a_ms=max(contacts): ", "end in _ms");
  words({"--column", "a=response.method"}, "--column:1:3: ", "a number is wanted");
}

TEST_CASE("own columns are what the figures of the run say") {
  const SweepFiles files;
  REQUIRE(files
              .run("out", {"--vary", "simulation.substeps=1,3", "--frames", "30", "--column",
                           "a=max(contacts) + 10 * simulation.substeps", "--column", "b=mean(kinetic_J) / last(time_s)",
                           "--column", "c=min(potential_J) - sum(residual)", "--column",
                           "deep=max(max_penetration_m) > 1", "--column", "none=1 / (min(contacts) - min(contacts))"})
              .code == 0);
  for (const Row& row : sweep_results(files.folder / "out")) {
    const std::vector<Row> frames = csv_rows(files.job("out", row) / "run/stats.csv");
    const auto values = [&](const char* name) { return numbers(frames, name); };
    double contacts = 0, kinetic = 0, potential = 1e300, residual = 0;
    for (const double v : values("contacts")) contacts = std::max(contacts, v);
    for (const double v : values("kinetic_J")) kinetic += v;
    for (const double v : values("potential_J")) potential = std::min(potential, v);
    for (const double v : values("residual")) residual += v;
    CHECK(contacts > 0);
    CHECK(std::stod(row.at("a")) == contacts + 10 * std::stod(row.at("simulation.substeps")));
    CHECK(std::stod(row.at("b")) == Approx(kinetic / 31 / values("time_s").back()).epsilon(1e-14));
    CHECK(std::stod(row.at("c")) == Approx(potential - residual).epsilon(1e-14));
    CHECK(row.at("deep") == "0");
    CHECK(row.at("none").empty());
  }
}
