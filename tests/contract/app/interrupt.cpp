// Ctrl-C and SIGTERM while a frame takes minutes: answered at once, obeyed soon, and nothing that was finished is lost.
#include <sys/resource.h>

#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "tests/support/pictures/picture_scene.hpp"
#include "tests/support/program/slow_scenes.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double kSoon = 10.0;  // s; 2 are promised, on a machine that is not busy with other things
constexpr const char* kAnswer = "interrupted: ";

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void wait_until(RunningProgram& program, const std::function<bool()>& reached) {
  const auto start = Clock::now();
  while (!reached() && !program.has_ended() && seconds_since(start) < 120) std::this_thread::sleep_for(2ms);
  INFO(program.err());
  REQUIRE(reached());
}

std::size_t rows(const fs::path& stats) {
  const std::string text = slurp(stats);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, std::count(text.begin(), text.end(), '\n')) - 1);
}

struct Stopped {
  Outcome outcome;
  double seconds = 0.0;  ///< from the signal to the end
};

/// The program gets the signal and has to answer and to end.
Stopped stopped(RunningProgram& program, int signal) {
  const auto start = Clock::now();
  program.signal(signal);
  while (!program.has_ended() && seconds_since(start) < 2.0 * kSoon) std::this_thread::sleep_for(1ms);
  if (!program.has_ended()) program.signal(SIGKILL);
  Stopped result{program.wait(), seconds_since(start)};
  INFO(result.outcome.err);
  CHECK(result.outcome.code == 130);
  CHECK(result.outcome.err.starts_with(kAnswer));
  CHECK(result.outcome.err.find("; a second one ends at once\n") != std::string::npos);
  CHECK(result.outcome.err.find("bug of impinge") == std::string::npos);
  CHECK(result.seconds < kSoon);
  return result;
}

/// Ended from outside, since it stood in a long stage of a library.
bool is_forced(const Outcome& outcome) {
  return outcome.err.find("ended in the middle of a long stage") != std::string::npos;
}

std::vector<std::string> run_words(const std::string& scene, const std::string& out, int frames) {
  return {"run",     scene + ".toml", "--out",     out, "--frames", std::to_string(frames),
          "--quiet", "--no-images",   "--threads", "2", "--resume", "--contacts"};
}

/// What a run leaves, but for times.
std::string states(const fs::path& folder) {
  std::string text = slurp(folder / "contacts.csv");
  for (const Row& row : csv_rows(folder / "stats.csv"))
    for (const auto& [column, cell] : row)
      if (!column.ends_with("_ms")) text += column + "=" + cell + ",";
  return text;
}

/// A folder as of a run that has come to frame 1, without the minutes that frame takes: its second row is made up.
void fake_run(const TempFolder& folder, const std::string& out, char hash) {
  RunningProgram program(folder.path(), {"run", "slow.toml", "--out", out, "--frames", "3", "--no-images", "--quiet"});
  wait_until(program, [&] { return rows(folder / (out + "/stats.csv")) == 1; });
  program.signal(SIGKILL);
  program.wait();
  std::string text = slurp(folder / (out + "/stats.csv"));
  const std::size_t end = text.find('\n');
  std::string row = text.substr(end + 1);
  row[0] = '1';
  const std::size_t at = row.find(csv_rows(folder / (out + "/stats.csv"))[0].at("state_hash"));
  row.replace(at, 16, std::string(16, hash));
  folder.write(out + "/stats.csv", text + row);
}

}  // namespace

TEST_CASE("a run ends soon after a signal wherever in a long frame it is, and keeps the frames before") {
  const TempFolder folder;
  folder.write("boxes.toml", overlapping_boxes(200));
  folder.write("self.toml", self_contact(24));
  folder.write("soft.toml", soft_block(30));
  Random random(5);
  for (const std::string scene : {"boxes", "self", "soft"})
    for (const int signal : {SIGINT, SIGTERM}) {
      CAPTURE(scene, signal);
      const std::string out = scene + std::to_string(signal);
      RunningProgram program(folder.path(), run_words(scene, out, 2));
      wait_until(program, [&] { return rows(folder / (out + "/stats.csv")) == 1; });
      std::this_thread::sleep_for(std::chrono::duration<double>(random.in(0.0, 2.0)));
      const Outcome outcome = stopped(program, signal).outcome;
      CHECK(outcome.out.empty());
      CHECK(rows(folder / (out + "/stats.csv")) == 1);
      CHECK_FALSE(fs::exists(folder / (out + "/done")));
      if (!is_forced(outcome))
        CHECK(outcome.err.find("interrupted after frame 0; the same command with --resume goes on\n") !=
              std::string::npos);
    }
}

