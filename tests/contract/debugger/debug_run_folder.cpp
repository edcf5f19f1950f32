// A run's folder in the debugger: read, not simulated; and what a run keeps for it.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;
namespace fs = std::filesystem;

TEST_CASE("a finished run's folder opens, and its frames are those of its table") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("run.script", "at 12 set contact.friction 0.1\nat 20 layer +aabbs\n");
  REQUIRE(impinge_run(folder.path(),
                      {"run", "s.toml", "--script", "run.script", "--out", "done", "--frames", "60", "--no-images"})
              .code == 0);
  for (const int frame : {47, 3, 59}) {
    CAPTURE(frame);
    folder.write("a.script", fmt::format("seek 33\nseek {}\n", frame));
    const Outcome outcome = debug(folder, "done", "a.script");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.empty());
    CHECK(end_of(outcome) == std::pair(frame, hash_in(folder / "done/stats.csv", frame)));
  }
  // another future, from a frame of the folder
  folder.write("a.script", "seek 40\nset contact.friction 0\nstep 10\nseek 30\nseek 50\n");
  const Outcome changed = debug(folder, "done", "a.script");
  REQUIRE(changed.code == 0);
  CHECK(changed.err.empty());
  CHECK(end_of(changed).second != hash_in(folder / "done/stats.csv", 50));

  // what the table says is checked, frame by frame
  std::string table = slurp(folder / "done/stats.csv");
  const std::string hash = hash_in(folder / "done/stats.csv", 47),
                    other = (hash[0] == '0' ? "1" : "0") + hash.substr(1);
  table.replace(table.find(hash), 16, other);
  folder.write("done/stats.csv", table);
  folder.write("a.script", "seek 46\nstep\n");
  const Outcome told = debug(folder, "done", "a.script");
  CHECK(told.err.find("frame 47 came out as " + hash + "; stats.csv has " + other) != std::string::npos);
}

TEST_CASE("a finished run's frames are shown without being simulated again") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "done", "--frames", "60", "--no-images"}).code == 0);
  // whatever is simulated from here on comes out otherwise, and is told
  std::string scene = slurp(folder / "done/run.toml");
  REQUIRE(scene.find("-9.81") != std::string::npos);
  scene.replace(scene.find("-9.81"), 5, "-9.01");
  folder.write("done/run.toml", scene);
  folder.write("a.script", "seek 40\nui drag transport/frame 20\nui key right\nplay\nui wait 10\npause\nback 5\n");
  const Outcome shown = debug(folder, "done", "a.script");
  INFO(shown.err);
  CHECK(shown.code == 0);
  CHECK(shown.err.empty());
  const auto [frame, hash] = end_of(shown);
  CHECK(hash == hash_in(folder / "done/stats.csv", frame));

  fs::remove_all(folder / "done/snapshots");
  const Outcome simulated = debug(folder, "done", "a.script");
  CHECK(simulated.code == 0);
  CHECK(simulated.err.find("came out as") != std::string::npos);
}

TEST_CASE("a run's states keep to their room, and lie the farther apart the less it is") {
  const TempFolder folder;
  std::string bodies;  // of some size: 300 bodies a frame
  for (int k = 0; k < 300; ++k)
    bodies += fmt::format(
        "[[body]]\nname = \"b{}\"\nkind = \"dynamic\"\nshape = {{ sphere = {{ radius = 0.1 }} }}\nposition = [{}, 0, "
        "0]\n",
        k, k);
  folder.write("s.toml", bodies);
  for (const char* room : {"0", "1", "256"}) {
    CAPTURE(room);
    REQUIRE(impinge_run(folder.path(),
                        {"run", "s.toml", "--out", room, "--frames", "70", "--no-images", "--snapshots", room})
                .code == 0);
    std::vector<int> frames;
    std::uintmax_t bytes = 0;
    for (const auto& entry : fs::directory_iterator(folder / room / "snapshots"))
      frames.push_back(std::stoi(entry.path().stem().string())), bytes += entry.file_size();
    std::sort(frames.begin(), frames.end());
    CHECK(frames.front() == 0);
    CHECK(frames.back() == 70);
    if (room == std::string("0")) CHECK(frames.size() == 2);
    if (room == std::string("256")) CHECK(frames.size() == 71);
    if (room == std::string("1")) {
      CHECK(bytes <= std::uintmax_t{1} << 20);
      CHECK(2 * bytes > std::uintmax_t{1} << 20);
      for (std::size_t k = 2; k + 1 < frames.size(); ++k) CHECK(frames[k] - frames[k - 1] == frames[1]);
    }
    folder.write("a.script", "seek 33\n");
    const Outcome outcome = debug(folder, room, "a.script");
    CHECK(outcome.err.empty());
    CHECK(end_of(outcome) == std::pair(33, hash_in(folder / room / "stats.csv", 33)));
  }
  CHECK(impinge_run(folder.path(), {"run", "s.toml", "--out", "x", "--snapshots", "-1"}).err.find("--snapshots") !=
        std::string::npos);
}

TEST_CASE("a damaged folder of a run is refused, and a window without a screen") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "seek 5\n");
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "done", "--frames", "10", "--no-images"}).code == 0);
  fs::create_directory(folder / "empty");
  check_refused(debug(folder, "empty", "a.script"), "empty: this folder is no run's, it has no run.toml; ");
  folder.write("timed.script", "at 3 set contact.friction 1\n");
  check_refused(debug(folder, "done", "timed.script"), "timed.script: lines by frame");
  check_refused(debug(folder, "done", "a.script", {"--set", "contact.friction=1"}), "--set with a finished run");
  const std::string table = slurp(folder / "done/stats.csv");
  folder.write("done/stats.csv", "frame,nothing\n0,1\n");
  check_refused(debug(folder, "done", "a.script"), "stats.csv:1: this line is no whole row of a frame; ");
  std::string broken = table;
  const std::size_t third = broken.find("\n3,") + 1;
  broken[third] = 'x';
  folder.write("done/stats.csv", broken);
  check_refused(debug(folder, "done", "a.script"), "stats.csv:5: this line is no whole row");
  folder.write("done/stats.csv", table.substr(0, table.size() - 20));  // cut off: what is whole is taken
  CHECK(debug(folder, "done", "a.script").code == 0);
  folder.write("done/run.toml", "frames = ");
  check_refused(debug(folder, "done", "a.script"), "run.toml");

  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  check_refused(impinge_run(folder.path(), {"debug", "s.toml", "--window"}),
                "--window without a screen; one is wanted; set DISPLAY, or use --headless with --script");
  check_refused(impinge_run(folder.path(), {"debug", "s.toml"}), "debug without a screen and without --script; ");
}
