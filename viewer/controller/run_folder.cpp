#include "viewer/controller/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/core/error.hpp"
#include "engine/frozen/frozen_step_file.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/run_record.hpp"
#include "engine/ledger/ledger_table.hpp"
#include "viewer/controller/run_files.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/export/surface_export.hpp"
#include "viewer/tables/contacts_table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostOfRecord = std::uint64_t{64} << 30;

std::string six_digits(int frame) { return fmt::format("{:06}", frame); }

// run.toml without its number of frames, and that number
std::pair<std::string, int> split_frames(const std::string& run_toml) {
  const std::size_t begin = run_toml.find("\nframes = ");
  if (begin == std::string::npos) return {run_toml, 0};
  const std::size_t end = std::min(run_toml.find('\n', begin + 1), run_toml.size());
  int frames = 0;
  std::from_chars(run_toml.data() + begin + 10, run_toml.data() + end, frames);
  return {run_toml.substr(0, begin) + run_toml.substr(end), frames};
}

std::string read_if_there(const fs::path& path) { return is_file(path) ? read_file(path, kMostOfRecord) : ""; }

// how many bytes to keep so that no line of a frame after `frame` stays; `number` finds a line's frame
template <class Number>
std::uint64_t bytes_up_to(const std::string& text, int frame, bool header, Number number) {
  std::size_t begin = 0;
  bool first = header;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos || (!first && number(std::string_view(text).substr(begin, end - begin)) > frame))
      break;
    first = false;
    begin = end + 1;
  }
  return begin;
}