TEST_CASE("a run that is interrupted within its frames goes on to the same bits") {
  const TempFolder folder;
  folder.write("boxes.toml", overlapping_boxes(16));
  folder.write("self.toml", self_contact(8));
  folder.write("soft.toml", soft_block(8));
  Random random(9);
  for (const std::string scene : {"boxes", "self", "soft"}) {
    CAPTURE(scene);
    const auto start = Clock::now();
    REQUIRE(impinge_run(folder.path(), run_words(scene, scene + "-whole", 6)).code == 0);
    double seconds = seconds_since(start);
    int interrupted = 0, code = -1;
    for (int trial = 0; trial < 40 && (code != 0 || interrupted == 0); ++trial) {
      if (code == 0) {  // at its end before the signal, on a machine that has become quicker: once more, and sooner
        fs::remove_all(folder / (scene + "-parts"));
        seconds *= 0.5;
      }
      const double wait = trial < 8 ? random.in(0.1, 0.5) * seconds : 1e3;
      const Outcome outcome = impinge_stopped(folder.path(), run_words(scene, scene + "-parts", 6), wait, SIGTERM);
      INFO(outcome.err);
      code = outcome.code;
      REQUIRE((code == 0 || code == 130 || code == -SIGTERM));  // before main() a signal ends it as any program
      interrupted += code == 130;
    }
    CHECK(code == 0);
    CHECK(interrupted > 0);
    CHECK(states(folder / (scene + "-parts")) == states(folder / (scene + "-whole")));
  }
}

TEST_CASE("a second signal ends the program at once") {
  const TempFolder folder;
  folder.write("soft.toml", soft_block(30));
  RunningProgram program(folder.path(), run_words("soft", "out", 2));
  wait_until(program, [&] { return rows(folder / "out/stats.csv") == 1; });
  program.signal(SIGSTOP);
  program.signal(SIGTERM);
  program.signal(SIGINT);
  program.signal(SIGCONT);
  const Outcome outcome = program.wait();
  INFO(outcome.err);
  CHECK(outcome.code == 130);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') <= 1);
}

TEST_CASE("every command that computes ends soon after a signal") {
  const TempFolder folder;
  folder.write("slow.toml", overlapping_boxes(200));
  folder.write("suite/slow.toml", overlapping_boxes(200));
  folder.write("suite/slow.script", "expect contacts > 0 at 3\n");
  folder.write("step.script", "step 3\n");
  folder.write("play.script", "play\nui wait 5\n");
  fake_run(folder, "a", '1');
  fake_run(folder, "b", '2');
  const std::vector<std::vector<std::string>> all = {
      {"replay", "a"},
      {"compare", "a", "b", "--out", "apart"},
      {"why", "slow.toml", "--pair", "b0", "b1"},
      {"debug", "slow.toml", "--headless", "--script", "step.script", "--record", "r.script"},
      {"debug", "slow.toml", "--headless", "--script", "play.script"},
      {"test", "suite", "--out", "tested", "--junit", "junit.xml"},
      {"test", "suite", "--jobs", "2", "--out", "tested_beside", "--junit", "junit.xml"},
      {"info", "slow.toml", "--ablation", "--frames", "2", "--out", "ablation"},
      {"sweep", "slow.toml", "--vary", "contact.friction=0.1,0.2", "--frames", "2", "--no-images", "--out", "sweep"}};
  Random random(2);
  for (const std::vector<std::string>& words : all) {
    CAPTURE(words[0], words[1]);
    RunningProgram program(folder.path(), words);
    std::this_thread::sleep_for(std::chrono::duration<double>(random.in(3.0, 5.0)));
    CHECK_FALSE(program.has_ended());
    const Outcome outcome = stopped(program, words[0] == "debug" ? SIGINT : SIGTERM).outcome;
    if (is_forced(outcome)) continue;
    const auto out = std::find(words.begin(), words.end(), "--out");
    if (words[0] == "compare" || words[0] == "info") CHECK_FALSE(fs::exists(folder / *std::next(out)));
    if (words[0] == "test") {
      const std::string xml = slurp(folder / "junit.xml");
      CHECK(xml.find("errors=\"1\"") != std::string::npos);
      CHECK(xml.find("interrupted; the tests after this one were not run") != std::string::npos);
    }
    if (const std::string record = slurp(folder / "r.script"); words.back() == "r.script") {
      INFO(record);
      CHECK(record.ends_with("\nseek 0\n"));
    }
  }
  for (const fs::directory_entry& job : fs::directory_iterator(folder / "sweep/jobs")) {
    CHECK_FALSE(fs::exists(job.path() / "done"));
    CHECK(rows(job.path() / "run/stats.csv") <= 1);
  }
}

