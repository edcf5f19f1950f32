// The folder of a run that was made: its rows, and the state of any of its frames, made again from the nearest snapshot.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "viewer/controller/session.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

class RecordedRun {
 public:
  /// Throws InputError where the folder is no run's.
  explicit RecordedRun(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<StatsLine>& rows() const { return rows_; }
  const std::vector<std::string>& columns() const { return figure_names(is_judged_); }
  std::filesystem::path picture(int frame) const;
  bool has_snapshot(int frame) const;

  /// The state of a frame, made again; frames in ascending order. False if it isn't the recorded one.
  bool go_to(int frame);
  const StepRecord& record() const { return session_->record(); }
  const Session& session() const { return *session_; }
  Session& session() { return *session_; }

 private:
  std::filesystem::path folder_;
  std::vector<StatsLine> rows_;
  bool is_judged_ = false;
  std::unique_ptr<Session> session_;
};

}  // namespace impinge
