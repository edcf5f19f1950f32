// A sweep through the program: how many jobs, what is written, that it goes on where it was stopped, and what it
// refuses.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <set>
#include <thread>

#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;
using Files = SweepFiles;

std::vector<std::string> sweep(const std::string& out, const std::vector<std::string>& more) {
  return SweepFiles::words(out, more);
}
std::vector<Row> results(const fs::path& folder) { return sweep_results(folder); }

std::size_t folders_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a sweep makes a job of each combination, and a row of each job") {
  const Files files;
  const Outcome outcome =
      files.run("out", {"--vary", "contact.friction=0,0.5", "--vary", "simulation.substeps=1:5:3", "--frames", "4"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.err.empty());
  CHECK(outcome.out.find("6 of 6 jobs done") != std::string::npos);
  const std::vector<Row> rows = results(files.folder / "out");
  REQUIRE(rows.size() == 6);
  std::set<std::string> hashes;
  const std::vector<std::string> substeps = {"1", "3", "5", "1", "3", "5"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    CHECK(row.at("contact.friction") == (i < 3 ? "0" : "0.5"));
    CHECK(row.at("simulation.substeps") == substeps[i]);
    CHECK(row.at("status") == "done");
    CHECK(row.at("reason").empty());
    CHECK(row.at("frames") == "4");
    hashes.insert(row.at("hash"));
    // the row is what the run alone says
    const std::string alone = fmt::format("alone{}", i);
    REQUIRE(impinge_run(files.folder.path(), {"run", "s.toml", "--out", alone, "--no-images", "--frames", "4", "--set",
                                              "contact.friction=" + row.at("contact.friction"), "--set",
                                              "simulation.substeps=" + row.at("simulation.substeps")})
                .code == 0);
    const std::string stats = slurp(files.folder / alone / "stats.csv");
    CHECK(stats.find(row.at("state_hash"), stats.rfind("\n4,")) != std::string::npos);
    CHECK(fs::exists(files.folder / "out/jobs" / row.at("hash") / "done"));
    CHECK(fs::exists(files.folder / "out/jobs" / row.at("hash") / "run/done"));
  }
  CHECK(hashes.size() == 6);
  CHECK(folders_in(files.folder / "out/jobs") == 6);
}

TEST_CASE("zipped values go together, and a hash names the input and not its place in the sweep") {
  const Files files;
  REQUIRE(files
              .run("zip",
                   {"--zip", "--vary", "contact.friction=0,0.5", "--vary", "simulation.substeps=2,3", "--frames", "2"})
              .code == 0);
  const std::vector<Row> zip = results(files.folder / "zip");
  REQUIRE(zip.size() == 2);
  CHECK(zip[1].at("contact.friction") == "0.5");
  CHECK(zip[1].at("simulation.substeps") == "3");
  // 2 is what the scene says: varied or not, it is the same job
  REQUIRE(files.run("one", {"--vary", "contact.friction=0.50,0", "--frames", "2"}).code == 0);
  CHECK(results(files.folder / "one")[1].at("hash") == zip[0].at("hash"));
  REQUIRE(files
              .run("vectors", {"--vary", "simulation.gravity=[0,-9.81,0],[1,-5,0]", "--vary",
                               "body.crate.position=[0,1,0],[0,2,0]", "--frames", "1"})
              .code == 0);
  const std::vector<Row> vectors = results(files.folder / "vectors");
  REQUIRE(vectors.size() == 4);
  CHECK(vectors[2].at("simulation.gravity") == "[1, -5, 0]");
  CHECK(vectors[1].at("body.crate.position") == "[0, 2, 0]");
}

