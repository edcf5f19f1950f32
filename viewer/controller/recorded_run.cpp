#include "viewer/controller/recorded_run.hpp"

#include <fmt/format.h>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/present/png_sequence.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostOfTable = std::uint64_t{64} << 30;

std::vector<StatsLine> read_rows(const fs::path& file, const StatsShape& shape) {
  const std::string table = read_file(file, kMostOfTable);
  const std::string name = file.string();
  StatsReader reader(table, shape, name);
  std::vector<StatsLine> rows;
  for (StatsLine row; reader.next(row); rows.push_back(row))
    if (row.figures[0] != static_cast<double>(rows.size()))
      throw InputError(fmt::format("{}:{}: is of frame {}; rows in order are wanted; run the scene again", name,
                                   rows.size() + 2, row.figures[0]));
  if (rows.empty()) throw InputError(file.string() + ": has no frames; a recorded run is wanted; run the scene first");
  return rows;
}

}  // namespace

RecordedRun::RecordedRun(const fs::path& folder) : folder_(folder) {
  if (!is_there(folder))
    throw InputError(folder.string() +
                     ": there is no such folder; the --out of an impinge run is wanted; check the path");
  if (!is_file(folder / "run.toml"))
    throw InputError(folder.string() +
                     ": holds no run.toml; the folder of a run is wanted; name the --out of an impinge run");
  session_ = std::make_unique<Session>(folder / "run.toml", std::vector<std::string>(), fs::path(),
                                       SessionOptions{1280, 720, false, true});
  if (!session_->scene().run)
    throw InputError((folder / "run.toml").string() +
                     ": has no table [run]; a file that a run wrote is wanted; name the --out of an impinge run");
  is_judged_ = session_->is_judged();
  rows_ = read_rows(folder / "stats.csv", session_->stats_shape());
}

fs::path RecordedRun::picture(int frame) const { return folder_ / "frames" / PngSequence::file_name(frame); }

bool RecordedRun::has_snapshot(int frame) const {
  return is_valid_snapshot(folder_ / "snapshots" / fmt::format("{:06}.bin", frame));
}

bool RecordedRun::go_to(int frame) {
  IMPINGE_ASSERT(frame >= session_->frame() && frame < static_cast<int>(rows_.size()));
  for (int from = frame; from > session_->frame() && from > 0; --from) {
    if (!has_snapshot(from)) continue;
    restore_snapshot(folder_ / "snapshots" / fmt::format("{:06}.bin", from), *session_);
    break;
  }
  while (session_->frame() < frame) session_->advance();
  return hex64(session_->world().state_hash()) == rows_[static_cast<std::size_t>(frame)].state_hash;
}

}  // namespace impinge
