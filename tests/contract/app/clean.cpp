// Runs into folders that are there already (--force, --number), and what impinge clean frees.
#include <algorithm>
#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <sstream>

#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene =
    "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n"
    "[[body]]\nname = \"ball\"\nkind = \"dynamic\"\nshape = { sphere = { radius = 0.5 } }\nmass = 1\nposition = [0, 2, "
    "0]\n";

struct Files {
  TempFolder folder;
  Files() { folder.write("s.toml", kScene); }
  Outcome run(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"run", "s.toml", "--out", out, "--size", "64x48"};
    if (std::find(more.begin(), more.end(), "--frames") == more.end()) words.insert(words.end(), {"--frames", "6"});
    words.insert(words.end(), more.begin(), more.end());
    return impinge_run(folder.path(), words);
  }
};

/// Every file below a folder with its bytes; links by where they lead.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_symlink())
      all[name] = "-> " + fs::read_symlink(entry.path()).string();
    else if (entry.is_regular_file())
      all[name] = slurp(entry.path());
  }
  return all;
}

/// stats.csv changes from run to run in its times; what else there is has to be the same.
std::map<std::string, std::string> timeless(std::map<std::string, std::string> files) {
  files.erase("stats.csv");
  return files;
}

/// Names of files that only one has, or that hold something else.
std::string differing(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  std::string names;
  for (const auto& [name, bytes] : a)
    if (const auto it = b.find(name); it == b.end() || it->second != bytes) names += name + " ";
  for (const auto& [name, bytes] : b)
    if (!a.contains(name)) names += name + " ";
  return names;
}

}  // namespace

