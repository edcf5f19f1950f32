// Several who look on, each as if alone.
#pragma once

#include <vector>

#include "engine/step/step_watcher.hpp"

namespace impinge {

class WatcherList : public StepWatcher {
 public:
  /// In this order. They must outlive the list.
  void add(StepWatcher* watcher) { all_.push_back(watcher); }
  bool empty() const { return all_.empty(); }

  void reached(StepStage stage, const Bodies& bodies, const SubStep& step) override {
    for (StepWatcher* w : all_) w->reached(stage, bodies, step);
  }
  /// The first that wants to be one.
  SolveWatcher* solve_watcher(const SubStep& step) override {
    for (StepWatcher* w : all_)
      if (SolveWatcher* watcher = w->solve_watcher(step)) return watcher;
    return nullptr;
  }
  void found(const Bodies& bodies, const SubStep& step) override {
    for (StepWatcher* w : all_) w->found(bodies, step);
  }
  void struck(const Bodies& bodies, const SubStep& step, double share) override {
    for (StepWatcher* w : all_) w->struck(bodies, step, share);
  }
  void moved(const Bodies& bodies, const SubStep& step, MotionGuard& guard, const std::optional<UnsafeMotion>& unsafe,
             bool is_kept) override {
    for (StepWatcher* w : all_) w->moved(bodies, step, guard, unsafe, is_kept);
  }
  void finished(const Bodies& bodies, int substep) override {
    for (StepWatcher* w : all_) w->finished(bodies, substep);
  }
  bool wants_record(int substep, int substeps) const override {
    for (const StepWatcher* w : all_)
      if (w->wants_record(substep, substeps)) return true;
    return false;
  }
  void recorded(Bodies& bodies, const StepRecord& so_far, int substep, int substeps) override {
    for (StepWatcher* w : all_)
      if (w->wants_record(substep, substeps)) w->recorded(bodies, so_far, substep, substeps);
  }
  bool wants_passages() const override {
    for (const StepWatcher* w : all_)
      if (w->wants_passages()) return true;
    return false;
  }

 private:
  std::vector<StepWatcher*> all_;
};

}  // namespace impinge
