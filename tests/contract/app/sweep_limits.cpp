// Sweeps where the machine says no, and where somebody kills them again and again.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <random>

#include "tests/support/program/small_disk.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> pictures(const fs::path& sweep) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(sweep / "jobs"))
    if (entry.path().extension() == ".png") all[fs::relative(entry.path(), sweep).string()] = slurp(entry.path());
  return all;
}

}  // namespace

TEST_CASE("a sweep onto a full disk says so once, and goes on when there is room") {
  const SweepFiles files;
  const std::vector<std::string> words = {"--vary", "contact.friction=0:1:4", "--frames", "60"};
  REQUIRE(files.run("whole", words).code == 0);
  const SmallDisk disk(files.folder / "disk", "160k");
  if (!disk.is_mounted()) {
    WARN("skipped: no small file system can be mounted here (it takes root)");
    return;
  }
  const Outcome full = files.run("disk/out", words);
  INFO(full.err);
  CHECK(full.code == 2);
  CHECK(full.error_lines() == 1);
  CHECK(full.err.find("No space left on device") != std::string::npos);
  CHECK(full.err.find("free space") != std::string::npos);
  REQUIRE(disk.resize("64m"));
  const Outcome again = files.run("disk/out", words);
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(sweep_results(files.folder / "disk/out") == sweep_results(files.folder / "whole"));
}

TEST_CASE("200 jobs killed ten times go on to the same table and the same pictures", "[long]") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const auto words = [](const std::string& out) {
    return std::vector<std::string>{"sweep",    "s.toml",
                                    "--out",    out,
                                    "--size",   "96x64",
                                    "--jobs",   "2",
                                    "--frames", "8",
                                    "--vary",   "contact.friction=0:1:20",
                                    "--vary",   "simulation.substeps=1:10:10"};
  };
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(impinge_run(folder.path(), words("whole")).code == 0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::mt19937 random(5);
  int killed = 0;
  for (int i = 0; i < 10; ++i) {
    const double moment = std::uniform_real_distribution<>(0.02, 0.15)(random) * seconds;
    killed += impinge_stopped(folder.path(), words("parts"), moment, SIGKILL,
                              i % 2 == 0 ? Targets::program : Targets::children_first)
                          .code == -SIGKILL
                  ? 1
                  : 0;
  }
  CHECK(killed >= 5);
  std::vector<std::string> last = words("parts");
  last.push_back("--resume");
  REQUIRE(impinge_run(folder.path(), last).code == 0);
  const std::vector<Row> rows = sweep_results(folder / "whole");
  CHECK(rows.size() == 200);
  CHECK(sweep_results(folder / "parts") == rows);
  CHECK(pictures(folder / "whole").size() >= 200 * 9);
  CHECK(pictures(folder / "parts") == pictures(folder / "whole"));
}
