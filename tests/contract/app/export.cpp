// What other programs find in an export, read by them: VTK, meshio, and a strict reader of USD (tests/tools).
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <map>

#include <sys/wait.h>

#include <csignal>
#include <cstdlib>

#include "tests/support/program/export_scene.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kRead = {"ply", "obj", "vtu", "usda", "poses.csv", "poses.json"};

/// The reader's verdict: every line of it is "ok".
void check_read(const fs::path& run, const std::string& format, const fs::path& exported,
                const std::string& frames = "") {
  const TempFolder streams;
  const int status = std::system(
      fmt::format("/usr/bin/python3 {}/tests/tools/read_export.py '{}' {} '{}' {} > '{}' 2>&1", IMPINGE_SOURCE_DIR,
                  run.string(), format, exported.string(), frames, (streams / "out").string())
          .c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 77 || code == 127) {
    WARN("not read: this test needs python3-vtk9 and python3-meshio");
    return;
  }
  const std::string said = slurp(streams / "out");
  INFO(format << ":\n" << said);
  CHECK(code == 0);
  CHECK(said.find("FAILED") == std::string::npos);
  CHECK(said.find("ok ") != std::string::npos);
}

void export_all(const TempFolder& folder, const std::string& run, const std::vector<std::string>& more = {}) {
  for (const std::string& format : kRead) {
    std::vector<std::string> words = {"export", run, "--format", format};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(format << ": " << outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.empty());
  }
}

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = slurp(entry.path());
  return files;
}

}  // namespace

TEST_CASE("an export holds the run's positions, fields and times, by readers that are not ours") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene()).code == 0);
  export_all(folder, "out");
  for (const std::string& format : kRead) check_read(folder / "out", format, folder / "out/export");
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("of rigid bodies alone, masses and velocities in an export are the run's momentum") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(0.0, false)).code == 0);
  export_all(folder, "out");
  for (const std::string& format : kRead) check_read(folder / "out", format, folder / "out/export");
}

TEST_CASE("a scene far from the origin keeps its shape in single precision") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(3e4), {}, 3).code == 0);
  export_all(folder, "out");
  for (const std::string format : {"vtu", "usda"}) check_read(folder / "out", format, folder / "out/export");
}

TEST_CASE("an export of some frames has those alone, and what an earlier one left of its sequences is gone") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene()).code == 0);
  export_all(folder, "out", {"--out", "e"});
  folder.write("e/foreign.000003.ply", "stays");
  export_all(folder, "out", {"--out", "e", "--frames", "2:11:3"});
  CHECK(slurp(folder / "e/foreign.000003.ply") == "stays");
  fs::remove(folder / "e/foreign.000003.ply");
  for (const std::string& format : kRead) check_read(folder / "out", format, folder / "e", "2:11:3");
  // several at once are what each alone is
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "poses.json,poses.csv", "--out", "both"}).code == 0);
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "poses.csv", "--out", "one"}).code == 0);
  CHECK(slurp(folder / "both/poses.csv") == slurp(folder / "one/poses.csv"));
  CHECK(fs::exists(folder / "both/poses.json"));
}

TEST_CASE("what a run exports while it runs is what its folder gives afterwards, to the byte") {
  const TempFolder folder;
  const Outcome run = export_run(folder, export_scene(), {}, 12, "ply,sequence,obj,gltf,vtu,usda,poses.csv,poses.json");
  INFO(run.err);
  REQUIRE(run.code == 0);
  export_all(folder, "out", {"--out", "e"});
  REQUIRE(impinge_run(folder.path(), {"export", "out", "--format", "gltf", "--out", "e"}).code == 0);
  const auto during = contents(folder / "out/export"), after = contents(folder / "e");
  CHECK(during.size() > 100);
  for (const auto& [name, bytes] : after) {
    CAPTURE(name);
    REQUIRE(during.contains(name));
    CHECK(during.at(name) == bytes);
  }
  CHECK(during.size() == after.size());
}

