// `break when CONDITION`: looked at after each sub-step of a frame, and told at the one with which it becomes true. What
// held of which sub-step is kept, a bit each, so that a frame that is come by again stops where it did.
#pragma once

#include <map>
#include <optional>

#include "engine/step/step_watcher.hpp"
#include "viewer/controller/condition_values.hpp"

namespace impinge {

struct Breakpoint {
  Expression condition;
  std::string place;  ///< "file:line:column"
  int hits = 0;
  std::map<int, std::vector<bool>> held = {};  ///< by frame, by sub-step; of frame 0 one
  /// When it was set: looked at there for the first time. Sub-step 0: at the end of the frame.
  struct Look {
    int frame = 0, substep = 0;
    bool held = false;
  };
  std::optional<Look> first = {};
};

/// Of a sub-step of a frame at which a breakpoint became true.
struct BreakHit {
  int substep = 1, substeps = 1;
  std::size_t point = 0;
  std::vector<double> values;  ///< of its condition; empty: not looked at just now
  bool is_end() const { return substep == substeps; }
};

/// Looks on while a frame is made. The last sub-step is left to end(), when all figures of the frame are known.
class Breakpoints : public StepWatcher {
 public:
  /// `judged`: the figures have those of --judge, which are known at the end of a frame and not a number before.
  explicit Breakpoints(bool judged) : judged_(judged) {}

  void add(Expression condition, std::string place) { points_.push_back({std::move(condition), std::move(place)}); }
  /// The bodies that they may speak of have changed places.
  void read_again(const ExpressionWords& words);
  void clear() { points_.clear(), forget_begun(); }
  bool empty() const { return points_.empty(); }
  const std::vector<Breakpoint>& points() const { return points_; }

  bool wants_record(int substep, int substeps) const override { return !points_.empty() && substep < substeps; }
  void recorded(Bodies& bodies, const StepRecord& so_far, int substep, int substeps) override;
  /// The frame is made; frame 0 has nothing but this.
  void end(int frame, std::span<const double> figures, const StepRecord& record, Bodies& bodies);
  /// A frame that was begun was not finished.
  void forget_begun() { begun_.clear(), values_.clear(); }
  /// Looks at the point added last, where it was set; sub-step 0: at the end of the frame. Nothing if it doesn't hold.
  std::optional<BreakHit> look_at_last(int frame, int substep, const std::vector<double>& values);

  /// Whether each has been looked at in the frame.
  bool know(int frame) const;
  /// The first sub-step of the frame, after `after` (0: any), with which one becomes true.
  std::optional<BreakHit> next(int frame, int after) const;
  /// Counts it, and says so: "break.script:1:1: frame 3: stopped by break when contacts > 0; contacts = 2".
  std::string tell(int frame, const BreakHit& hit);
  /// The frame and those after it will be others.
  void cut(int frame);
  /// Nobody comes by earlier frames again.
  void forget_before(int frame);

 private:
  bool held(const Breakpoint& point, int frame, int substep) const;

  bool judged_;
  ConditionReader reader_;
  std::vector<Breakpoint> points_;
  std::vector<std::vector<bool>> begun_;                               // by sub-step of the frame being made, by point
  std::map<std::pair<int, std::size_t>, std::vector<double>> values_;  // by sub-step and point, of the frame made last
  int values_frame_ = -1;
};

}  // namespace impinge
