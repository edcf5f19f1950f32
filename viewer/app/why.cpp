// impinge why: what became of a pair of bodies, filter by filter.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/controller/session.hpp"
#include "viewer/report/pair_report.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kListed = 12;  // names of bodies in a message

BodyIndex body_of(const World& world, const std::string& name) {
  const BodyIndex body = world.bodies().find(name);
  if (!body.is_none()) return body;
  std::vector<std::string> names = world.bodies().names();
  const std::string near = nearest_word(name, names);
  const std::size_t all = names.size();
  if (all > kListed) names.resize(kListed);
  refuse_option(fmt::format("--pair names '{}', which is no body of the scene", name),
                fmt::format("{}{}{} {} wanted", all == 0 ? "a scene with bodies" : "", fmt::join(names, ", "),
                            all > kListed ? fmt::format(" (and {} more)", all - kListed) : "", all > 1 ? "are" : "is"),
                near.empty() ? "choose one of them" : fmt::format("did you mean '{}'?", near));
}

class WhyCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("SCENE|DIR", source_, "scene file (TOML), or the folder of a run, which is repeated");
    options.two_texts("--pair", pair_, "two bodies by their names, or one body twice: with itself");
    options.whole("--frame", frame_, 0, 100'000'000,
                  "the frame (default: where the two first had a contact, or else came nearest; a scene is looked "
                  "through to frame 240, or its script's last if that is later, a run to its last)");
    options.whole("--substep", substep_, 1, 100'000, "of the frame, from 1 (default: its last)");
    options.flag("--json", json_, "for programs: lengths in metres, times in seconds");
    script_option(options, script_);
    set_option(options, overrides_);
    memory_option(options);
    threads_option(options);
    quiet_option(options, quiet_, "no line on how far it is");
  }

  int run() override;

 private:
  fs::path open_source();
  void check_substep(const Session& session) const;

  fs::path source_, script_;
  std::pair<std::string, std::string> pair_;
  std::optional<int> frame_, substep_;
  std::vector<std::string> overrides_, hashes_;  // of a run, by frame
  bool json_ = false, quiet_ = false, is_run_ = false;
};

/// The file to load; of a run, whose frames are known then, its run.toml.
fs::path WhyCommand::open_source() {
  is_run_ = is_folder(source_);
  if (!is_run_) return source_;
  for (const char* name : {"run.toml", "stats.csv"})
    if (!is_file(source_ / name))
      throw InputError(
          fmt::format("{}: this folder is no run's, it has no {}; a scene file, or a folder that impinge run has "
                      "written is wanted; choose one",
                      source_.string(), name));
  if (!overrides_.empty() || !script_.empty())
    refuse_option(fmt::format("{} with a finished run", overrides_.empty() ? "--script" : "--set"),
                  "a run has its own settings and script, in its run.toml", "leave it out, or ask of the scene");
  return source_ / "run.toml";
}

void WhyCommand::check_substep(const Session& session) const {
  const int substeps = session.record().stats.substeps;
  if (!substep_ || *substep_ <= substeps) return;
  refuse_option(fmt::format("--substep is {}", *substep_),
                fmt::format("frame {} has sub-steps 1 to {}", session.frame(), substeps), "choose one of them");
}

int WhyCommand::run() {
  if (substep_ && !frame_)
    refuse_option("--substep without --frame", "the frame that it is of is wanted", "add --frame");
  if (substep_ && *frame_ == 0)
    refuse_option("--substep of frame 0", "frame 0 is as loaded and has none", "leave it out");
  Session session(open_source(), overrides_, script_);
  if (is_run_) {
    const fs::path table = source_ / "stats.csv";
    for (StatsLine& row : whole_rows(read_file(table, std::uint64_t{64} << 30), session.stats_shape()))
      hashes_.push_back(std::move(row.state_hash));
    if (hashes_.empty())
      throw InputError(fmt::format("{}: has no frames; a recorded run is wanted; run the scene first", table.string()));
    if (frame_ && *frame_ >= static_cast<int>(hashes_.size()))
      refuse_option(fmt::format("--frame is {}", *frame_),
                    fmt::format("the run in {} has frames 0 to {}", source_.string(), hashes_.size() - 1),
                    "choose one of them, or run it on by --resume");
  }
  if (const std::string note = session.note_of_former_paths(); !note.empty()) fmt::print(stderr, "note: {}\n", note);
  const int last = frame_.value_or(is_run_ ? static_cast<int>(hashes_.size()) - 1 : session.default_last_frame());

  const World& world = session.world();
  const BodyIndex first = body_of(world, pair_.first), second = body_of(world, pair_.second);
  PairWatch watch(world, first, second, frame_ ? std::optional(PairWatch::Asked{*frame_, substep_}) : std::nullopt);
  FrameProgress progress;
  const bool shows_progress = !quiet_ && isatty(STDERR_FILENO);
  bool is_the_run = true;
  for (int frame = 0; frame <= last; ++frame) {
    session.watch(frame == 0 ? nullptr : &watch);
    session.advance();
    if (frame == 0) watch.look_at_start();
    if (is_run_ && is_the_run && hex64(session.record().stats.state_hash) != hashes_[static_cast<std::size_t>(frame)]) {
      is_the_run = false;
      progress.clear();
      fmt::print(stderr, "note: frame {} came out otherwise than recorded: another program or machine made the run\n",
                 frame);
    }
    if (shows_progress) progress.show(frame, last);
  }
  progress.clear();
  check_substep(session);
  fmt::print("{}", json_ ? pair_json(watch, last) : pair_text(watch, last));
  return 0;
}

}  // namespace

Entry<SubCommand> why_command() {
  return entry<SubCommand, WhyCommand>("why", "why two bodies have a contact, or none: each filter's verdict");
}

}  // namespace impinge