TEST_CASE("frames without snapshots are made again for an export") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(), {"--snapshots", "0"}).code == 0);
  export_all(folder, "out", {"--frames", "3:9:2"});
  for (const std::string& format : kRead) check_read(folder / "out", format, folder / "out/export", "3:9:2");
}

TEST_CASE("a run that was cut off is exported as far as it came, and a resumed one whole") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene()).code == 0);
  folder.write("s.toml", export_scene());
  const std::vector<std::string> words = {
      "run",        "s.toml", "--out", "cut", "--frames", "4000", "--contacts", "--export", "ply,vtu,usda,poses.csv",
      "--no-images"};
  const auto has_frames = [&] { return fs::exists(folder / "cut/snapshots/000014.bin"); };
  {
    RunningProgram killed(folder.path(), words);
    while (!has_frames() && !killed.has_ended()) usleep(2000);
    killed.signal(SIGKILL);
    killed.wait();
  }
  CHECK_FALSE(fs::exists(folder / "cut/export/s.usda"));  // nothing half written
  export_all(folder, "cut", {"--out", "e", "--frames", "0:14"});
  for (const std::string& format : kRead) check_read(folder / "cut", format, folder / "e", "0:14");
  {
    std::vector<std::string> more = words;
    more.push_back("--resume");
    RunningProgram resumed(folder.path(), more);
    while (!fs::exists(folder / "cut/snapshots/000024.bin") && !resumed.has_ended()) usleep(2000);
    resumed.signal(SIGINT);
    CHECK(resumed.wait().code == 130);
  }
  const std::string stats = slurp(folder / "cut/stats.csv");
  const auto last = std::count(stats.begin(), stats.end(), '\n') - 2;
  REQUIRE(last >= 24);
  for (const std::string format : {"vtu", "usda", "poses.csv"})
    check_read(folder / "cut", format, folder / "cut/export", fmt::format("0:{}", last));
}

TEST_CASE("an export that cannot be is refused with nothing written") {
  const TempFolder folder;
  REQUIRE(export_run(folder, export_scene(), {}, 4).code == 0);
  folder.write("file", "");
  folder.write("empty/x", "");
  const auto refused = [&](const std::vector<std::string>& words, const std::string& start, const std::string& holds) {
    CAPTURE(words.back());
    check_refused(folder, words, start, holds);
  };
  refused({"export", "out"}, "command line: ", "--format");
  refused({"export", "out", "--format", "vtk"}, "command line: --format is 'vtk'", "did you mean 'vtu'?");
  refused({"export", "empty", "--format", "vtu"}, "empty: ", "holds no run.toml");
  refused({"export", "out", "--format", "vtu", "--out", "file"}, "file: is a file", "a folder is wanted");
  refused({"export", "out", "--format", "vtu", "--frames", "2:9"}, "command line: --frames is '2:9'", "frames 0 to 4");
  for (const char* frames : {"3:1", "x", "1:2:0", "1:2:3:4", "-1", "1.5", ":"})
    if (std::string(frames) != ":")
      refused({"export", "out", "--format", "vtu", fmt::format("--frames={}", frames)}, "command line: --frames is",
              "");
  refused({"run", "s.toml", "--out", "new", "--export", "vtu,stl"}, "command line: --export is 'stl'", "poses.csv");
}

TEST_CASE("morph targets beyond their bound are refused before anything is simulated, with what would fit") {
  const TempFolder folder;
  folder.write("s.toml", R"([[body]]
name = "jelly"
kind = "deformable"
shape = { sphere = { radius = 0.2 } }
volume = { cage = { cells = 3 } }
)");
  // 2562 vertices at most: 30 kB a frame
  check_refused(folder, {"run", "s.toml", "--out", "out", "--frames", "5000", "--export", "gltf"},
                "command line: --export gltf of 5001 frames: ", "--frames 0:5000:");
}
