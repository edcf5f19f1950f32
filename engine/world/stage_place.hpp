// Places within a frame: every stage of every motion of its sub-steps, in the order in which they are made.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/step_record.hpp"

namespace impinge {

enum class StageKind : std::uint8_t {
  free_motion,
  broad_phase,
  narrow_phase,
  reduction,
  groups,
  assembly,
  iteration,
  response,
  second_look,
  push_out,
  integration,
  impact,     ///< something is struck: the motion goes back and is made as far as that
  look_back,  ///< whether surfaces have passed one another
  end         ///< of a sub-step
};
std::string_view name_of(StageKind kind);

struct StageEntry {
  StageKind kind = StageKind::free_motion;
  int substep = 1, piece = 1, motion = 1;  ///< from 1; the motions tried for a piece of a sub-step
  int count = 1;                           ///< places that it has: of iterations one each
  int first_iteration = 0;                 ///< 0: before the first
  double time = 0.0, time_step = 0.0;      ///< s, of the motion: its start and length
  std::string words;                       ///< what came of it
};

/// The stages of one frame; a place is counted from 0 through the places of all entries.
struct FrameStages {
  int frame = 0, substeps = 0;
  std::vector<StageEntry> entries;
  std::vector<FrameStats> figures;  ///< by sub-step, as if the frame ended with it

  int places() const;
  /// The entry that a place is in, and the place of its first.
  std::pair<std::size_t, int> entry_at(int place) const;
  /// Where the sub-step, from 1 on, has ended.
  int end_of(int substep) const;
  /// The sub-step that has ended there or before it; 0: none.
  int ended_at(int place) const;
  /// "sub-step 2 of 4, response iteration 12 of 40", with the piece and the attempt where there are several.
  std::string words(int place) const;
};

}  // namespace impinge
