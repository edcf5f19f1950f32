// Follows two bodies through a run: what became of the pair at one moment that was asked for, when they first had a
// contact, and how near they came if they never had one.
#pragma once

#include <map>

#include "engine/world/pair_verdict.hpp"

namespace impinge {

class PairWatch : public StepWatcher {
 public:
  struct Moment {
    int frame = 0, substep = 0;  ///< substep from 1; 0: frame 0
  };
  struct Asked {
    int frame = 0;
    std::optional<int> substep;  ///< none: the last one of the frame
  };
  /// The pair as given, in any order. `asked`: none: the moment that tells most.
  PairWatch(const World& world, BodyIndex first, BodyIndex second, std::optional<Asked> asked);

  /// Frame 0, once the world shows it.
  void look_at_start();
  void found(const Bodies& bodies, const SubStep& step) override;
  void moved(const Bodies& bodies, const SubStep& step, MotionGuard& guard, const std::optional<UnsafeMotion>& unsafe,
             bool is_kept) override;
  void finished(const Bodies& bodies, int substep) override;

  /// Of the moment asked for; where none was, of the first contact, or of the nearest miss. None: not come to yet.
  const std::optional<PairVerdict>& verdict() const { return asked_ ? at_asked_ : telling_; }
  std::optional<Moment> first_contact() const { return first_contact_; }
  std::optional<Moment> last_contact() const { return last_contact_; }
  /// Sub-steps with contacts (and frame 0, if it has some).
  int contacts() const { return contacts_; }
  /// Sub-steps in which one may have passed the other: it did and was let go, or nobody looked; and the first of them.
  int unsafe_motions() const { return unsafe_motions_; }
  std::optional<Moment> first_unsafe() const { return first_unsafe_; }
  /// Where the two were nearest, of sub-steps without contacts up to the first that has one; distance in metres.
  std::optional<Moment> nearest_miss() const { return nearest_; }
  double nearest_distance() const { return nearest_distance_; }

 private:
  bool is_asked_for(int frame) const { return asked_ && asked_->frame == frame; }
  void take(int substep);

  const World& world_;
  BodyIndex a_, b_;
  std::optional<Asked> asked_;
  NearestSearch search_;
  std::optional<PairVerdict> now_, kept_;          // of the motion; of the sub-step's last
  std::optional<PairVerdict> touching_, pushing_;  // of its first with a contact, and its last with an impulse
  std::map<std::uint64_t, Collision> pushed_;      // by feature: contacts that pushed in any piece
  std::optional<PairVerdict> at_asked_, telling_;
  PairVerdict::Undone undone_;                          // of the sub-step
  bool has_contact_now_ = false, has_contact_ = false;  // of the motion, of a kept one of the sub-step
  bool is_unsafe_ = false;                              // a kept motion of the sub-step
  int pieces_ = 0, contacts_ = 0, unsafe_motions_ = 0;
  std::optional<Moment> first_contact_, last_contact_, first_unsafe_, nearest_;
  double nearest_distance_ = INFINITY;
};

}  // namespace impinge
