// The jobs of a sweep by way of other schedulers: the same table and the same pixels as here.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <csignal>
#include <cstdlib>

#include "tests/support/program/slurm.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

// every file of the runs that time doesn't enter, by its path
std::map<std::string, std::string> kept_files(const fs::path& sweep) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(sweep / "jobs"))
    if (entry.path().extension() == ".png" || entry.path().extension() == ".ply" ||
        entry.path().filename() == "contacts.csv")
      all[fs::relative(entry.path(), sweep).string()] = slurp(entry.path());
  return all;
}

const std::vector<std::string> kVary = {"--vary",      "contact.friction=0,0.4",
                                        "--vary",      "simulation.substeps=1,2,4",
                                        "--reference", "simulation.substeps=8",
                                        "--frames",    "10",
                                        "--size",      "160x120"};

Outcome sweep(const TempFolder& folder, const std::string& out, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"sweep", "s.toml", "--out", out};
  words.insert(words.end(), kVary.begin(), kVary.end());
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

}  // namespace

TEST_CASE("a list of commands run by xargs is the sweep") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  REQUIRE(sweep(folder, "here", {}).code == 0);
  const std::string out = "a folder's \"name\" $HOME";
  const Outcome list = sweep(folder, out, {"--engine", "list", "--repeat", "2"});
  INFO(list.err);
  REQUIRE(list.code == 0);
  // 6 jobs, 2 references and their starts aside
  CHECK(std::count(list.out.begin(), list.out.end(), '\n') == 10);
  CHECK(!fs::exists(folder / out / "results.csv"));
  folder.write("commands", list.out);
  REQUIRE(std::system(
              fmt::format("cd / && tr '\\n' '\\0' < {}/commands | xargs -0 -P 2 -I C sh -c C", folder.path().string())
                  .c_str()) == 0);
  for (const auto& job : fs::directory_iterator(folder / out / "jobs")) {
    CHECK(fs::exists(job.path() / "done"));
    CHECK(fs::exists(job.path() / "repeats/2/done"));
  }
  const Outcome nothing = sweep(folder, out, {"--engine", "list", "--repeat", "2"});
  CHECK(nothing.code == 0);
  CHECK(nothing.out.empty());
  const auto before = listing(folder / out / "jobs");
  REQUIRE(sweep(folder, out, {"--resume", "--repeat", "2"}).code == 0);
  CHECK(listing(folder / out / "jobs") == before);  // collected, nothing run
  CHECK(sweep_results(folder / out) == sweep_results(folder / "here"));
  CHECK(kept_files(folder / out) == kept_files(folder / "here"));
}

TEST_CASE("a Slurm job array is the sweep") {
  SlurmCluster cluster;
  if (!cluster.trouble().empty() && cluster.trouble().find("not installed") != std::string::npos) {
    WARN("skipped: " << cluster.trouble());
    return;
  }
  INFO(cluster.trouble());
  REQUIRE(cluster.trouble().empty());
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  REQUIRE(sweep(folder, "here", {}).code == 0);
  const Outcome outcome = sweep(folder, "there", {"--engine", "slurm"});
  INFO(outcome.err << outcome.out);
  REQUIRE(outcome.code == 0);
  CHECK(sweep_results(folder / "there") == sweep_results(folder / "here"));
  const auto pictures = kept_files(folder / "there");
  CHECK(pictures.size() > 10 * 11);
  CHECK(pictures == kept_files(folder / "here"));
  CHECK(fs::exists(folder / "there/slurm/array.sh"));
  // it did run there: each task left its own output
  std::size_t tasks = 0;
  for (const auto& entry : fs::directory_iterator(folder / "there/slurm"))
    tasks += entry.path().filename().string().rfind("task-", 0) == 0 ? 1 : 0;
  CHECK(tasks == 10);

  // stopped in the middle the array is cancelled, and the same command goes on
  const std::vector<std::string> longer = {
      "sweep",    "s.toml",  "--out",       "long",     "--vary", "contact.friction=0,0.2,0.4",
      "--frames", "3000000", "--no-images", "--engine", "slurm"};
  const Outcome stopped = impinge_stopped(folder.path(), longer, 5.0, SIGINT);
  INFO(stopped.err);
  CHECK(stopped.code == 130);
  for (int i = 0; i < 100 && std::system("test -z \"$(squeue --noheader)\"") != 0; ++i) std::system("sleep 0.2");
  CHECK(std::system("test -z \"$(squeue --noheader)\"") == 0);
  for (const std::string& status : column(sweep_results(folder / "long"), "status")) CHECK(status == "open");
  for (const auto& job : fs::directory_iterator(folder / "long/jobs")) CHECK(!fs::exists(job.path() / "failed"));

  // what Slurm refuses is told in its words
  const Outcome refused = [&] {
    setenv("SBATCH_PARTITION", "nowhere", 1);
    const Outcome o = sweep(folder, "refused", {"--engine", "slurm"});
    unsetenv("SBATCH_PARTITION");
    return o;
  }();
  CHECK(refused.code == 2);
  CHECK(refused.error_lines() == 1);
  CHECK(refused.err.find("--engine slurm: sbatch refused the array") == 0);
  CHECK(refused.err.find("nvalid partition") != std::string::npos);
}

TEST_CASE("without Slurm the engine says what is missing") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const Outcome outcome = sweep(folder, "out", {"--engine", "slurm"});
  setenv("PATH", path.c_str(), 1);
  CHECK(outcome.code == 2);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.err.find("--engine slurm: sbatch can't be started") == 0);
}
