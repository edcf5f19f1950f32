// What viewer/README.md says of a new panel, command, figure and list, done to the letter: a file and a line, or a line.
#include "tests/support/program/debug_session.hpp"
#include "tests/support/program/extension.hpp"

using namespace impinge;
using namespace impinge::test;
namespace fs = std::filesystem;

namespace {

/// Built from the recipe, which must not want more than these.
void build(ExtendedProgram& program, const std::string& what, int files, int lines) {
  for (const Recipe& recipe : recipes(slurp(fs::path(IMPINGE_SOURCE_DIR) / "viewer/README.md"), what))
    program.add(recipe);
  CHECK(program.new_files() == files);
  CHECK(program.new_lines() == lines);
  const Outcome built = program.build();
  INFO(built.out << built.err);
  REQUIRE(built.code == 0);
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

TEST_CASE("a panel of the debugger is a file and a line") {
  ExtendedProgram program;
  build(program, "A panel", 1, 1);
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 40\nui click groups/0\npanel scroll groups 0\n");
  const Outcome outcome = program.run(folder.path(), {"debug", "s.toml", "--headless", "--script", "a.script",
                                                      "--record", "r.script", "--size", kSize});
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(slurp(folder / "r.script").find("\nselect body crate\n") != std::string::npos);
  folder.write("a.script", "panel scroll nowhere 0\n");
  CHECK(program.run(folder.path(), {"debug", "s.toml", "--headless", "--script", "a.script"})
            .err.find("layers, parameters, outliner, inspector, contacts, ledger, stages, transport, timeline, "
                      "console, groups") != std::string::npos);
}

TEST_CASE("a command with an option is a file and a line") {
  ExtendedProgram program;
  build(program, "A command", 1, 1);
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "a", "--frames", "7", "--no-images"}).code == 0);
  const Outcome hash = program.run(folder.path(), {"hash", "s.toml", "--after", "7"});
  CHECK(hash.code == 0);
  CHECK(hash.out == hash_in(folder / "a/stats.csv", 7) + "\n");
  CHECK(program.run(folder.path(), {"hash", "s.toml"}).out == hash_in(folder / "a/stats.csv", 0) + "\n");
  CHECK(program.run(folder.path(), {"--help"}).out.find("the hash of a scene's state") != std::string::npos);
  CHECK(program.run(folder.path(), {"hash", "--help"}).out.find("frames to make (default: none)") != std::string::npos);
  const Outcome wrong = program.run(folder.path(), {"hash", "s.toml", "--after", "-1"});
  CHECK(wrong.code == 2);
  CHECK(wrong.err == "command line: --after is '-1'; a whole number from 0 to 100000 is wanted; change it\n");
  CHECK(program.run(folder.path(), {"hash", "s.toml", "--aftr", "1"}).err.find("did you mean '--after'?") !=
        std::string::npos);
  CHECK(program.run(folder.path(), {"hush"}).err.find("did you mean 'hash'?") != std::string::npos);
}

TEST_CASE("a figure is a line") {
  ExtendedProgram program;
  build(program, "A figure", 0, 1);
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "expect momentum_size > 100 at 5\nexpect momentum_size < 0 at 6\n");
  const std::vector<std::string> run = {"run", "s.toml", "--frames", "9", "--no-images", "--quiet", "--out"};
  for (const char* judge : {"", "--judge"}) {
    CAPTURE(judge);
    std::vector<std::string> words = run;
    words.insert(words.end(), {std::string("run") + judge, "--script", "a.script"});
    if (*judge != 0) words.emplace_back(judge);
    const Outcome outcome = program.run(folder.path(), words);
    CHECK(outcome.code == 1);  // the second expectation
    CHECK(outcome.err.find("a.script:2:1: frame 6: expected momentum_size < 0; found momentum_size = ") !=
          std::string::npos);
    const std::string stats = slurp(folder / (std::string("run") + judge + "/stats.csv")), header = first_line(stats);
    CHECK(header.ends_with(std::string(",residual_coulomb,ended,attachment_error_m,guard_ms") +
                           (*judge != 0 ? ",judged_depth_m,momentum_size" : ",momentum_size")));
    // of the last frame, held against its components
    const std::string last = stats.substr(stats.rfind('\n', stats.size() - 2) + 1);
    const auto cell = [&](const std::string& name) {
      std::istringstream names(header), cells(last);
      for (std::string n, c; std::getline(names, n, ',') && std::getline(cells, c, ',');)
        if (n == name) return std::stod(c);
      return -1.0;
    };
    const double x = cell("momentum_x"), y = cell("momentum_y"), z = cell("momentum_z");
    CHECK(cell("momentum_size") == Approx(std::sqrt(x * x + y * y + z * z)).epsilon(1e-12));
  }
  CHECK(program.run(folder.path(), {"list", "figures"}).out.find("\nmomentum_size ") != std::string::npos);
  folder.write("b.script", "panel plot +momentum_size\nstep 3\nback 1\n");
  CHECK(debug(folder, "s.toml", "b.script").code == 2);  // not in the program as it is
  CHECK(program.run(folder.path(), {"debug", "s.toml", "--headless", "--script", "b.script"}).code == 0);
  CHECK(program
            .run(folder.path(), {"sweep", "s.toml", "--vary", "contact.friction=0.1,0.2", "--column",
                                 "most=max(momentum_size)", "--frames", "3", "--no-images", "--out", "sweep"})
            .code == 0);
  // folders from before are read, and go on with what they have
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "old", "--frames", "5", "--no-images"}).code == 0);
  REQUIRE(
      program.run(folder.path(), {"run", "s.toml", "--out", "old", "--frames", "9", "--no-images", "--resume"}).code ==
      0);
  CHECK(first_line(slurp(folder / "old/stats.csv")).ends_with(",residual_coulomb,ended,attachment_error_m,guard_ms"));
  CHECK(impinge_run(folder.path(), {"replay", "old"}).code == 0);
  CHECK(program.run(folder.path(), {"debug", "old", "--headless", "--script", "b.script"}).code == 0);
}

TEST_CASE("a list is a line") {
  ExtendedProgram program;
  build(program, "A list", 0, 1);
  const TempFolder folder;
  const Outcome list = program.run(folder.path(), {"list", "commands"});
  CHECK(list.code == 0);
  CHECK(list.out.starts_with("run "));
  CHECK(program.run(folder.path(), {"list", "--help"}).out.find("|commands") != std::string::npos);
  CHECK(program.run(folder.path(), {"list", "comands"}).err.find("did you mean 'commands'?") != std::string::npos);
}
