// Stops a frame in the middle. One pass over the frame lists its stages; from then on any of them is come to by making
// the frame again from its start as far as that: the world then stands there, with everything that belongs to it, until
// it is restored. Nothing is kept of stages but the list, and a frame that is watched comes out bit for bit as any other.
#pragma once

#include "engine/world/stage_record.hpp"

namespace impinge {

/// Thrown out of World::step() where a StageStop has come to its place.
struct StageReached {};

/// Counts places while a frame is made, and hands each on.
class StageWatch : public StepWatcher {
 public:
  explicit StageWatch(const World& world) : world_(world) {}

  void reached(StepStage stage, const Bodies& bodies, const SubStep& step) override;
  SolveWatcher* solve_watcher(const SubStep& step) override;
  void struck(const Bodies& bodies, const SubStep& step, double share) override;
  void moved(const Bodies& bodies, const SubStep& step, MotionGuard& guard, const std::optional<UnsafeMotion>& unsafe,
             bool is_kept) override;

 protected:
  /// The next places, those of one entry. `unsafe`: of a look back, else null.
  virtual void at(StageEntry entry, const SubStep& step, const UnsafeMotion* unsafe) = 0;
  /// Whether the solves of the coming response are to be followed, and which look of them is to be kept; none: each is
  /// only counted.
  virtual bool wants_solves() const = 0;
  virtual std::optional<int> wanted_look() const { return std::nullopt; }

  StageEntry entry(StageKind kind, const SubStep& step) const;
  void end_substep() { ++substep_, piece_ = motion_ = 1; }

  const World& world_;
  SolveTape tape_;
  int substep_ = 1, piece_ = 1, motion_ = 1;
};

class StageList : public StageWatch {
 public:
  explicit StageList(const World& world) : StageWatch(world) {}
  /// Of the frame that was made.
  FrameStages take();
  bool wants_record(int, int) const override { return true; }
  void recorded(Bodies& bodies, const StepRecord& so_far, int substep, int substeps) override;

 protected:
  void at(StageEntry entry, const SubStep& step, const UnsafeMotion* unsafe) override;
  bool wants_solves() const override { return true; }

 private:
  FrameStages stages_;
};

class StageStop : public StageWatch {
 public:
  /// The frame's list, and the place to stop at; the end of its last sub-step is no stop. Both must outlive this.
  StageStop(const World& world, const FrameStages& stages, int place);
  const StepRecord& record() const { return record_; }
  void finished(const Bodies& bodies, int substep) override;
  bool wants_record(int substep, int substeps) const override;
  void recorded(Bodies& bodies, const StepRecord& so_far, int substep, int substeps) override;

 protected:
  void at(StageEntry entry, const SubStep& step, const UnsafeMotion* unsafe) override;
  bool wants_solves() const override;
  std::optional<int> wanted_look() const override;

 private:
  const FrameStages& stages_;
  std::size_t stop_;  // entry
  int within_;        // it
  std::size_t next_ = 0;
  StepRecord record_;
};

}  // namespace impinge
