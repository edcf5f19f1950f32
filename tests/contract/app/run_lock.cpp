// One run a folder: a second one is refused at once, and whatever ends the first, the next goes on.
#include <catch2/catch.hpp>

#include <csignal>
#include <map>
#include <thread>

#include "tests/support/pictures/picture_scene.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Every file of a run's folder with what is in it; times, and only they, are left out.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const std::string& name : listing(folder)) {
    if (!fs::is_regular_file(name)) continue;
    std::string text = slurp(name);
    if (fs::path(name).filename() == "stats.csv") {
      text.clear();
      for (const Row& row : csv_rows(name))
        for (const auto& [column, cell] : row)
          if (!column.ends_with("_ms")) text += column + "=" + cell + ",";
    }
    all[fs::relative(name, folder).string()] = text;
  }
  return all;
}

std::vector<std::string> run_words(const std::string& out, int frames, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"run",     "s.toml",      "--out",     out, "--frames", std::to_string(frames),
                                    "--quiet", "--no-images", "--contacts"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Until a frame stands in it: before that there is nothing to replay.
void wait_for_frame(const fs::path& stats) {
  const auto lines = [&] {
    const std::string text = slurp(stats);
    return std::count(text.begin(), text.end(), '\n');
  };
  for (int i = 0; i < 6000 && lines() < 2; ++i) std::this_thread::sleep_for(10ms);
  REQUIRE(lines() >= 2);
}

void wait_for(const fs::path& file) {
  for (int i = 0; i < 6000 && !fs::exists(file); ++i) std::this_thread::sleep_for(10ms);
  REQUIRE(fs::exists(file));
}

/// Refused in one line that names the process.
void check_refused_by(const Outcome& outcome, pid_t holder) {
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.err.find(": is being written to by process " + std::to_string(holder) + " on ") != std::string::npos);
  CHECK(outcome.err.find(" UTC; ") != std::string::npos);
  CHECK(outcome.err.find("choose another --out") != std::string::npos);
}

}  // namespace

TEST_CASE("a second run in a folder is refused at once, says who has it, and changes nothing") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  REQUIRE(impinge_run(folder.path(), run_words("alone", 200)).code == 0);
  RunningProgram first(folder.path(), run_words("two", 200));
  wait_for(folder / "two/stats.csv");
  wait_for_frame(folder / "two/stats.csv");
  first.signal(SIGSTOP);
  const auto before = listing(folder / "two");
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--resume"}})
    check_refused_by(impinge_run(folder.path(), run_words("two", 200, more)), first.pid());
  // not even the scene is read before: this one would be refused for it
  folder.write("broken.toml", "[[body]]\n");
  check_refused_by(impinge_run(folder.path(), {"run", "broken.toml", "--out", "two"}), first.pid());
  CHECK(listing(folder / "two") == before);
  // who only reads is not kept out
  CHECK(impinge_run(folder.path(), {"replay", "two"}).code == 0);
  first.signal(SIGCONT);
  CHECK(first.wait().code == 0);
  CHECK(contents(folder / "two") == contents(folder / "alone"));
  CHECK_FALSE(fs::exists(folder / "two/lock"));
}

TEST_CASE("two runs that are started into one folder at the same moment don't mix") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  REQUIRE(impinge_run(folder.path(), run_words("alone", 300)).code == 0);
  const auto alone = contents(folder / "alone");
  int refused = 0;
  for (int trial = 0; trial < 15; ++trial) {
    CAPTURE(trial);
    fs::remove_all(folder / "two");
    RunningProgram a(folder.path(), run_words("two", 300)), b(folder.path(), run_words("two", 300));
    const pid_t pid_a = a.pid(), pid_b = b.pid();
    const Outcome of_a = a.wait(), of_b = b.wait();
    CHECK((of_a.code == 0 || of_b.code == 0));  // where both are: one after the other
    if (of_a.code != 0) check_refused_by(of_a, pid_b);
    if (of_b.code != 0) check_refused_by(of_b, pid_a);
    refused += of_a.code != 0 || of_b.code != 0;
    CHECK(contents(folder / "two") == alone);
  }
  CHECK(refused > 0);
}

