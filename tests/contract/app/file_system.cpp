// Faults of the file system through every command: exit code 2 and one message with the true reason, never a bug of
// ours, and no "not there" for what may only not be seen.
#include <sys/stat.h>

#include <catch2/catch.hpp>

#include <map>
#include <thread>

#include "tests/support/pictures/picture_scene.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A vertex that stays above a face.
const std::string kQuery =
    "1,4,1,4,1,2,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,1,1,0,1,0\n"
    "1,4,1,4,1,2,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,1,1,0,1,0\n";

namespace fs = std::filesystem;
using Args = std::vector<std::string>;

/// What a command wants at a path: a file or a folder that is there, or one that it makes, a folder with those above it.
enum class Wants { file, folder, new_file, new_folder };

/// Where a command takes a path, written as X.
struct Place {
  Args words;
  Wants wants;
};

/// A folder with a scene, a script, a suite, a frozen step, two runs that part and a sweep.
struct Files {
  TempFolder folder;
  std::string job;
  Files() {
    const std::string scene = std::string(kCrateOnSlab) + "position = [0, 0.2, 0]\n" + kFrontView;
    folder.write("s.toml", scene);
    folder.write("a.script", "at 1 set contact.friction 0.4\n");
    folder.write("d.script", "shot x.png\n");
    folder.write("suite/t.toml", scene);
    folder.write("queries/one/vertex-face/1.csv", kQuery);
    folder.write("suite/t.script", "expect bodies == 2 at 1\n");
    run({"run", "s.toml", "--out", "a", "--frames", "3", "--size", "64x36", "--freeze", "3"});
    run({"run", "s.toml", "--out", "b", "--frames", "3", "--size", "64x36", "--set",
         "body.crate.position=[0.6,0.4,0]"});
    run({"sweep", "s.toml", "--vary", "contact.friction=0.1", "--frames", "1", "--no-images", "--out", "swept"});
    job = csv_rows(folder / "swept/results.csv")[0].at("hash");
    folder.write("mesh/m.toml",
                 "[[body]]\nname = \"b\"\nkind = \"dynamic\"\nsurface = \"closed.off\"\n[[body]]\nname = \"c\"\nkind = "
                 "\"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n");
  }
  void run(const Args& words) const {
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
  }
  std::vector<Place> places() const {
    using enum Wants;
    return {{{"run", "X", "--no-images", "--out", "o"}, file},
            {{"run", "s.toml", "--script", "X", "--no-images", "--out", "o"}, file},
            {{"run", "s.toml", "--frames", "1", "--no-images", "--out", "X"}, new_folder},
            {{"run", "s.toml", "--frames", "1", "--no-images", "--out", "X", "--resume"}, new_folder},
            {{"run", "s.toml", "--frames", "1", "--size", "64x36", "--out", "o", "--video", "X/v.mp4"}, new_folder},
            {{"replay", "X"}, Wants::folder},
            {{"check", "X"}, file},
            {{"check", "s.toml", "--script", "X"}, file},
            {{"info", "X"}, file},
            {{"info", "s.toml", "--ablation", "--frames", "1", "--out", "X"}, new_folder},
            {{"step", "X"}, file},
            {{"step", "a/frozen/000003.step", "--lcp", "projected_gauss_seidel", "--out", "X"}, new_folder},
            {{"sweep", "X", "--vary", "contact.friction=0.1", "--out", "o"}, file},
            {{"sweep", "s.toml", "--script", "X", "--vary", "contact.friction=0.1", "--out", "o"}, file},
            {{"sweep", "s.toml", "--vary", "contact.friction=0.1", "--frames", "1", "--no-images", "--out", "X"},
             new_folder},
            {{"sweep", "--job", job, "--out", "X"}, Wants::folder},
            {{"test", "X"}, Wants::folder},
            {{"test", "suite", "--out", "X"}, new_folder},
            {{"test", "suite", "--out", "o", "--junit", "X"}, new_file},
            {{"compare", "X", "b"}, Wants::folder},
            {{"compare", "a", "X"}, Wants::folder},
            {{"compare", "a", "b", "--out", "X"}, new_folder},
            {{"diff", "X", "b"}, Wants::folder},
            {{"diff", "a", "X"}, Wants::folder},
            {{"diff", "a", "b", "--mask", "X"}, file},
            {{"diff", "a", "b", "--out", "X"}, new_folder},
            {{"diff", "X", "b", "--update"}, new_folder},
            {{"verify", "ccd", "--queries", "X"}, Wants::folder},
            {{"debug", "X", "--headless", "--script", "d.script"}, file},
            {{"debug", "X", "--headless", "--script", "d.script"}, Wants::folder},
            {{"debug", "s.toml", "--headless", "--script", "X"}, file},
            {{"debug", "s.toml", "--headless", "--script", "d.script", "--record", "X"}, new_file},
            {{"debug", "s.toml", "--headless", "--script", "d.script", "--out", "X"}, new_folder}};
  }
  Outcome outcome_of(Args words, const std::string& path, const Surroundings& surroundings = {}) const {
    for (std::string& word : words)
      if (const std::size_t at = word.find('X'); at == 0) word = path + word.substr(1);
    fs::remove_all(folder / "o");
    return impinge_run(folder.path(), words, surroundings);
  }
};

