// What bodies and pairs of bodies did in the frames that were seen, so that a figure of any of them can be plotted, and
// where they were be drawn.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/step_record.hpp"
#include "viewer/state/body_figures.hpp"

namespace impinge {

/// A number of a body or a pair: "speed(ball)", "gap(crate,ball)"; or of the ledger: "energy_from(friction)" of all
/// bodies, "energy_from(friction,crate)" of one.
struct Quantity {
  BodyFunction what = BodyFunction::speed;
  BodyIndex a, b;  ///< b none: of a alone; a none: of all
  LedgerSource source = LedgerSource::gravity;
  std::string_view unit() const { return info_of(what).unit; }
};
/// None if the text is none of a body that there is.
std::optional<Quantity> parse_quantity(std::string_view text, const std::vector<std::string>& bodies);

class Tracks {
 public:
  /// `keeps_surfaces`: also where the vertices of deformable bodies were.
  explicit Tracks(bool keeps_surfaces = false) : keeps_surfaces_(keeps_surfaces) {}

  /// Takes what the record's frame had. The oldest frames go where there are too many.
  void note(const StepRecord& record);
  void forget_after(int frame);
  /// NaN where the frame wasn't seen, or has no such thing.
  double value(int frame, const Quantity& quantity) const;
  /// Where a body's frame was; none where that wasn't seen.
  std::optional<Pose> pose(int frame, BodyIndex body) const;
  /// Null where it wasn't seen, or no books were kept.
  const FrameLedger* ledger(int frame) const;
  /// The books of all frames up to that one that have some, and of how many.
  struct LedgerSum {
    FrameLedger books;
    int frames = 0, last = -1;
  };
  const LedgerSum& ledger_sum(int frame) const;
  /// From which frame on a body that sleeps in this one has slept, as far back as frames were seen without a gap.
  int asleep_since(int frame, BodyIndex body) const;
  /// Of a deformable body, in the world; empty where that was not seen or kept.
  std::vector<Vec3> surface(int frame, BodyIndex body) const;
  int first() const { return frames_.empty() ? 0 : frames_.begin()->first; }

 private:
  struct OfBody {
    Pose pose;
    Vec3 velocity = Vec3::Zero();
    bool is_there = true;  // not deleted
    bool asleep = false;
    std::vector<Eigen::Vector3f> surface;  // from the pose's position, where surfaces are kept
  };
  struct Touch {  // of a body, or of a pair
    int contacts = 0;
    double gap = 0.0, impulse = 0.0;
    void take(const ContactRecord& contact);
  };
  struct Frame {
    double substep_time = 0.0;
    std::vector<OfBody> bodies;  // but for those that were added later
    std::shared_ptr<const FrameLedger> ledger;
    std::map<BodyIndex, Touch> touched;
    std::map<std::pair<BodyIndex, BodyIndex>, Touch> pairs;
    bool has(BodyIndex body) const {
      const auto i = static_cast<std::size_t>(body.value());
      return i < bodies.size() && bodies[i].is_there;
    }
    std::size_t bytes() const;
  };

  bool keeps_surfaces_;
  std::map<int, Frame> frames_;
  std::size_t bytes_ = 0;
  mutable LedgerSum sum_;  // of the frame asked for last: the next one is soon found from it
};

}  // namespace impinge