TEST_CASE("runs of one folder that are killed and started again, two at a time, end as one that was left alone") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const int frames = 600;
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(impinge_run(folder.path(), run_words("alone", frames)).code == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Random random(11);
  int killed = 0;
  for (int round = 0; round < 3; ++round) {
    fs::remove_all(folder / "two");
    for (int trial = 0; trial < 6; ++trial) {
      RunningProgram a(folder.path(), run_words("two", frames, {"--resume"})),
          b(folder.path(), run_words("two", frames, {"--resume"}));
      std::this_thread::sleep_for(std::chrono::duration<double>(random.in(0.05, 0.5) * seconds));
      (random.u() < 0.5 ? a : b).signal(SIGKILL);
      if (random.u() < 0.5) {
        a.signal(SIGKILL);
        b.signal(SIGKILL);
      }
      for (RunningProgram* each : {&a, &b}) {
        const Outcome outcome = each->wait();
        INFO(outcome.err);
        CHECK((outcome.code == 0 || outcome.code == 2 || outcome.code == -SIGKILL));
        killed += outcome.code == -SIGKILL;
        if (outcome.code == 2) CHECK(outcome.err.find("is being written to by") != std::string::npos);
      }
    }
    folder.write("two/stats.csv.1234-0.tmp", "half");  // what a kill within a file leaves
    folder.write("two/snapshots/000007.bin.1234-3.tmp", "half");
    REQUIRE(impinge_run(folder.path(), run_words("two", frames, {"--resume"})).code == 0);
    CHECK(contents(folder / "two") == contents(folder / "alone"));
  }
  CHECK(killed > 0);
}

TEST_CASE("a lock that no process holds any more keeps nobody out") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  RunningProgram first(folder.path(), run_words("out", 100000));
  wait_for(folder / "out/stats.csv");
  first.signal(SIGKILL);
  first.wait();
  CHECK(fs::exists(folder / "out/lock"));
  CHECK(impinge_run(folder.path(), run_words("out", 100000, {"--resume", "--freeze", "0"})).code ==
        2);  // of another cause
  fs::remove_all(folder / "out");
  // by name it is of a living process of this machine, of another machine, or of nobody
  for (const std::string text :
       {"process 1 on here since 2001-01-01 00:00:00 UTC\n", "process 77777 on elsewhere since never\n", ""}) {
    fs::remove_all(folder / "old");
    folder.write("old/lock", text);
    const Outcome outcome = impinge_run(folder.path(), run_words("old", 2));
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    CHECK_FALSE(fs::exists(folder / "old/lock"));
  }
  folder.write("mine/lock", "a file of my own\n");
  CHECK(impinge_run(folder.path(), run_words("mine", 2)).code == 2);
  CHECK(slurp(folder / "mine/lock") == "a file of my own\n");
}

TEST_CASE("the contact sheet belongs to the run that the folder is locked for") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const Outcome outcome =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "3", "--size", "64x36"});
  CHECK(outcome.code == 0);
  CHECK(fs::exists(folder / "out/contact_sheet.png"));
  CHECK_FALSE(fs::exists(folder / "out/lock"));
}

TEST_CASE("two suites of tests in one folder, and a test beside a run, are kept apart") {
  const TempFolder folder;
  folder.write("suite/a.toml", kCrateScene);
  folder.write("suite/a.script", "expect bodies == 2 at 100000\n");
  const std::vector<std::string> words = {"test", "suite", "--out", "out"};
  RunningProgram first(folder.path(), words);
  wait_for(folder / "out/a/run/stats.csv");
  check_refused_by(impinge_run(folder.path(), words), first.pid());
  first.signal(SIGKILL);
  first.wait();
  RunningProgram again(folder.path(),
                       {"run", "suite/a.toml", "--script", "suite/a.script", "--frames", "100000", "--no-images",
                        "--size", "320x180", "--out", "out/a/run", "--resume", "--quiet"});
  while (slurp(folder / "out/a/run/lock").find(std::to_string(again.pid())) == std::string::npos)
    std::this_thread::sleep_for(10ms);
  const Outcome beside = impinge_run(folder.path(), words);
  INFO(beside.out << beside.err);
  CHECK(beside.code == 1);
  CHECK(beside.out.find("is being written to by process " + std::to_string(again.pid())) != std::string::npos);
  CHECK(fs::exists(folder / "out/a/run/stats.csv"));
}