std::string line_of(const Args& words) {
  std::string line;
  for (const std::string& word : words) line += word + " ";
  return line;
}

void check_refused_for(const Outcome& outcome, const std::string& reason) {
  CHECK(outcome.code == 2);
  CHECK(outcome.error_lines() == 1);
  CHECK(outcome.err.find("bug of impinge") == std::string::npos);
  CHECK(outcome.err.find(reason) != std::string::npos);
  CHECK(outcome.err.find("; ") != std::string::npos);
}

bool is_allowed_to_see_nothing() {
  const bool can = can_lose_rights();
  if (!can) WARN("skipped: permissions hold nobody up here (root that may not give its rights up)");
  return can;
}

}  // namespace

TEST_CASE("every command says permission denied where that is so") {
  if (!is_allowed_to_see_nothing()) return;
  const Files files;
  files.folder.write("closed/inner/x", "x");  // in a folder that may not be entered
  files.folder.write("shut", "x");            // may not be read
  fs::create_directories(files.folder / "blind");
  fs::create_directories(files.folder / "fixed");  // may be read and entered, and not written into
  struct Closed {
    const fs::path folder;
    void mode(unsigned closed, unsigned shut, unsigned fixed) const {
      chmod((folder / "closed").c_str(), closed);
      chmod((folder / "shut").c_str(), shut);
      chmod((folder / "blind").c_str(), closed);
      chmod((folder / "fixed").c_str(), fixed);
    }
    explicit Closed(const fs::path& f) : folder(f) { mode(0, 0, 0555); }
    ~Closed() { mode(0755, 0644, 0755); }
  } closed(files.folder.path());
  const std::map<Wants, Args> paths = {{Wants::file, {"closed/inner", "closed/new", "shut"}},
                                       {Wants::folder, {"closed/inner", "closed/new", "blind"}},
                                       {Wants::new_file, {"closed/new", "closed/inner/new", "blind/new", "fixed/new"}},
                                       {Wants::new_folder, {"closed/inner", "closed/new", "blind", "fixed/new"}}};
  for (const Place& place : files.places())
    for (const std::string& path : paths.at(place.wants)) {
      const Outcome outcome = files.outcome_of(place.words, path, {.without_rights = true});
      INFO(line_of(place.words) << "  X = " << path << "\n" << outcome.out << outcome.err);
      check_refused_for(outcome, "Permission denied");
      CHECK(outcome.err.find("there is no") == std::string::npos);
      CHECK(outcome.err.find("holds no") == std::string::npos);
    }
}

TEST_CASE("a file that a scene names and that may not be read is refused for that") {
  if (!is_allowed_to_see_nothing()) return;
  const Files files;
  const fs::path mesh = files.folder.write("mesh/closed.off", "OFF\n");
  chmod(mesh.c_str(), 0);
  for (const char* command : {"check", "info"}) {
    const Outcome outcome = impinge_run(files.folder.path(), {command, "mesh/m.toml"}, {.without_rights = true});
    INFO(outcome.err);
    check_refused_for(outcome, "Permission denied");
  }
}

