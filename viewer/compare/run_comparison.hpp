// Two recorded runs side by side: what was set differently, the first frame whose states differ, and in what.
//
// Where they part is read from the state hashes of both stats.csv. In what they part is found by making that frame
// again: each run is continued from its nearest snapshot, ten frames at most, and the frame counts only if its hash is
// the recorded one. So no exported surface is needed and what is compared is the whole state, bit by bit.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewer/controller/session.hpp"
#include "viewer/controller/stats_table.hpp"

namespace impinge {

/// A setting that two runs don't share.
struct SettingDifference {
  std::string path, a, b;  ///< values as TOML; "" where there is none
};
/// How far a body's state differs in one field.
struct FieldDifference {
  std::string body, field, unit;
  double largest = 0.0;  ///< in `unit`
  std::string where;     ///< "node 17", or ""
};

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

 private:
  std::filesystem::path folder_;
  std::vector<StatsLine> rows_;
  bool is_judged_ = false;
  std::unique_ptr<Session> session_;
};

/// Former paths of parameters count as the present ones.
std::vector<SettingDifference> setting_differences(const RecordedRun& a, const RecordedRun& b);
/// Bodies that both have, by name, in the order of A; fields of which no bit differs are left out.
std::vector<FieldDifference> field_differences(const StepRecord& a, const StepRecord& b);
/// Names that only one of them has.
std::vector<std::string> bodies_of_one(const StepRecord& a, const StepRecord& b);

}  // namespace impinge