TEST_CASE("a range has both ends, and a logarithmic one round numbers between them") {
  const Files files;
  REQUIRE(files
              .run("out", {"--zip", "--vary", "simulation.substeps=log(1,64,4)", "--vary", "contact.friction=0.1:0.4:4",
                           "--frames", "0"})
              .code == 0);
  const std::vector<Row> rows = results(files.folder / "out");
  REQUIRE(rows.size() == 4);
  const std::vector<std::string> substeps = {"1", "4", "16", "64"}, friction = {"0.1", "0.2", "0.3", "0.4"};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(rows[i].at("simulation.substeps") == substeps[i]);
    CHECK(rows[i].at("contact.friction") == friction[i]);
  }
}

TEST_CASE("a sweep that is there already runs nothing twice, and --job runs one alone") {
  const Files files;
  const std::vector<std::string> few = {"--vary", "contact.friction=0,0.5", "--frames", "3"},
                                 more = {"--vary", "contact.friction=0,0.25,0.5", "--frames", "3"};
  REQUIRE(files.run("out", few).code == 0);
  const std::vector<Row> before = results(files.folder / "out");
  const auto written = [&](const Row& row) {
    return fs::last_write_time(files.folder / "out/jobs" / row.at("hash") / "run/stats.csv");
  };
  const auto first = written(before[0]), second = written(before[1]);
  REQUIRE(files.run("out", few).code == 0);
  CHECK(results(files.folder / "out") == before);
  CHECK(files.run("out", more).code == 2);
  REQUIRE(files.run("out", {"--resume", "--vary", "contact.friction=0,0.25,0.5", "--frames", "3"}).code == 0);
  const std::vector<Row> after = results(files.folder / "out");
  REQUIRE(after.size() == 3);
  CHECK(after[0] == before[0]);
  CHECK(after[2] == before[1]);
  CHECK(written(before[0]) == first);
  CHECK(written(before[1]) == second);

  const fs::path folder = files.folder / "out/jobs" / before[1].at("hash");
  fs::remove_all(folder / "run");
  fs::remove(folder / "done");
  REQUIRE(impinge_run("/", {"sweep", "--job", before[1].at("hash"), "--out", (files.folder / "out").string()}).code ==
          0);
  CHECK(fs::exists(folder / "done"));
  REQUIRE(files.run("out", {"--resume", "--vary", "contact.friction=0,0.25,0.5", "--frames", "3"}).code == 0);
  CHECK(results(files.folder / "out") == after);
}

