// impinge check
#include <fmt/format.h>

#include "viewer/app/shared_options.hpp"
#include "viewer/study/deformable_report.hpp"

namespace impinge {

namespace {

class CheckCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    scene_options(options, scene_, overrides_);
    script_option(options, script_, "script file");
  }

  int run() override {
    const Session session(scene_, overrides_, script_, {.judge = true});
    if (const std::string note = session.note_of_former_paths(); !note.empty()) fmt::print(stderr, "note: {}\n", note);
    fmt::print("{}: {} bodies, {} surface files, no problems found\n", scene_.string(), session.world().bodies().size(),
               session.scene().surfaces.size());
    print_deformable_bodies(session);
    return 0;
  }

 private:
  std::filesystem::path scene_, script_;
  std::vector<std::string> overrides_;
};

}  // namespace

Entry<SubCommand> check_command() {
  return entry<SubCommand, CheckCommand>("check", "check a scene (and a script) and do nothing else");
}

}  // namespace impinge
