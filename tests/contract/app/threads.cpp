// --threads N: so many threads run, those of the libraries included, and the states are the same.
#include <catch2/catch.hpp>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// Two cubes fall on a floor and each other: systems of some thousand unknowns, factorized for their contacts.
constexpr const char* kCubes = R"([simulation]
substeps = 2
linear_solver = "cholmod"
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "lower"
kind = "deformable"
shape = { box = { size = [0.2, 0.2, 0.2] } }
volume = { lattice = { cells = 9 } }
material = { young = 1e5, poisson = 0.3, density = 1000 }
position = [0, 0.1, 0]
[[body]]
name = "upper"
kind = "deformable"
shape = { box = { size = [0.15, 0.15, 0.15] } }
volume = { lattice = { cells = 7 } }
material = { young = 1e5, poisson = 0.3, density = 1000 }
position = [0.01, 0.276, 0.01]
)";

struct Threads {
  std::size_t most = 0;     // that there were at a time
  std::size_t running = 0;  // that used the processor
  std::string hashes;       // stats.csv's last column but two, of all frames
};

/// Clock ticks that a thread has run.
long ticks_of(const fs::path& task) {
  std::ifstream file(task / "stat");
  std::string line;
  std::getline(file, line);
  std::istringstream words(line.substr(std::min(line.rfind(')') + 2, line.size())));
  std::string word;
  long ticks = 0;
  for (int k = 3; words >> word && k <= 15; ++k)
    if (k >= 14) ticks += std::stol(word);
  return ticks;
}

Threads threads_of(const TempFolder& folder, const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"run", "s.toml", "--frames", "4", "--out", out};
  words.insert(words.end(), more.begin(), more.end());
  std::map<std::string, long> ticks;
  std::map<std::string, std::string> names;
  std::set<std::set<std::string>> seen;  // threads that there were at a time
  Threads threads;
  const Outcome outcome = impinge_watched(folder.path(), words, [&](pid_t pid) {
    std::error_code error;
    std::set<std::string> now;
    for (fs::directory_iterator task("/proc/" + std::to_string(pid) + "/task", error), end; !error && task != end;
         task.increment(error)) {
      const std::string number = task->path().filename();
      std::ifstream comm(task->path() / "comm");
      std::getline(comm, names[number]);
      ticks[number] = ticks_of(task->path());
      now.insert(number);
    }
    seen.insert(now);
  });
  // one sleeps until there is a signal
  const auto is_ours = [&](const std::string& number) { return names[number] != "signals"; };
  for (const auto& now : seen)
    threads.most = std::max<std::size_t>(threads.most, std::count_if(now.begin(), now.end(), is_ours));
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  for (const auto& [task, used] : ticks) threads.running += used > 0 && is_ours(task);
  std::istringstream text(slurp(folder / (out + "/stats.csv")));
  std::ptrdiff_t column = -1;  // of the hash
  for (std::string line; std::getline(text, line);) {
    if (column < 0) column = std::count(line.begin(), line.begin() + line.find(",state_hash"), ',');
    for (auto k = column; k > 0; --k) line.erase(0, line.find(',') + 1);
    line.erase(0, line.find(','));
    threads.hashes += line.substr(0, line.find(',', 1)) + '\n';
  }
  return threads;
}

}  // namespace

TEST_CASE("as many threads run as --threads says, those of the libraries included, and the states are the same") {
  TempFolder folder;
  folder.write("s.toml", kCubes);
  const Threads one = threads_of(folder, "one", {"--no-images", "--threads", "1"});
  CHECK(one.most == 1);
  CHECK(one.running == 1);
  const Threads two = threads_of(folder, "two", {"--no-images", "--threads", "2"});
  CHECK(two.most <= 2);
  const Threads drawn = threads_of(folder, "drawn", {"--size", "320x180", "--threads", "1"});
  CHECK(drawn.running == 1);
  CHECK(two.hashes == one.hashes);
  CHECK(drawn.hashes == one.hashes);
  CHECK(one.hashes.find(",state_hash\n") == 0);
}