TEST_CASE("every command says that symbolic links go round in a circle") {
  const Files files;
  fs::create_symlink("loop", files.folder / "loop");
  fs::create_symlink("../mesh/closed.off", files.folder / "mesh/closed.off");
  for (const Place& place : files.places())
    for (const std::string path : {"loop", "loop/below"}) {
      if (path == "loop" && place.wants == Wants::new_file) continue;  // takes the place of the link
      const Outcome outcome = files.outcome_of(place.words, path);
      INFO(line_of(place.words) << "  X = " << path << "\n" << outcome.out << outcome.err);
      check_refused_for(outcome, "Too many levels of symbolic links");
    }
  const Outcome outcome = impinge_run(files.folder.path(), {"check", "mesh/m.toml"});
  INFO(outcome.err);
  check_refused_for(outcome, "Too many levels of symbolic links");
  CHECK(outcome.err.starts_with("mesh/m.toml:4:11: "));
}

TEST_CASE("every command refuses what is not there, and is no bug where it was started in a folder that is gone") {
  const Files files;
  for (const Place& place : files.places()) {
    INFO(line_of(place.words));
    if (place.wants != Wants::new_folder) {
      const Outcome outcome = files.outcome_of(place.words, "gone/x");
      INFO(outcome.err);
      CHECK(outcome.code == 2);
      CHECK(outcome.error_lines() == 1);
    }
    fs::create_directories(files.folder / "start");
    const Outcome outcome = impinge_run(files.folder / "start", place.words, {.in_removed_folder = true});
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
    CHECK(outcome.err.find("bug of impinge") == std::string::npos);
  }
}

TEST_CASE("a folder that goes away while a run writes into it ends the run with a message") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  RunningProgram program(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "1000000", "--no-images"});
  while (!fs::exists(folder / "out/snapshots/000003.bin") && !program.has_ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::error_code error;
  while (fs::exists(folder / "out")) fs::remove_all(folder / "out", error);
  const Outcome outcome = program.wait();
  INFO(outcome.err);
  check_refused_for(outcome, "No such file or directory");
}

TEST_CASE("a full disk behind stdout is one message and exit code 2 from every command") {
  const Files files;
  const std::vector<Args> all = {
      {"--help"},
      {"--version"},
      {"run", "--help"},
      {"list", "parameters"},
      {"list", "layers"},
      {"list", "responses"},
      {"check", "s.toml"},
      {"info", "s.toml"},
      {"info", "s.toml", "--ablation", "--frames", "1"},
      {"run", "s.toml", "--out", "o", "--frames", "1", "--no-images"},
      {"replay", "a"},
      {"step", "a/frozen/000003.step", "--lcp", "projected_gauss_seidel"},
      {"sweep", "s.toml", "--vary", "contact.friction=0.1", "--frames", "1", "--no-images", "--out", "o"},
      {"sweep", "s.toml", "--vary", "contact.friction=0.1", "--frames", "1", "--no-images", "--out", "o", "--engine",
       "list"},
      {"test", "suite", "--out", "o"},
      {"compare", "a", "b"},
      {"compare", "a", "a"},
      {"diff", "a", "b"},
      {"diff", "a", "a"},
      {"verify", "ccd", "--queries", "queries"},
      {"debug", "s.toml", "--headless", "--script", "d.script"}};
  for (const Args& words : all) {
    const Outcome outcome = files.outcome_of(words, "", {.out = "/dev/full"});
    INFO(line_of(words) << "\n" << outcome.err);
    check_refused_for(outcome, "stdout: can't be written (No space left on device)");
  }
  // who says nothing needs no room
  CHECK(files
            .outcome_of({"run", "s.toml", "--out", "o", "--frames", "1", "--no-images", "--quiet"}, "",
                        {.out = "/dev/full"})
            .code == 0);
}

TEST_CASE("with stdout closed nothing that is printed ends up in a file, and that is said") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const std::string command = "cd '" + folder.path().string() + "' && exec " + IMPINGE_PROGRAM +
                              " run s.toml --out out --frames 3 --no-images >&- 2> err";
  const int status = std::system(command.c_str());
  CHECK(WEXITSTATUS(status) == 2);
  CHECK(slurp(folder / "err").starts_with("stdout: can't be written ("));
  CHECK(csv_rows(folder / "out/stats.csv").size() == 4);
  CHECK(slurp(folder / "out/commands.log").empty());
  CHECK(slurp(folder / "out/done") == "done\n");
}
