// impinge check
#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/study/deformable_report.hpp"
#include "viewer/study/scene_preflight.hpp"

namespace impinge {

namespace {

class CheckCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    scene_options(options, scene_, overrides_);
    script_option(options, script_, "script file");
    options.flag("--strict", strict_, "exit code 2 if there is a warning (see impinge list warnings)");
    options.flag("--trial", trial_,
                 "make a sub-step, go on for some seconds, and tell what time and memory frames take");
    threads_option(options);
  }

  int run() override {
    const Session session(scene_, overrides_, script_, {.judge = true});
    if (const std::string note = session.note_of_former_paths(); !note.empty()) fmt::print(stderr, "note: {}\n", note);
    std::optional<Trial> trial;
    if (trial_) trial = try_scene(session, scene_, overrides_, script_);
    const Preflight found = preflight_of(session, trial ? &*trial : nullptr);
    const std::size_t count = found.count();
    const auto bodies = session.world().bodies().size().value();
    const std::size_t files = session.scene().surfaces.size();
    fmt::print("{}: {} bod{}, {} surface file{}, {}{}\n", scene_.string(), bodies, bodies == 1 ? "y" : "ies", files,
               files == 1 ? "" : "s",
               count == 0 ? "no problems found" : fmt::format("{} warning{}", count, count == 1 ? "" : "s"),
               found.silenced == 0 ? "" : fmt::format(" ({} silenced by check.silence)", found.silenced));
    print_deformable_bodies(session);
    if (trial) fmt::print("{}\n", trial_line(*trial, session.default_last_frame()));
    fmt::print("{}", warning_lines(found));
    if (strict_ && count > 0)
      throw InputError(
          fmt::format("{}: {} warning{}; with --strict none is allowed; mend what they name, or write its "
                      "code into check.silence",
                      scene_.string(), count, count == 1 ? "" : "s"));
    return 0;
  }

 private:
  std::filesystem::path scene_, script_;
  std::vector<std::string> overrides_;
  bool strict_ = false, trial_ = false;
};

}  // namespace

Entry<SubCommand> check_command() {
  return entry<SubCommand, CheckCommand>("check", "check a scene (and a script) and warn of what will hurt");
}

}  // namespace impinge
