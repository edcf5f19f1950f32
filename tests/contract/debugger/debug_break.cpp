// `break` in the debugger stops every way of going on at the frame with which it becomes true.
#include <catch2/catch.hpp>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Files {
  TempFolder folder;
  int first = -1;  ///< frame with contacts
  Files() {
    folder.write("s.toml", kRigid);
    folder.write("run.script", "break when contacts > 0\n");
    impinge_run(folder.path(),
                {"run", "s.toml", "--script", "run.script", "--out", "stopped", "--frames", "100", "--no-images"});
    impinge_run(folder.path(), {"run", "s.toml", "--out", "whole", "--frames", "100", "--no-images"});
    for (int frame = 0; !hash_in(folder / "stopped/stats.csv", frame).empty(); ++frame) first = frame;
    REQUIRE(first > 2);
    REQUIRE(first < 60);
  }
  /// The frame that the lines end at, after `break when contacts > 0`; its state is that of the run.
  int end(const std::string& lines, const std::vector<std::string>& more = {},
          const std::string& condition = "contacts > 0") {
    folder.write("a.script", "break when " + condition + "\n" + lines);
    said = debug(folder, "s.toml", "a.script", more);
    INFO(lines << said.err);
    CHECK(said.code == 0);
    const auto [frame, hash] = end_of(said);
    CHECK(hash == hash_in(folder / "whole/stats.csv", frame));
    return frame;
  }
  int times_told() const {
    int count = 0;
    for (std::size_t at = 0; (at = said.err.find("stopped by break", at)) != std::string::npos; ++at) ++count;
    return count;
  }
  Outcome said;
};

}  // namespace

TEST_CASE("step, seek and play stop where a break becomes true, and say so once") {
  Files f;
  for (const char* lines : {"step 60\n", "seek 60\n", "play\nui wait 100\n", "step 1\nstep 1\nstep 58\n"}) {
    CHECK(f.end(lines) == f.first);
    CHECK(f.times_told() == 1);
    CHECK(f.said.err.find("frame " + std::to_string(f.first) + ": stopped by break when contacts > 0") !=
          std::string::npos);
  }
}

TEST_CASE("a line after a break goes on: a break stops where it becomes true, not while it is") {
  Files f;
  CHECK(f.end("seek 60\nstep 3\n") == f.first + 3);
  CHECK(f.end("seek 60\nseek 60\n", {}, "frame >= 20") == 60);
  CHECK(f.end("step 60\nplay\nui wait 5\npause\n", {}, "frame >= 20") == 25);
  CHECK(f.times_told() == 1);
  // each time anew
  CHECK(f.end("seek 60\nseek 60\n", {}, "frame == 10 || frame == 12") == 12);
  CHECK(f.times_told() == 2);
  CHECK(f.end("seek 60\nseek 60\nseek 60\n", {}, "frame == 10 || frame == 12") == 60);
  // neighbours are one
  CHECK(f.end("seek 60\nseek 60\n", {}, "frame == 10 || frame == 11") == 60);
  // true when first looked at counts, and stops nothing that comes after
  CHECK(f.end("step 5\n", {}, "bodies > 0") == 5);
  CHECK(f.times_told() == 1);
}

TEST_CASE("frames that are known already stop going forward too, and going back is never stopped") {
  Files f;
  CHECK(f.end("seek 60\nseek 60\nback 55\nseek 58\n", {}, "frame == 20") == 20);
  CHECK(f.end("seek 60\nseek 60\nback 55\nstep 50\n", {}, "frame == 20") == 20);
  CHECK(f.end("seek 60\nseek 60\nback 55\nplay\nui wait 40\n", {}, "frame == 20") == 20);
  CHECK(f.end("seek 60\nseek 60\nback 30\n", {}, "frame == 20") == 30);
  CHECK(f.end("seek 60\nseek 60\nseek 10\n", {}, "frame == 20") == 10);
  // with room for a few states only, frames between are made again on the way back
  CHECK(f.end("seek 60\nseek 60\nback 35\n", {"--memory", "1"}, "frame == 20") == 25);
}

TEST_CASE("a finished run's own break stops the debugger where it stopped the run") {
  Files f;
  f.folder.write("b.script", "seek 60\n");
  const Outcome outcome = debug(f.folder, "stopped", "b.script");
  INFO(outcome.err);
  CHECK(end_of(outcome) == std::pair(f.first, hash_in(f.folder / "whole/stats.csv", f.first)));
}

TEST_CASE("what was cut short by a break is recorded as what it did") {
  Files f;
  for (const char* lines :
       {"step 60\nstep 4\n", "seek 60\nseek 60\n", "play\nui wait 100\nstep 4\n", "seek 60\nback 3\n"}) {
    CAPTURE(lines);
    const int frame = f.end(lines, {"--record", "r.script"});
    const auto first = end_of(f.said);
    const std::string record = slurp(f.folder / "r.script");
    INFO(record);
    const Outcome again = debug(f.folder, "s.toml", "r.script", {"--record", "r2.script"});
    CHECK(std::count(again.err.begin(), again.err.end(), 0x0a) == f.said.error_lines());
    CHECK(end_of(again) == first);
    CHECK(frame == first.first);
    const std::string second = slurp(f.folder / "r2.script");  // their first lines name the files
    CHECK(second.substr(second.find('\n')) == record.substr(record.find('\n')));
  }
}
