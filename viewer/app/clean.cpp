// impinge clean: how much of runs takes what room, and what of it can go since a run makes it again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>

#include "engine/core/error.hpp"
#include "engine/core/memory.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/io/file.hpp"
#include "engine/io/folder_lock.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/run_record.hpp"
#include "viewer/app/sub_command.hpp"
#include "viewer/controller/run_files.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

struct Part {
  RunPart part;
  const char *name, *option, *what;
};
constexpr Part kParts[] = {
    {RunPart::pictures, "pictures", "--pictures", "frames, ids, contact sheet"},
    {RunPart::exports, "exports", "--exports", "surfaces and other files for other programs"},
    {RunPart::snapshots, "snapshots", "--snapshots", "--resume and impinge debug go on from them"},
    {RunPart::record, "record", "", "kept: run.toml, figures, log, frozen steps"},
    {RunPart::other, "other", "", "kept: no run wrote it"},
};

struct Room {
  std::size_t files = 0;
  double bytes = 0.0;
};
using RoomByPart = std::map<RunPart, Room>;

/// What makes the run again, with all that it had.
std::string command_for(const fs::path& run) {
  const fs::path file = run / "run.toml";
  const RunRecord r =
      read_run_record(parse_toml(file.string(), read_file(file, std::uint64_t{1} << 30)).find("run")->value);
  std::string line = fmt::format("impinge run {} --out {} --force --frames {}", shell_word(file.string()),
                                 shell_word(run.string()), r.frames);
  line += r.images ? fmt::format(" --size {}x{}", r.width, r.height) : " --no-images";
  for (const auto& [is_asked, word] :
       {std::pair(r.ids, " --ids"), {r.contacts, " --contacts"}, {r.export_ply, " --export ply"}})
    if (is_asked) line += word;
  return line;
}

class CleanCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    options.word("DIR", folder_, "folder of a run, or with runs below it (a sweep's)");
    options.flag("--pictures", pictures_, "remove frames, ids and contact sheets");
    options.flag("--exports", exports_, "remove surfaces and what impinge export wrote into the folder");
    options.flag("--snapshots", snapshots_, "remove the states of the frames");
    options.flag("--all", all_, "all three");
  }

  int run() override {
    if (!is_folder(folder_))
      throw InputError(folder_.string() +
                       ": there is no such folder; the --out of an impinge run is wanted; check the path");
    const std::vector<fs::path> runs = runs_below(folder_);
    if (runs.empty())
      throw InputError(folder_.string() +
                       ": holds no run; the --out of an impinge run or sweep is wanted; check the path");
    RoomByPart before, removed;
    std::vector<FolderLock> locks;
    if (removes_anything())  // all of them before the first file goes
      for (const fs::path& run : runs) locks.push_back(FolderLock::take(run));
    for (const fs::path& run : runs)
      for (const RunFile& file : files_of_run(run)) {
        if (file.path.filename() == FolderLock::kName) continue;
        add(before[file.part], file);
        if (!is_chosen(file.part)) continue;
        remove_run_file(run, file.path);
        add(removed[file.part], file);
      }
    print(runs, before, removed);
    return 0;
  }

 private:
  bool removes_anything() const { return pictures_ || exports_ || snapshots_ || all_; }
  bool is_chosen(RunPart part) const {
    switch (part) {
      case RunPart::pictures:
        return all_ || pictures_;
      case RunPart::exports:
        return all_ || exports_;
      case RunPart::snapshots:
        return all_ || snapshots_;
      default:
        return false;
    }
  }

  static void add(Room& room, const RunFile& file) {
    ++room.files;
    room.bytes += static_cast<double>(file.bytes);
  }

  void print(const std::vector<fs::path>& runs, RoomByPart& before, RoomByPart& removed) const {
    fmt::print("{}: {} run{}\n", folder_.string(), runs.size(), runs.size() == 1 ? "" : "s");
    double freed = 0.0, can_go = 0.0;
    for (const Part& part : kParts) {
      const Room &room = before[part.part], &gone = removed[part.part];
      fmt::print("  {:<9}  {:>10}  {:>7} file{}  {:<11}  {}\n", part.name, describe_bytes(room.bytes), room.files,
                 room.files == 1 ? " " : "s", gone.files > 0 ? "removed" : part.option, part.what);
      freed += gone.bytes;
      if (*part.option != 0) can_go += room.bytes;
    }
    if (removes_anything())
      fmt::print("freed:   {}\n", describe_bytes(freed));
    else
      fmt::print("nothing is removed unless an option says what; --all frees {}\n", describe_bytes(can_go));
    if (is_file(folder_ / "sweep.toml"))
      fmt::print("again:   impinge sweep {} --out {}\n", shell_word((folder_ / "sweep.toml").string()),
                 shell_word(folder_.string()));
    else if (runs.size() == 1)
      fmt::print("again:   {}\n", command_for(runs.front()));
  }

  fs::path folder_;
  bool pictures_ = false, exports_ = false, snapshots_ = false, all_ = false;
};

}  // namespace

Entry<SubCommand> clean_command() {
  return entry<SubCommand, CleanCommand>("clean",
                                         "what takes room in folders of runs, and free what a run makes again");
}

}  // namespace impinge
