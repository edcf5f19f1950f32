// What the outliner's tabs are made of: a table each, of the bodies, the collision groups and the pairs of bodies.
#pragma once

#include "viewer/panels/debug/table.hpp"

namespace impinge {

/// As commands name them, in the order in which they stand.
const std::vector<std::string>& outliner_tabs();

TableRows body_rows(Ui& ui, const DebugModel& model, CommandLines& lines);
TableRows group_rows(const DebugModel& model);
TableRows pair_rows(const DebugModel& model);

/// Whether a name is to be listed: it holds what is searched for.
bool is_sought(const DebugModel& model, std::string_view name);
std::string name_of(const DebugModel& model, BodyIndex body);
/// Bodies that the selection means: the one, or a contact's two.
std::vector<BodyIndex> selected_bodies(const DebugModel& model);
/// ", asleep since frame 12", or "" of one that is awake.
std::string sleep_words(const DebugModel& model, BodyIndex body);
/// Seconds of a sub-step, 0 of a frame without.
double substep_time(const StepRecord& record);

}  // namespace impinge