TEST_CASE("run --force replaces another run and leaves what no run wrote") {
  const Files files;
  const auto dir = files.folder / "out";
  REQUIRE(files.run("fresh", {"--set", "contact.friction=0.1"}).code == 0);
  REQUIRE(files.run("out", {"--contacts", "--ids", "--export", "ply", "--frames", "9", "--freeze", "9"}).code == 0);
  files.folder.write("out/notes.txt", "mine");
  files.folder.write("out/frames/mine.png", "mine");
  files.folder.write("out/surfaces/mine/000001.ply", "mine");
  files.folder.write("elsewhere/000001.bin", "mine");
  fs::create_directory_symlink(files.folder / "elsewhere", dir / "linked");
  const Outcome refused = files.run("out", {"--set", "contact.friction=0.1"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("--force") != std::string::npos);
  const Outcome forced = files.run("out", {"--set", "contact.friction=0.1", "--force"});
  CAPTURE(forced.err);
  REQUIRE(forced.code == 0);
  std::map<std::string, std::string> now = contents(dir);
  for (const char* mine : {"notes.txt", "frames/mine.png", "surfaces/mine/000001.ply"}) {
    CAPTURE(mine);
    CHECK(now[mine] == "mine");
    now.erase(mine);
  }
  CHECK(now.erase("linked") == 1);
  CHECK(slurp(files.folder / "elsewhere/000001.bin") == "mine");
  CHECK(timeless(now) == timeless(contents(files.folder / "fresh")));  // nothing of the first run is left
}

TEST_CASE("run --force takes no folder that is none of a run") {
  const Files files;
  files.folder.write("foreign/a.txt", "mine");
  files.folder.write("false/run.toml", "[other]\n");
  files.folder.write("broken/run.toml", "[run\n");
  for (const char* name : {"foreign", "false", "broken"}) {
    CAPTURE(name);
    const auto before = contents(files.folder / name);
    const Outcome outcome = files.run(name, {"--force"});
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
    CHECK(contents(files.folder / name) == before);
  }
  check_refused(files.folder, {"run", "s.toml", "--force", "--resume"}, "command line: --resume and --force",
                "leave out one");
  check_refused(files.folder, {"run", "s.toml", "--force", "--number"}, "command line: --force and --number",
                "leave out one");
  // a scene that is wrong costs nobody the old run
  REQUIRE(files.run("out").code == 0);
  const auto before = contents(files.folder / "out");
  CHECK(files.run("out", {"--force", "--set", "contact.friction=-1"}).code == 2);
  CHECK(contents(files.folder / "out") == before);
}

TEST_CASE("run --force, killed at any moment, leaves a run that did not end, and the same command mends it") {
  const Files files;
  const std::vector<std::string> changed = {
      "run", "s.toml", "--out", "out", "--frames", "30", "--size", "64x48", "--force", "--set", "contact.friction=0.1"};
  const auto begun = std::chrono::steady_clock::now();
  REQUIRE(files.run("fresh", {"--frames", "30", "--set", "contact.friction=0.1"}).code == 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  const auto wanted = timeless(contents(files.folder / "fresh"));
  int cut_off = 0;
  for (const double share : {0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 1.0}) {
    const double seconds = share * whole;
    CAPTURE(seconds, whole);
    REQUIRE(files.run("out", {"--frames", "40", "--force"}).code == 0);
    const Outcome killed = impinge_stopped(files.folder.path(), changed, seconds, SIGKILL);
    const bool is_old = slurp(files.folder / "out/run.toml").find("frames = 40") != std::string::npos;
    if (fs::exists(files.folder / "out/done")) {  // then it is a whole run, the old one or the new one
      CHECK(impinge_run(files.folder.path(), {"replay", "out"}).code == 0);
      auto whole_run = timeless(contents(files.folder / "out")), promised = wanted;
      for (auto* of : {&whole_run, &promised}) of->erase("lock");  // which who was killed could not take away
      if (!is_old) CHECK(differing(whole_run, promised) == "");
    } else {
      CHECK(killed.code != 0);
      ++cut_off;
    }
    REQUIRE(impinge_run(files.folder.path(), changed).code == 0);
    CHECK(differing(timeless(contents(files.folder / "out")), wanted) == "");
  }
  CHECK(cut_off > 0);
}

TEST_CASE("run --number takes the next folder that is free") {
  const Files files;
  for (const char* name : {"a/out", "a/out-2", "a/out-3"}) {
    const Outcome outcome = files.run("a/out", {"--number"});
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(fs::exists(files.folder / name / "done"));
    CHECK(outcome.out.find(std::string(name) + "/stats.csv") != std::string::npos);
  }
  fs::remove_all(files.folder / "a/out-2");
  REQUIRE(files.run("a/out/", {"--number"}).code == 0);
  CHECK(fs::exists(files.folder / "a/out-2/done"));
  // at once: each its own
  std::vector<std::unique_ptr<RunningProgram>> running;
  for (int i = 0; i < 4; ++i)
    running.push_back(std::make_unique<RunningProgram>(
        files.folder.path(),
        std::vector<std::string>{"run", "s.toml", "--out", "b", "--frames", "5", "--no-images", "--number"}));
  for (const auto& program : running) CHECK(program->wait().code == 0);
  for (const char* name : {"b", "b-2", "b-3", "b-4"}) CHECK(fs::exists(files.folder / name / "done"));
  // what can't run leaves no folder
  CHECK(files.run("c", {"--number", "--set", "contact.friction=-1"}).code == 2);
  CHECK_FALSE(fs::exists(files.folder / "c"));
}

TEST_CASE("clean tells what takes room, frees what is asked for, and a run makes it again") {
  const Files files;
  const auto dir = files.folder / "out";
  REQUIRE(files.run("out", {"--contacts", "--ids", "--export", "ply"}).code == 0);
  const auto whole = contents(dir);
  files.folder.write("out/notes.txt", std::string(1234, 'x'));
  files.folder.write("out/snapshots/mine.bin", "mine");
  files.folder.write("out/export/mine.blend", "mine");
  files.folder.write("out/export/s.000000.ply", "exported");
  files.folder.write("elsewhere/000000.png", "mine");
  fs::create_directory_symlink(files.folder / "elsewhere", dir / "linked");
  fs::create_symlink(files.folder / "elsewhere/000000.png", dir / "frames/000099.png");

  const auto before = contents(dir);
  const Outcome told = impinge_run(files.folder.path(), {"clean", "out"});
  CAPTURE(told.out);
  REQUIRE(told.code == 0);
  CHECK(contents(dir) == before);
  double pictures = 0.0;
  for (const auto& [name, bytes] : whole)
    if (name.starts_with("frames/") || name.starts_with("ids/") || name == "contact_sheet.png")
      pictures += static_cast<double>(bytes.size());
  const std::size_t at = told.out.find("pictures");
  REQUIRE(at != std::string::npos);
  CHECK(std::stod(told.out.substr(at + 8)) == Approx(pictures / 1024.0).epsilon(0.01));  // KiB
  CHECK(told.out.find("15 files") != std::string::npos);                                 // 7 frames, 7 ids, the sheet

  REQUIRE(impinge_run(files.folder.path(), {"clean", "out", "--snapshots", "--exports"}).code == 0);
  auto after = contents(dir);
  for (const auto& [name, bytes] : before) {
    CAPTURE(name);
    const bool goes =
        (name.starts_with("snapshots/0") || name.starts_with("surfaces/") || name == "export/s.000000.ply");
    CHECK(after.contains(name) != goes);
  }
  REQUIRE(impinge_run(files.folder.path(), {"clean", "out", "--all"}).code == 0);
  after = contents(dir);
  for (const char* name : {"notes.txt", "snapshots/mine.bin", "export/mine.blend", "linked", "frames/000099.png",
                           "run.toml", "stats.csv", "contacts.csv", "done"}) {
    CAPTURE(name);
    CHECK(after[name] == before.at(name));
  }
  CHECK(slurp(files.folder / "elsewhere/000000.png") == "mine");
  CHECK(impinge_run(files.folder.path(), {"replay", "out"}).code == 0);

  // the line that it prints makes all of it again
  const std::size_t line = told.out.find("again:   impinge ");
  REQUIRE(line != std::string::npos);
  std::istringstream rest(told.out.substr(line + 17, told.out.find('\n', line) - line - 17));
  std::vector<std::string> words;
  for (std::string word; rest >> word;) words.push_back(word);
  const Outcome again = impinge_run(files.folder.path(), words);
  CAPTURE(again.err);
  REQUIRE(again.code == 0);
  const auto made = contents(dir);
  for (const auto& [name, bytes] : whole) {
    CAPTURE(name);
    REQUIRE(made.contains(name));
    if (name != "stats.csv") CHECK(made.at(name) == bytes);
  }
}

TEST_CASE("clean sees the runs below a folder, and none that is being written") {
  const Files files;
  for (const char* name : {"all/a", "all/deep/b"}) REQUIRE(files.run(name).code == 0);
  files.folder.write("all/readme.txt", "mine");
  const Outcome told = impinge_run(files.folder.path(), {"clean", "all"});
  CHECK(told.out.find("2 runs") != std::string::npos);
  {
    files.folder.write("slow.toml", "[simulation]\nframe_time = 0.1\nsubsteps = 1000\n" + std::string(kScene));
    RunningProgram busy(files.folder.path(),
                        {"run", "slow.toml", "--out", "all/busy", "--frames", "100000", "--no-images"});
    for (int i = 0; i < 2000 && !fs::exists(files.folder / "all/busy/stats.csv"); ++i) usleep(5000);
    const auto before = contents(files.folder / "all/a");
    const Outcome refused = impinge_run(files.folder.path(), {"clean", "all", "--all"});
    CHECK(refused.code == 2);
    CHECK(refused.err.find("all/busy: is being written to") != std::string::npos);
    CHECK(contents(files.folder / "all/a") == before);
  }
  REQUIRE(impinge_run(files.folder.path(), {"clean", "all", "--pictures"}).code == 0);
  CHECK_FALSE(fs::exists(files.folder / "all/deep/b/frames"));
  CHECK(fs::exists(files.folder / "all/deep/b/snapshots"));
  CHECK(slurp(files.folder / "all/readme.txt") == "mine");
  check_refused(files.folder, {"clean", "nowhere"}, "nowhere: there is no such folder", "check the path");
  files.folder.write("empty/readme.txt", "mine");
  check_refused(files.folder, {"clean", "empty", "--all"}, "empty: holds no run", "check the path");
}

TEST_CASE("what clean takes of a sweep the same sweep makes again, with the same table") {
  const SweepFiles files;
  const std::vector<std::string> words = {"sweep",       "s.toml",
                                          "--out",       "out",
                                          "--size",      "64x48",
                                          "--frames",    "12",
                                          "--vary",      "contact.friction=0.1,0.5",
                                          "--reference", "simulation.substeps=16",
                                          "--repeat",    "2"};
  const auto again = [&](const std::vector<std::string>& line) {
    const Outcome outcome = impinge_run(files.folder.path(), line);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome;
  };
  const auto pictures_and_surfaces = [&] {
    std::map<std::string, std::string> all = contents(files.folder / "out");
    std::erase_if(all, [](const auto& file) {
      return file.first.find("/frames/0") == std::string::npos && file.first.find("/surfaces/0") == std::string::npos;
    });
    return all;
  };
  again(words);
  const std::vector<Row> table = sweep_results(files.folder / "out");
  const auto made = pictures_and_surfaces();
  REQUIRE(made.size() > 6 * 13);  // two jobs, their references and the runs aside: a picture and a surface a frame
  for (const Row& row : table) CHECK(std::stod(row.at("error_rms_m")) > 0.0);
  // what is whole is not run again
  const std::string done = slurp(files.job("out", table[0]) / "done");
  again(words);
  CHECK(slurp(files.job("out", table[0]) / "done") == done);

  for (const char* what : {"--exports", "--pictures", "--snapshots", "--all"}) {
    CAPTURE(what);
    const Outcome cleaned = again({"clean", "out", what});
    CHECK(differing(pictures_and_surfaces(), made).empty() == (std::string(what) == "--snapshots"));
    // the line that it prints is the sweep's
    const std::size_t line = cleaned.out.find("again:   impinge ");
    REQUIRE(line != std::string::npos);
    std::istringstream rest(cleaned.out.substr(line + 17));
    std::vector<std::string> printed;
    for (std::string word; rest >> word;) printed.push_back(word);
    const bool all = std::string(what) == "--all";
    const Outcome listed = again({"sweep", "out/sweep.toml", "--out", "out", "--engine", "list"});
    CHECK((std::count(listed.out.begin(), listed.out.end(), '\n') == 6) == (std::string(what) != "--snapshots"));
    again(all ? printed : words);
    CHECK(sweep_results(files.folder / "out") == table);
    CHECK(differing(pictures_and_surfaces(), made) == "");
  }
}