TEST_CASE("a sweep killed at any moment goes on to the same results") {
  const Files files;
  const std::vector<std::string> words = {"--vary", "contact.friction=0:1:6", "--frames", "200"};
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(files.run("whole", words).code == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  int killed = 0;
  for (const double part : {0.1, 0.3, 0.4, 0.2})
    killed +=
        impinge_stopped(files.folder.path(), sweep("parts", words), part * seconds, SIGKILL).code == -SIGKILL ? 1 : 0;
  CHECK(killed > 0);
  REQUIRE(files.run("parts", words).code == 0);
  CHECK(results(files.folder / "parts") == results(files.folder / "whole"));
}

TEST_CASE("an interrupted sweep ends its runs, writes what there is and says so") {
  const Files files;
  const Outcome outcome = impinge_stopped(
      files.folder.path(), sweep("out", {"--vary", "contact.friction=0:1:4", "--frames", "1000000"}), 1.0, SIGINT);
  INFO(outcome.err);
  CHECK(outcome.code == 130);
  CHECK(outcome.err.starts_with("interrupted: the jobs in work stop at their last whole frames"));
  CHECK(outcome.err.ends_with("\ninterrupted; the same command goes on\n"));
  CHECK(outcome.error_lines() == 2);
  const std::vector<Row> rows = results(files.folder / "out");
  REQUIRE(rows.size() == 4);
  int begun = 0;
  for (const Row& row : rows) {
    CHECK(row.at("status") == "open");
    begun += row.at("frames").empty() ? 0 : 1;
    const int lock = open((files.folder / "out/jobs" / row.at("hash") / "lock").c_str(), O_RDWR | O_CREAT, 0600);
    CHECK(flock(lock, LOCK_EX | LOCK_NB) == 0);  // no run has stayed behind
    close(lock);
  }
  CHECK(begun == 2);
}

TEST_CASE("two sweeps at once in one folder share the work and don't spoil it") {
  const Files files;
  const std::vector<std::string> words = {"--vary", "contact.friction=0:1:8", "--frames", "30"};
  REQUIRE(files.run("whole", words).code == 0);
  Outcome other;
  std::thread beside([&] { other = files.run("both", words); });
  const Outcome one = files.run("both", words);
  beside.join();
  INFO(one.err << other.err);
  CHECK(one.code == 0);
  CHECK(other.code == 0);
  CHECK(results(files.folder / "both") == results(files.folder / "whole"));
}

TEST_CASE("a job that diverges or fails is a row with its reason, and the others go on") {
  const Files files;
  files.folder.write("a.script", "expect kinetic_J < 1e6 at 3\n");
  files.folder.write("wild.toml",
                     "[simulation]\nframe_time = 10\n[[body]]\nname = \"rocket\"\nkind = \"dynamic\"\nshape = { sphere "
                     "= { radius = 1 } }\n");
  const Outcome outcome =
      impinge_run(files.folder.path(), {"sweep", "wild.toml", "--vary", "simulation.gravity=[0,1e4,0],[0,0,0]",
                                        "--frames", "2000", "--no-images", "--out", "out"});
  INFO(outcome.err);
  INFO(outcome.out);
  CHECK(outcome.code == 1);
  const std::vector<Row> rows = results(files.folder / "out");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].at("status") == "diverged");
  CHECK(rows[0].at("reason").find("'rocket'") != std::string::npos);
  CHECK(std::stoi(rows[0].at("frames")) > 2);
  CHECK(rows[1].at("status") == "done");
  CHECK(rows[1].at("frames") == "2000");

  const Outcome failing =
      files.run("expect", {"--script", "a.script", "--vary", "body.crate.velocity=[1e4,0,0],[1,0,0]", "--frames", "3"});
  CHECK(failing.code == 1);
  const std::vector<Row> two = results(files.folder / "expect");
  REQUIRE(two.size() == 2);
  CHECK(two[0].at("status") == "failed");
  CHECK(two[0].at("reason").find("a.script:1:1") != std::string::npos);
  CHECK(two[0].at("frames") == "3");
  CHECK(two[1].at("status") == "done");
}

TEST_CASE("errors against a reference are distances of surfaces") {
  // free fall by the symplectic rule is low by g h t / 2 at time t: linear in the step
  const Files files;
  files.folder.write(
      "fall.toml",
      "[[body]]\nname = \"a\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 1 } }\nposition = [0, 50, 0]\n");
  REQUIRE(
      impinge_run(files.folder.path(), {"sweep", "fall.toml", "--vary", "simulation.substeps=1,2,4,8", "--reference",
                                        "simulation.substeps=8", "--frames", "12", "--no-images", "--out", "out"})
          .code == 0);
  const std::vector<Row> rows = results(files.folder / "out");
  REQUIRE(rows.size() == 4);
  const double h = 1.0 / 60.0, g = 9.81;
  double squares = 0.0;
  for (int k = 0; k <= 12; ++k) squares += k * k * h * h;
  const double time = std::sqrt(squares / 13.0);
  const std::vector<double> steps = {h, h / 2, h / 4, h / 8};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(rows[i].at("reference") == rows[3].at("hash"));
    CHECK(std::stod(rows[i].at("error_rms_m")) ==
          Approx(0.5 * g * time * (steps[i] - steps[3])).epsilon(1e-9).margin(1e-15));
  }
}

