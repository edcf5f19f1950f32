// What nothing can come of is said: acts on bodies that aren't there, impulses far off their bodies. And what was answered
// before something went wrong is not lost.
#include <fmt/format.h>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::vector<std::string> recorded(const TempFolder& folder, const char* file) {
  std::istringstream in(slurp(folder / file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("#")) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("what is done by hand to a body that is deleted is refused, and says what to do") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  struct Case {
    const char *line, *column;
  };
  const Case cases[] = {{"push crate 0 1 0", "6"},
                        {"move crate 0 1 0", "6"},
                        {"pull crate 0 0 0 to 1 1 1", "6"},
                        {"delete crate", "8"},
                        {"set body.crate.friction 0.1", "5"},
                        {"set body.crate.velocity 0 1 0", "5"},
                        {"follow crate", "8"}};
  for (const Case& c : cases) {
    CAPTURE(c.line);
    // at once, and when it is gone from the picture
    folder.write("a.script", fmt::format("step 2\ndelete crate\n{}\n", c.line));
    check_refused(debug(folder, "s.toml", "a.script"),
                  fmt::format("a.script:3:{}: 'crate', which is deleted by then; a body that is there is wanted; undo ",
                              c.column));
    folder.write("a.script", fmt::format("step 2\ndelete crate\nstep 3\n{}\nstep\n", c.line));
    check_refused(debug(folder, "s.toml", "a.script", {"--record", "made.script"}),
                  fmt::format("a.script:4:{}: 'crate', which was deleted in frame 3; ", c.column));
    CHECK(recorded(folder, "made.script") == std::vector<std::string>{"step 2", "delete crate", "step 3"});
    // it is there again before that, and once that is undone
    for (const char* back : {"undo", "seek 1"}) {
      folder.write("a.script", fmt::format("step 2\ndelete crate\nstep 3\n{}\n{}\nstep\n", back, c.line));
      CHECK(debug(folder, "s.toml", "a.script").code == 0);
    }
  }
  // what is let go of was held until then
  folder.write("a.script", "step 2\npull crate 0 0 0 to 1 1 1\nstep\ndelete crate\nrelease crate\nstep\n");
  CHECK(debug(folder, "s.toml", "a.script").code == 0);
  // one that another line adds
  folder.write("a.script", "step 2\nadd new like ball at 0 9 0\npush new 0 1 0\nstep 2\nseek 1\npush new 0 1 0\n");
  check_refused(debug(folder, "s.toml", "a.script"), "a.script:6:6: 'new', which is added in a later frame only; ");
}

TEST_CASE("a line that is typed for a deleted body says so in the console, and changes nothing") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "step 2\ndelete crate\nstep\nui click console/line\nui text push crate 0 1 0\nui key enter\nstep 2\n");
  folder.write("b.script", "step 2\ndelete crate\nstep\nstep 2\n");
  const Outcome typed = debug(folder, "s.toml", "a.script", {"--record", "made.script"});
  INFO(typed.err);
  CHECK(typed.code == 0);
  CHECK(typed.err.find("console:1:6: 'crate', which was deleted in frame 3; ") != std::string::npos);
  CHECK(end_of(typed) == end_of(debug(folder, "s.toml", "b.script")));
  CHECK(slurp(folder / "made.script").find("push") == std::string::npos);
}

TEST_CASE("an impulse far off its body is told of, in a run and by hand") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoftCube);
  struct Case {
    const char *push, *note;  // "": nothing is said
  };
  const Case cases[] = {{"push crate 0 1 0 at 50 0.5 0", "'crate' was pushed at 50 0.5 0, 49."},
                        {"push jelly 0 1 0 at -0.9 30 0", "away from it: its nearest point had the impulse"},
                        {"push crate 0 1 0 at 0.4 0.5 0.4", ""},
                        {"push crate 0 1 0", ""}};
  for (const Case& c : cases) {
    CAPTURE(c.push);
    folder.write("a.script", fmt::format("at 3 {}\n", c.push));
    const Outcome run = impinge_run(folder.path(), {"run", "s.toml", "--script", "a.script", "--frames", "4", "--out",
                                                    "o", "--no-images", "--force"});
    CHECK(run.code == 0);
    folder.write("b.script", fmt::format("step 2\n{}\nstep 2\n", c.push));
    const Outcome by_hand = debug(folder, "s.toml", "b.script", {"--answers"});
    CHECK(by_hand.code == 0);
    INFO(run.out << run.err << by_hand.out);
    const std::string said = run.out + run.err;
    if (*c.note == '\0') {
      CHECK(said.find("pushed") == std::string::npos);
      CHECK(by_hand.out.find("pushed") == std::string::npos);
    } else {
      CHECK(said.find("note: frame 3: ") != std::string::npos);
      CHECK(said.find(c.note) != std::string::npos);
      CHECK(by_hand.out.find(c.note) != std::string::npos);
    }
  }
}

TEST_CASE("what was answered is printed where a later line fails") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 40\nwhy ball crate\n");
  const std::string answered = debug(folder, "s.toml", "a.script", {"--answers"}).out;
  const std::string answers = answered.substr(answered.find('\n') + 1);
  REQUIRE(answers.find("ball") != std::string::npos);
  folder.write("a.script", "step 40\nwhy ball crate\nselect contact 99999\nwhy ball floor\n");
  const Outcome failed = debug(folder, "s.toml", "a.script", {"--answers"});
  CHECK(failed.code == 2);
  CHECK(failed.out == answers);
  CHECK(failed.err.find("a.script:3:16: contact 99999") != std::string::npos);
  CHECK(debug(folder, "s.toml", "a.script").out.empty());
  CHECK(debug(folder, "s.toml", "a.script", {"--answers", "--quiet"}).out.empty());
}
