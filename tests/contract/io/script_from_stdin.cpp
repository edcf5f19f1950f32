// Scripts that come by standard input: what they do is what a file's lines do, and what is written down has them.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// impinge WORDS with a script on its standard input.
Outcome fed(const TempFolder& folder, const std::string& script, const std::string& words) {
  folder.write("fed.script", script);
  Outcome outcome =
      program_run("/bin/sh", folder.path(), {"-c", fmt::format("cat fed.script | {} {}", IMPINGE_PROGRAM, words)});
  UNSCOPED_INFO(words << "\n" << outcome.out << outcome.err);
  return outcome;
}

}  // namespace

TEST_CASE("a script on standard input is one in a file, and the run has it") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const std::string script = "at 4 push ball 200 100 0\nexpect contacts >= 0 at 9\n";
  folder.write("a.script", script);
  const std::string rest = "--frames 10 --no-images --out ";
  REQUIRE(fed(folder, "", "run s.toml --script a.script " + rest + "file").code == 0);
  REQUIRE(fed(folder, "", "run s.toml " + rest + "none").code == 0);
  REQUIRE(fed(folder, script, "run s.toml --script - " + rest + "fed").code == 0);
  CHECK(hash_in(folder / "fed/stats.csv", 10) == hash_in(folder / "file/stats.csv", 10));
  CHECK(hash_in(folder / "fed/stats.csv", 10) != hash_in(folder / "none/stats.csv", 10));
  CHECK(slurp(folder / "fed/run.toml").find("push ball 200 100 0") != std::string::npos);
  CHECK(fed(folder, "", "replay fed").code == 0);
  // gone on with by the same lines, and by no others
  REQUIRE(fed(folder, script, "run s.toml --script - --frames 6 --no-images --out part").code == 0);
  CHECK(fed(folder, "at 4 push ball 1 0 0\n", "run s.toml --script - --resume " + rest + "part").code == 2);
  CHECK(fed(folder, script, "run s.toml --script - --resume " + rest + "part").code == 0);
  CHECK(hash_in(folder / "part/stats.csv", 10) == hash_in(folder / "file/stats.csv", 10));
  // a mistake has its place, and a file may have that name
  const Outcome wrong = fed(folder, "at 1 delete ball\nat 2 psuh crate 0 1 0\n", "run s.toml --script - " + rest + "x");
  CHECK(wrong.code == 2);
  CHECK(wrong.err.rfind("-:2:6: ", 0) == 0);
  folder.write("-", script);
  CHECK(fed(folder, "at 1 psuh\n", "run s.toml --script ./- " + rest + "named").code == 0);
}

TEST_CASE("a debugger's lines may come by standard input, and its recording has them") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const std::string script = "at 3 set contact.friction 0.1\nstep 5\npush ball 200 100 0\nstep 20\n";
  folder.write("a.script", script);
  const Outcome file = debug(folder, "s.toml", "a.script");
  const std::string words = fmt::format("debug s.toml --headless --size {} ", kSize);
  const Outcome by_pipe = fed(folder, script, words + "--script - --record made.script");
  CHECK(by_pipe.code == 0);
  CHECK(by_pipe.out == file.out);
  CHECK(debug(folder, "s.toml", "made.script").out == file.out);
  CHECK(slurp(folder / "made.script").find("at 3 set contact.friction 0.1") != std::string::npos);
}

TEST_CASE("commands whose jobs read the script each refuse standard input") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  check_refused(folder, {"sweep", "s.toml", "--vary", "contact.friction=0.1,0.2", "--script", "-", "--out", "o"},
                "command line: --script - with sweep, ", "a file is wanted; name one");
}

TEST_CASE("standard input that is closed is said to be") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const Outcome outcome =
      program_run("/bin/sh", folder.path(), {"-c", fmt::format("{} check s.toml --script - <&-", IMPINGE_PROGRAM)});
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(outcome.err.rfind("-: standard input can't be read (", 0) == 0);
}