TEST_CASE("a comparison of the methods of a frozen step ends soon after a signal") {
  const TempFolder folder;
  folder.write("s.toml", overlapping_boxes(24));
  const Outcome frozen = impinge_run(
      folder.path(), {"run", "s.toml", "--out", "out", "--frames", "1", "--freeze", "1", "--no-images", "--quiet"});
  INFO(frozen.err);
  REQUIRE(frozen.code == 0);
  RunningProgram program(folder.path(), {"step", "out/frozen/000001.step", "--tolerance", "1e-15", "--max-iterations",
                                         "10000000", "--out", "methods"});
  std::this_thread::sleep_for(2s);
  stopped(program, SIGTERM);
  CHECK_FALSE(fs::exists(folder / "methods"));
}

TEST_CASE("a program that was started for a scene or a film ends with the one that started it") {
  const TempFolder folder;
  const fs::path slow = folder.write("bin/ffmpeg", "#!/bin/sh\necho $$ > \"$PID_FILE\"\nexec sleep 600\n");
  fs::permissions(slow, fs::perms::owner_all);
  setenv("PID_FILE", (folder / "pid").c_str(), 1);
  const auto ended = [&] { return kill(std::stoi(slurp(folder / "pid")), 0) != 0; };
  const auto is_written = [&] { return slurp(folder / "pid").find('\n') != std::string::npos; };

  folder.write("t.toml", R"([[body]]
name = "ball"
kind = "deformable"
shape = { sphere = { radius = 0.5 } }
volume = { tetrahedralize = { max_size = 0.2 } }
material = { young = 1e5, poisson = 0.4, density = 1000 }
)");
  setenv("IMPINGE_TETRAHEDRALIZE", slow.c_str(), 1);
  setenv("IMPINGE_CACHE", "off", 1);
  {
    RunningProgram program(folder.path(), {"check", "t.toml"});
    wait_until(program, is_written);
    stopped(program, SIGTERM);
    CHECK(ended());
  }
  unsetenv("IMPINGE_TETRAHEDRALIZE");
  unsetenv("IMPINGE_CACHE");

  folder.write("s.toml", kCrateScene);
  fs::remove(folder / "pid");
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((folder / "bin").string() + ":" + path).c_str(), 1);
  {
    RunningProgram program(folder.path(), {"run", "s.toml", "--out", "film", "--frames", "3", "--size", "64x36",
                                           "--quiet", "--video", "film/x.mp4"});
    wait_until(program, is_written);
    stopped(program, SIGINT);
    CHECK(ended());
  }
  setenv("PATH", path.c_str(), 1);
  unsetenv("PID_FILE");
  CHECK(fs::exists(folder / "film/done"));  // the run is whole, and the same command with --resume makes the film
  for (const std::string& name : listing(folder / "film")) CHECK(name.find(".tmp") == std::string::npos);
}

TEST_CASE("a hundred signals at random moments of long frames: none takes long, and the runs go on to the same bits",
          "[long]") {
  const TempFolder folder;
  folder.write("boxes.toml", overlapping_boxes(200));
  folder.write("self.toml", self_contact(24));
  folder.write("soft.toml", soft_block(30));
  Random random(static_cast<std::uint64_t>(Clock::now().time_since_epoch().count()));
  for (const std::string scene : {"boxes", "self", "soft"}) {
    double longest = 0.0, sum = 0.0;
    int forced = 0;
    constexpr int kTrials = 34;
    for (int trial = 0; trial < kTrials; ++trial) {
      RunningProgram program(folder.path(), run_words(scene, scene, 2));
      wait_until(program, [&] { return rows(folder / (scene + "/stats.csv")) >= 1; });
      std::this_thread::sleep_for(std::chrono::duration<double>(random.in(0.0, 12.0)));
      if (program.has_ended()) break;
      const Stopped end = stopped(program, trial % 2 == 0 ? SIGTERM : SIGINT);
      forced += is_forced(end.outcome);
      longest = std::max(longest, end.seconds);
      sum += end.seconds;
    }
    WARN(scene << ": " << kTrials << " signals, longest " << longest << " s, mean " << sum / kTrials << " s, " << forced
               << " in a long stage of a library");
    CHECK(longest < kSoon);
  }
}
