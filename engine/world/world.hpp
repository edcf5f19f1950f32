// The model: bodies, parameters and the step that turns one frame into the next. Knows no view and no files.
#pragma once

#include <memory>

#include "engine/world/attachments.hpp"
#include "engine/world/parameters.hpp"
#include "engine/world/step_record.hpp"

namespace impinge {

class ByteReader;
struct CollisionGroup;
struct FrozenStep;
struct GroupSystem;
class ByteWriter;

class World {
 public:
  World();
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Parameters parameters;

  /// Adds a body before start(). Throws InputError (without a place) where the body can't be made.
  RigidBody& add_body(const BodyDescription& description);
  /// Joins two points after the bodies were added. Throws InputError (without a place) where it can't.
  void add_attachment(const AttachmentDescription& description);
  std::vector<RigidBody>& bodies() { return bodies_; }
  const std::vector<RigidBody>& bodies() const { return bodies_; }
  const BodyNames& body_names() const { return names_; }

  /// Declares the rows `body.NAME.*` of the bodies there are. The set refers to this object.
  void bind_bodies(ParameterSet& set);

  /// Publishes frame 0: detection only, no solve. Throws DivergenceError as step() does.
  void start();
  /// One frame: [Haapaoja16 §2] in the order of engine/README.md. Throws DivergenceError with frame, group and body,
  /// or with frame, body and column where a figure is not finite; record() then has still the frame before. Throws
  /// Interrupted (core/interrupt.hpp), after which the world stands in the middle of the frame until restore().
  void step();
  /// The same, and hands out the group systems of the frame's last sub-step, the one that its record shows.
  FrozenStep step_and_freeze();
  /// To be called after parameters were changed between frames: sleeping bodies must feel the change.
  void parameters_changed();

  int frame() const { return frame_; }
  double time() const { return time_; }
  const StepRecord& record() const { return record_; }
  /// 64 bits over poses, velocities, warm-start and sleep data and time.
  std::uint64_t state_hash() const;

  /// The full state, bit for bit; not the parameters.
  void save(ByteWriter& out) const;
  /// Restores what save() wrote for a world with the same bodies and publishes its record. Throws InputError otherwise.
  void restore(ByteReader& in);

 private:
  struct Stages;  // the algorithms in use and their working memory
  void bind_soft_body(ParameterSet& set, int body, const std::string& path);
  void substep(double time_step, int left);
  void free_velocity(int body, double time_step);
  GroupSystem solve_group(CollisionGroup& group, double time_step);
  void push_out(const GroupSystem& solved, const CollisionGroup& group, double time_step);
  void take_group(const GroupSystem& system, int group);
  void integrate(double time_step);
  void detect(double time_step);
  void save_state(ByteWriter& out) const;
  void publish(bool solved);

  std::vector<RigidBody> bodies_;
  BodyNames names_;
  std::vector<Attachment> attachments_;
  std::unique_ptr<Stages> stages_;
  StepRecord record_;
  int frame_ = 0;
  double time_ = 0.0;
};

}  // namespace impinge
