// What a stage of a motion had, as a record: each field holds what the stage made of it, and nothing of later ones. Bodies
// are shown where they are at that moment, so layers and tables show a stage as they show a frame.
#pragma once

#include "engine/step/step_watcher.hpp"
#include "engine/world/solve_tape.hpp"
#include "engine/world/stage_place.hpp"

namespace impinge {

class World;

/// `tape`: of the groups' solves where the stage is assembly or one of their iterations; else not asked.
StepRecord stage_record(const World& world, const SubStep& step, const StageEntry& entry, const SolveTape& tape);

/// Puts meetings of surfaces in the place of contacts: both points where the motion began, the gap between them.
void show_passages(const UnsafeMotion& motion, StepRecord& record);

/// What came of a stage, in words, for its entry.
std::string stage_words(const World& world, const SubStep& step, StageKind kind, const SolveTape& tape);

}  // namespace impinge
