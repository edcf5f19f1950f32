// impinge test
#include "viewer/app/shared_options.hpp"
#include "viewer/compare/suite.hpp"

namespace impinge {

namespace {

class TestCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("DIR", suite_.folder,
                 "folder of NAME.toml and NAME.script; pictures as the scripts' `expect image` lines name them");
    options.path("--junit", suite_.junit, "XML file of the outcome, as continuous integration reads it");
    options.path("--out", suite_.out, "folder for the runs and the reports of failures (default: out/DIR-test)");
    size_option(options, suite_.width, suite_.height,
                "WIDTHxHEIGHT of pictures without a baseline yet (default: 320x180)");
    options.flag("--update", suite_.update,
                 "write the pictures that `expect image` lines name where they differ or are missing, and say which");
    options.name_lists("--only", suite_.only,
                       "NAME[,NAME...], may be given several times: run only these tests of the folder, NAME as in "
                       "NAME.toml; a comma that belongs to a name is written \\, (in quotes for the shell)");
    options.whole("--jobs", suite_.jobs, 1, 4096,
                  "tests at once, each in a process of its own (default: 1, one after another); what is printed and "
                  "written is the same");
    options.hidden("--worker", suite_.worker);
    memory_option(options);
    threads_option(options);
  }
  int run() override { return run_suite(suite_); }

 private:
  SuiteOptions suite_;
};

}  // namespace

Entry<SubCommand> test_command() {
  return entry<SubCommand, TestCommand>(
      "test",
      "run every scene of a folder that has a script of the same name, and check its expectations and pictures");
}

}  // namespace impinge
