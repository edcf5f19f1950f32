// Two recorded runs side by side: what was set differently, the first frame whose states differ, and in what.
//
// Where they part is read from the state hashes of both stats.csv. In what they part is found by making that frame
// again: each run is continued from its nearest snapshot, ten frames at most, and the frame counts only if its hash is
// the recorded one. So no exported surface is needed and what is compared is the whole state, bit by bit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/io/scene/run_record.hpp"
#include "viewer/controller/recorded_run.hpp"
#include "viewer/state/state_differences.hpp"

namespace impinge {

/// Former paths of parameters count as the present ones.
std::vector<SettingDifference> setting_differences(const RecordedRun& a, const RecordedRun& b);
/// Names that only one of them has.
std::vector<std::string> bodies_of_one(const StepRecord& a, const StepRecord& b);

}  // namespace impinge
