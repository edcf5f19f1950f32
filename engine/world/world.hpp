// The model: bodies, parameters and the step that turns one frame into the next. Knows no view and no files.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "engine/bodies/body_description.hpp"
#include "engine/contact/attachments.hpp"
#include "engine/contact/contact_cache.hpp"
#include "engine/step/motion_guard.hpp"
#include "engine/step/sleeping.hpp"
#include "engine/world/parameters.hpp"
#include "engine/world/snapshot.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

class ByteReader;
class ByteWriter;
struct FrozenStep;
class StepWatcher;

struct Act;
class Ledger;
struct Solving;
enum class StepStage : std::uint8_t;

class World {
 public:
  World();
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Parameters parameters;

  /// Adds a body before start(); it stays where it is for as long as the world lives. Throws InputError (without a
  /// place) where the body can't be made.
  Body& add_body(const BodyDescription& description);
  /// Adds a body behind all others that is in no state and no record until Act::add brings it to life, in the order in
  /// which they were added here; before start() or between frames. What comes before is as it would be without it. Throws
  /// as add_body does.
  Body& add_absent_body(const BodyDescription& description);
  /// Takes away the last body, which is absent.
  void remove_absent_body();
  /// Joins two points after the bodies were added. Throws InputError (without a place) where it can't.
  void add_attachment(const AttachmentDescription& description);
  /// Who asks for them so may change them: none of them is passed over in the frame that follows.
  Bodies& bodies() {
    look_at_all();
    return bodies_;
  }
  const Bodies& bodies() const { return bodies_; }

  /// Declares the rows `body.NAME.*` of the bodies there are. The set refers to this object.
  void bind_bodies(ParameterSet& set);
  void bind_body(ParameterSet& set, Body& body);

  /// Publishes frame 0: detection only, no solve. Throws DivergenceError as step() does.
  void start();
  /// Frame 0 of what restore() brought: detection only. Bodies, what is remembered of contacts, and time go on from there.
  void start_restored();
  /// One frame: [Haapaoja16 §2] in the order of engine/README.md. Throws DivergenceError with frame, group and body,
  /// or with frame, body and column where a figure is not finite; record() then has still the frame before. Throws
  /// Interrupted (core/interrupt.hpp), after which the world stands in the middle of the frame until restore().
  void step();
  /// The same, and hands out the group systems of the frame's last sub-step, the one that its record shows.
  FrozenStep step_and_freeze();
  /// Does something to a body between frames (step/act.hpp).
  void act(const Act& act);
  /// To be called after parameters were changed between frames: sleeping bodies must feel the change.
  void parameters_changed();

  /// Who looks on while step() works, none: null. It must outlive what it watches, or be taken away.
  void watch(StepWatcher* watcher) { watcher_ = watcher; }
  /// Frame 0, which no step made: calls its found().
  void show_start(StepWatcher& watcher) const;
  std::span<const Attachment> attachments() const { return attachments_; }

  int frame() const { return frame_; }
  double time() const { return time_; }
  /// Its state_hash is taken when the record is asked for first.
  const StepRecord& record() const;
  /// The record with the bodies that are still to be added, as they will begin: who writes a file must know all.
  StepRecord record_of_all() const;
  /// 64 bits over poses, velocities, warm-start and sleep data and time.
  std::uint64_t state_hash() const;

  /// The full state, bit for bit; not the parameters.
  void save(ByteWriter& out) const;
  /// Restores what save() wrote for a world with the same bodies and publishes its record; those that were absent then, or
  /// not there yet, are absent now. Throws InputError otherwise.
  void restore(ByteReader& in);

 private:
  void advance(FrozenStep* frozen);
  void substep(double time_step, int left, FrozenStep* frozen);
  void find_at_start();
  void drop_what_never_carries();
  bool may_look_again() const;
  void look_again(Solving& how);
  void make_motion(double time_step, double share, bool freezes);
  void note_unsafe(const UnsafeMotion& motion, int substep, UnsafeBody::Cause cause);
  void take_results(FrozenStep* frozen);
  void tell_finished(int substep);
  void keep_ledger();
  void bring_to_life(BodyIndex index);
  std::vector<std::uint64_t> settings();
  bool is_still() const;
  void look_at_all() { bodies_.activate_all(), was_still_ = false; }
  void let_rest();
  void repeat_still_frame();
  void save_state(ByteWriter& out) const;
  void reached(StepStage stage);
  std::vector<SolvedContact> solved_contacts() const;
  void publish_solved();
  void publish_found();
  void publish(std::span<const SolvedContact> contacts);
  void describe(std::span<const SolvedContact> contacts, FrameStats& stats, StepRecord& record);

  Bodies bodies_;
  std::vector<Attachment> attachments_;
  ContactCache cache_;
  Sleeping sleeping_;
  std::unique_ptr<SubStep> sub_step_;  // the last one
  MotionGuard guard_;
  std::map<BodyIndex, UnsafeBody> unsafe_;  // of the frame being made
  StepWatcher* watcher_ = nullptr;
  std::unique_ptr<Ledger> ledger_;            // null: nobody asked for it
  FrameStats stats_;                          // of the frame being made: sums and maxima over its sub-steps
  std::vector<std::uint64_t> settings_seen_;  // hashes that parameters_changed compares with
  std::map<BodyIndex, std::string> starts_;   // states with which absent bodies come to life
  mutable StepRecord record_;                 // the published one
  StepRecord next_record_;                    // the one of the frame being made
  StateBytes state_, next_state_;             // that their hashes are of
  mutable bool hash_is_due_ = false;
  mutable std::mutex hash_mutex_;
  std::vector<BodyShare> shares_;  // by body: its part of the figures
  bool has_rebounds_ = false;      // whether any two bodies rebound from each other
  bool is_published_ = false;      // the last frame was made to its end
  bool was_still_ = false;         // nothing moved in the last frame, nor was changed since
  int frame_ = 0;
  double time_ = 0.0;
};

}  // namespace impinge