TEST_CASE("sweeps that can't be are refused with one message, before anything is written") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  folder.write("taken/other.txt", "x");
  folder.write("file", "x");
  const auto refused = [&](const std::vector<std::string>& more, const std::string& start,
                           const std::string& contains) { check_refused(folder, sweep("out", more), start, contains); };
  refused({"--vary", "contact.frictoin=0,1"}, "--vary contact.frictoin=0,1: ", "did you mean 'contact.friction'?");
  refused({"--vary", "body.crat.mass=1,2"}, "--vary body.crat.mass=1: ", "did you mean 'crate'?");
  refused({"--vary", "body.crate.mass=1,-2"}, "--vary body.crate.mass=1,-2: ", "[1e-15, 1e+15] kg");
  refused({"--vary", "contact.friction=0:1:0"}, "--vary contact.friction=0:1:0: ", "empty range");
  refused({"--vary", "contact.friction=0:1"}, "--vary contact.friction=0:1: ", "lo:hi:n");
  refused({"--vary", "contact.friction=0:one:3"}, "--vary contact.friction=0:one:3: ", "two finite numbers");
  refused({"--vary", "contact.friction=log(0,1,3)"}, "--vary contact.friction=log(0,1,3): ", "greater than 0");
  refused({"--vary", "contact.friction="}, "--vary contact.friction=: ", "no values");
  refused({"--vary", "contact.friction=1,,2"}, "--vary contact.friction=1,,2: ", "empty value");
  refused({"--vary", "contact.friction"}, "--vary contact.friction: ", "PATH=SPEC");
  refused({"--vary", "contact.friction=0.5,0.50"}, "--vary contact.friction=0.5,0.50: ", "twice");
  refused({"--vary", "simulation.substeps=1:3:4"}, "--vary simulation.substeps=1:3:4: ", "twice");
  refused({"--vary", "contact.friction=0,-1"}, "--vary contact.friction=0,-1: ", "-1");
  refused({"--vary", "contact.friction=0,1", "--vary", "contact.friction=2"}, "--vary contact.friction: ", "twice");
  refused({"--vary", "contact.friction=0,1", "--set", "contact.friction=2"}, "--vary contact.friction=0,1: ", "--set");
  refused({"--zip", "--vary", "contact.friction=0,1", "--vary", "simulation.substeps=1,2,3"},
          "--vary simulation.substeps: ", "--zip");
  refused({"--vary", "contact.friction=0:1:1000", "--vary", "simulation.substeps=1:1000:1000"}, "--vary: 1000000 jobs",
          "--yes");
  refused({"--vary", "contact.friction=0,1", "--reference", "simulation.substep=64"},
          "--reference simulation.substep=64: ", "simulation.substeps");
  refused({}, "command line: no --vary", "--vary");
  check_refused(folder, {"sweep", "s.toml", "--vary", "contact.friction=0,1", "--jobs", "0"},
                "command line: --jobs is '0'", "1 to");
  refused({"--vary", "contact.friction=0,1", "--repeat", "0"}, "command line: --repeat is '0'", "1 to");
  refused({"--vary", "contact.friction=0,1", "--engine", "slrum"}, "command line: --engine is 'slrum'",
          "did you mean 'slurm'?");
  refused({"--vary", "contact.friction=0,1", "--window", "2"}, "--window 2: ", "without a reference");
  refused({"--vary", "contact.friction=0,1", "--reference", "contact.friction=1", "--window", "soon"},
          "--window soon: ", "seconds");
  refused({"--job", "0123456789abcdef"}, "command line: --job beside", "");
  check_refused(folder, sweep("taken", {"--vary", "contact.friction=0,1"}), "taken: ", "holds other.txt");
  check_refused(folder, sweep("file", {"--vary", "contact.friction=0,1"}), "file: ", "a folder is wanted");
  check_refused(folder, sweep("/proc/nowhere", {"--vary", "contact.friction=0,1"}), "/proc/nowhere",
                "may be written to");
  check_refused(folder, {"sweep", "none.toml", "--vary", "contact.friction=0,1"}, "none.toml: ", "no such file");
  check_refused(folder, {"sweep", "--job", "0123456789abcdef", "--out", "taken"},
                "--job 0123456789abcdef: ", "no such job");
}