int leading_number(std::string_view text) {
  int value = std::numeric_limits<int>::max();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

int frame_of_command(std::string_view line) {
  return line.substr(0, 3) == "at " ? leading_number(line.substr(3)) : std::numeric_limits<int>::max();
}

AppendFile open_table(const fs::path& path, int frame, const std::string& header) {
  const std::string text = read_if_there(path);
  const std::uint64_t keep = frame < 0 ? 0 : bytes_up_to(text, frame, true, leading_number);
  AppendFile file(path, keep);
  if (keep == 0) file.append(header + "\n");
  return file;
}

constexpr std::string_view kStepCpu = "step_cpu_ms = ";  // in the file `done`

/// "its run.toml differs in simulation.substeps, contact.friction and 2 more".
std::string differing_text(const fs::path& recorded, const std::string& before, const std::string& now) try {
  constexpr std::size_t kMostNamed = 4;
  std::vector<std::string> names;
  for (const SettingDifference& difference :
       setting_differences(parse_toml(recorded.string(), before), parse_toml("", now)))
    if (const std::string name = difference.path.starts_with("script: ") ? "the script's lines" : difference.path;
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  if (names.empty()) return "its run.toml differs";
  const std::size_t named = std::min(names.size(), kMostNamed);
  return fmt::format("its run.toml differs in {}{}", fmt::join(names.begin(), names.begin() + named, ", "),
                     names.size() > named ? fmt::format(" and {} more", names.size() - named) : "");
} catch (const InputError&) {  // somebody has changed it, and it says nothing now
  return "its run.toml differs";
}

bool is_our_number(const fs::path& path, const char* ending) {
  const std::string stem = path.stem().string();
  return path.extension() == ending && stem.size() == 6 && stem.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

RunFolder::RunFolder(const fs::path& folder, const RunRecord& run, const std::string& run_toml, RunStart how,
                     std::uint64_t snapshot_bytes, const StatsShape& shape)
    : folder_(folder), run_(run), most_snapshot_bytes_(snapshot_bytes), columns_(shape) {
  try {
    check_new(how, run_toml);  // before anything is written, the lock's file among it
  } catch (const InputError&) {
    FolderLock::check_free(folder_);  // what another process has begun just now is its own to be told of,
    check_new(how, run_toml);         // or was ended since
  }
  make_folder(folder_);
  lock_ = FolderLock::take(folder_);
  check_new(how, run_toml);  // what another process may have made of it until it gave the lock back
  clear_leftovers();
  if (how == RunStart::force && is_run_folder(folder_)) empty_run_folder(folder_);
  if (how == RunStart::resume) {
    const std::string text = read_if_there(folder_ / "stats.csv");
    kept_ = whole_rows(text, shape);
    kept_.resize(static_cast<std::size_t>(last_resumable(kept_)) + 1);
    if (!kept_.empty()) columns_ = StatsColumns(std::string_view(text).substr(0, text.find('\n')), shape);
  }
  write_file(folder_ / "run.toml", run_toml);
  clear_markers();
  make_folder(folder_ / "snapshots");
  if (run_.images) make_folder(folder_ / "frames");
  if (run_.ids) make_folder(folder_ / "ids");
  if (run_.export_ply) make_folder(folder_ / "surfaces");
  const std::string log = read_if_there(folder_ / "commands.log");
  commands_ = AppendFile(folder_ / "commands.log",
                         resume_frame() < 0 ? 0 : bytes_up_to(log, resume_frame(), false, frame_of_command));
  if (run_.contacts) contacts_ = open_table(folder_ / "contacts.csv", resume_frame(), contacts_header());
  stats_ = open_table(folder_ / "stats.csv", resume_frame(), columns_.header());
}

void RunFolder::check_new(RunStart how, const std::string& run_toml) const {
  const std::string name = folder_.string();
  if (!is_there(folder_)) return;
  if (!is_folder(folder_)) throw InputError(name + ": is a file; a folder is wanted; choose another --out");
  const fs::path recorded = folder_ / "run.toml";
  if (!is_there(recorded)) {
    for (const std::string& other : names_in(folder_))
      if (other != FolderLock::kName && !is_temporary_name(other))
        throw InputError(fmt::format(
            "{}: holds {} and is no run's folder; a new or empty folder is wanted; choose another --out", name, other));
    return;
  }
  if (how == RunStart::force) {
    if (is_run_folder(folder_)) return;
    throw InputError(fmt::format(
        "{}: holds a run.toml that no run of impinge wrote; --force replaces runs only; choose another --out", name));
  }
  const bool resume = how == RunStart::resume;
  const auto [before, frames_before] = split_frames(read_file(recorded, kMostOfRecord));
  const auto [now, frames_now] = split_frames(run_toml);
  if (before != now)
    throw InputError(fmt::format(
        "{}: holds another run ({}); a new folder or the same scene, script and settings are wanted; choose another "
        "--out, or add --number, or --force to replace it",
        name, differing_text(recorded, before, now)));
  if (resume && frames_now < frames_before)
    throw InputError(fmt::format("{}: holds a run of {} frames; it can't be resumed with {}; choose another --out",
                                 name, frames_before, frames_now));
  if (!resume && frames_now != frames_before)
    throw InputError(
        fmt::format("{}: holds this run with --frames {}; it can be continued to more frames; add --resume, or --force "
                    "to replace it, or choose another --out",
                    name, frames_before));
}

int RunFolder::last_resumable(const std::vector<StatsLine>& rows) const {
  int pictures = static_cast<int>(rows.size());
  if (run_.images) {
    int there = 0;
    while (there < pictures && is_there(picture(there)) && (!run_.ids || is_there(id_picture(there)))) ++there;
    pictures = there;
  }
  for (int frame = pictures - 1; frame >= 0; --frame)
    if (is_valid_snapshot(snapshot(frame))) return frame;
  for (int frame = pictures - 1; frame >= 0; --frame) refuse_other_version(snapshot(frame));
  return -1;
}

void RunFolder::clear_leftovers() const {
  std::vector<fs::path> folders = {folder_};
  for (const char* name : {"snapshots", "frames", "ids", "frozen", "export"}) folders.push_back(folder_ / name);
  // of surfaces only the last frame's can be half written
  if (const fs::path surfaces = folder_ / "surfaces"; is_folder(surfaces))
    if (const std::vector<std::string> frames = names_in(surfaces); !frames.empty())
      folders.push_back(surfaces / frames.back());
  std::error_code error;
  for (const fs::path& folder : folders) {
    if (!is_folder(folder)) continue;
    for (const std::string& name : names_in(folder))
      if (is_temporary_name(name)) fs::remove(folder / name, error);
  }
}

void RunFolder::clear_markers() {
  std::error_code error;
  fs::remove(folder_ / "done", error);
  // snapshots after the point of return belong to frames that are about to be made again
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "snapshots", error)) {
    if (!is_our_number(entry.path(), ".bin")) continue;
    const int frame = leading_number(entry.path().stem().string());
    if (frame > resume_frame())
      fs::remove(entry.path(), error);
    else
      snapshot_bytes_ += snapshots_[frame] = entry.file_size(error);
  }
}

fs::path RunFolder::snapshot(int frame) const { return folder_ / "snapshots" / (six_digits(frame) + ".bin"); }
fs::path RunFolder::picture(int frame) const { return folder_ / "frames" / (six_digits(frame) + ".png"); }
fs::path RunFolder::id_picture(int frame) const { return folder_ / "ids" / (six_digits(frame) + ".png"); }

fs::path RunFolder::frozen_step(int frame) const { return folder_ / "frozen" / (six_digits(frame) + ".step"); }

void RunFolder::add_frame(const StepRecord& record, std::span<const Command> commands, const FrameStats& stats,
                          std::span<const double> own) {
  const int frame = record.stats.frame;
  if (run_.export_ply) {
    const fs::path surfaces = folder_ / "surfaces" / six_digits(frame);
    make_folder(surfaces);
    export_surfaces(surfaces, record);
  }
  std::string log;
  for (const Command& command : commands) log += fmt::format("at {} {}\n", frame, format_command(command));
  commands_.append(log);
  if (run_.contacts) contacts_.append(contacts_rows(record));
  if (record.stats.ledger) {
    if (!ledger_) ledger_ = open_table(folder_ / "ledger.csv", resume_frame(), ledger_header());
    std::vector<std::string> names;
    for (const BodyRecord& body : record.bodies) names.emplace_back(body.name);
    ledger_->append(ledger_rows(*record.stats.ledger, frame, record.stats.time, names));
  }
  stats_.append(columns_.row(stats, own) + "\n");
}

void RunFolder::add_snapshot(const Session& session, std::string_view notes) {
  const int frame = session.frame(), before = snapshots_.empty() ? 0 : snapshots_.rbegin()->first;
  snapshot_bytes_ += snapshots_[frame] = write_snapshot(snapshot(frame), session, notes);
  if (before % spacing_ != 0) forget_snapshot(before);
  while (snapshots_.size() > 2 && snapshot_bytes_ > most_snapshot_bytes_) {
    spacing_ *= 2;
    for (auto it = snapshots_.begin(); it != snapshots_.end();) {
      const int k = (it++)->first;
      if (k % spacing_ != 0 && k != frame) forget_snapshot(k);
    }
  }
}

void RunFolder::forget_snapshot(int frame) {
  std::error_code error;
  fs::remove(snapshot(frame), error);
  snapshot_bytes_ -= snapshots_[frame];
  snapshots_.erase(frame);
}

void RunFolder::add_frozen_step(const FrozenStep& step) {
  make_folder(folder_ / "frozen");
  write_frozen_step(frozen_step(step.frame), step);
}

void RunFolder::finish(double step_cpu_ms) {
  write_file(folder_ / "done", step_cpu_ms < 0.0 ? "done\n" : fmt::format("done\n{}{:.3f}\n", kStepCpu, step_cpu_ms));
}

std::optional<double> recorded_step_cpu_ms(const fs::path& folder) {
  const std::string text = read_if_there(folder / "done");
  const std::size_t at = text.find(kStepCpu);
  if (at == std::string::npos) return std::nullopt;
  return std::strtod(text.c_str() + at + kStepCpu.size(), nullptr);
}

}  // namespace impinge
