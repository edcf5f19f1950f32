// impinge export: the frames of a run, in files that other programs read.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "engine/core/interrupt.hpp"
#include "engine/io/paths.hpp"
#include "viewer/app/frame_progress.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/controller/recorded_run.hpp"
#include "viewer/export/exports.hpp"
#include "viewer/export/frame_range.hpp"

namespace impinge {

namespace {

class ExportCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("DIR", folder_, "folder of the run");
    options.names("--format", formats_, "one or several, with commas between them. " + export_formats_doc());
    options.other(
        "--frames", [this](const std::string& text) { range_ = FrameRange(text, "--frames"); },
        "FIRST:LAST:STEP, both ends included; FIRST:LAST, or one frame (default: all)");
    options.path("--out", out_, "folder to write to (default: DIR/export)");
    memory_option(options);
    threads_option(options);
    quiet_option(options, quiet_);
  }
  int run() override;

 private:
  std::filesystem::path folder_, out_;
  std::vector<std::string> formats_;
  FrameRange range_;
  bool quiet_ = false;
};

int ExportCommand::run() {
  if (formats_.empty())
    refuse_option("export without --format", "what the files are to be is wanted", "write --format vtu, say");
  for (const std::string& format : formats_) find_exporter(format, "--format");
  std::sort(formats_.begin(), formats_.end());
  formats_.erase(std::unique(formats_.begin(), formats_.end()), formats_.end());
  if (out_.empty()) out_ = folder_ / "export";
  if (is_there(out_) && !is_folder(out_))
    throw InputError(out_.string() + ": is a file; a folder is wanted; choose another --out");
  RecordedRun run(folder_);
  const std::vector<int> frames = range_.frames(static_cast<int>(run.rows().size()) - 1);
  const Session& session = run.session();
  ExportJob job = session.export_job();
  job.folder = out_;
  job.option = "--format";
  job.first = frames.front(), job.stride = range_.stride();
  job.frames = static_cast<int>(frames.size());
  Exports exports(formats_, job, session.world().record_of_all());
  FrameProgress progress;
  const bool shows_progress = !quiet_ && isatty(STDERR_FILENO);
  bool is_the_run = true;
  for (const int frame : frames) {
    check_interrupt();
    if (!run.go_to(frame) && is_the_run) {
      is_the_run = false;
      progress.clear();
      fmt::print(stderr, "note: frame {} came out otherwise than recorded: another program or machine made the run\n",
                 frame);
    }
    exports.add(run.record());
    if (shows_progress) progress.show(frame, frames.back());
  }
  exports.finish();
  progress.clear();
  if (quiet_) return 0;
  for (const std::string& result : exports.results())
    fmt::print("exported: {} ({} frame{})\n", result, frames.size(), frames.size() == 1 ? "" : "s");
  return 0;
}

}  // namespace

Entry<SubCommand> export_command() {
  return entry<SubCommand, ExportCommand>(
      "export", "a run's frames as files for other programs: PLY, OBJ, glTF, VTK, USD, poses");
}

}  // namespace impinge
