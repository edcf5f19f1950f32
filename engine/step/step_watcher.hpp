// Whoever looks on while a frame is made, sub-step by sub-step. Watching changes nothing.
#pragma once

#include "engine/bodies/bodies.hpp"
#include "engine/step/motion_guard.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

class SolveWatcher;
struct StepRecord;

/// What a motion comes to, in its order. `assembly` to `second_look` are told once groups are solved, which threads do
/// side by side: who wants to see the solves themselves is a SolveWatcher.
enum class StepStage : std::uint8_t {
  free_motion,   ///< v*
  broad_phase,   ///< pairs of bodies
  narrow_phase,  ///< candidates, contacts before reduction
  reduction,     ///< contacts after it
  groups,
  response,     ///< λ and Δv
  second_look,  ///< the same with contacts that only the response led to
  push_out,     ///< velocities are final, recovery from overlap is known
  integration   ///< bodies have moved
};

class StepWatcher {
 public:
  virtual ~StepWatcher() = default;
  /// A stage of a motion is done. What `step` has of later ones is of the motion before.
  virtual void reached(StepStage, const Bodies&, const SubStep& /*step*/) {}
  /// Who looks on while the groups of the motion are solved, none: null.
  virtual SolveWatcher* solve_watcher(const SubStep& /*step*/) { return nullptr; }
  /// A motion begins: contacts are found, nothing has moved since. What `step` refers to belongs to this instant.
  virtual void found(const Bodies&, const SubStep& /*step*/) {}
  /// It is made, and something is struck after `share` of it: it goes back, and one of that length follows.
  virtual void struck(const Bodies&, const SubStep& /*step*/, double /*share*/) {}
  /// It is made and was looked back at. Not kept: the bodies go back to where it began, and a shorter one follows.
  virtual void moved(const Bodies&, const SubStep& /*step*/, MotionGuard& /*guard*/,
                     const std::optional<UnsafeMotion>& /*unsafe*/, bool /*is_kept*/) {}
  /// A sub-step of the frame, from 1 on, is whole.
  virtual void finished(const Bodies&, int /*substep*/) {}
  /// Whether recorded() is wanted after a sub-step: a record costs what the publishing of a frame does.
  virtual bool wants_record(int /*substep*/, int /*substeps*/) const { return false; }
  /// After finished(): the record that the frame would have if it ended here.
  virtual void recorded(Bodies&, const StepRecord& /*so_far*/, int /*substep*/, int /*substeps*/) {}
  /// Whether to look for passages where narrow_phase.continuous = "off" leaves that out.
  virtual bool wants_passages() const { return false; }
};

}  // namespace impinge
