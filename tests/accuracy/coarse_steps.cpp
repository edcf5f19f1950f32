// Rings and plates that fall through one another's middle at sub-steps in which they go as far as they are large: each is cut
// into many pieces. What a piece tries that is cut again is lost: searched, solved and looked back at for nothing.
#include <catch2/catch.hpp>

#include <cmath>

#include "engine/step/step_watcher.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// How long motions were that were taken back, over those that were kept.
class LostTime : public StepWatcher {
 public:
  double lost = 0.0, kept = 0.0;  // s
  int pieces = 0;
  void moved(const Bodies&, const SubStep& step, MotionGuard&, const std::optional<UnsafeMotion>&,
             bool is_kept) override {
    (is_kept ? kept : lost) += step.time_step;
    pieces += is_kept ? 1 : 0;
  }
};

}  // namespace

TEST_CASE("motions that are taken back are short once a sub-step has been cut") {
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.frame_time = 0.1;
  world.parameters.contact.friction = 0.3;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  const MeshPointer ring = surface(torus(0.4, 0.1, 16, 8)), plate = make_box_mesh(Vec3(0.5, 0.015, 0.4));
  Random random(5);
  for (int i = 0; i < 10; ++i) {
    BodyDescription d = dynamic_body("body" + std::to_string(i), i % 2 == 0 ? SharedShape(ring) : SharedShape(plate),
                                     Vec3(random.in(-0.2, 0.2), 0.8 + 1.3 * i, random.in(-0.2, 0.2)));
    d.rotation = 90.0 * random.vector();
    d.angular_velocity = 2.0 * random.vector();
    world.add_body(d);
  }
  world.start();
  LostTime time;
  world.watch(&time);
  std::int64_t unsafe = 0;
  for (int frame = 0; frame < 20; ++frame) {
    world.step();
    unsafe += world.record().stats.unsafe_motions;
  }
  world.watch(nullptr);
  CAPTURE(time.pieces, time.lost / time.kept, unsafe);
  CHECK(time.kept == Approx(20 * 0.1));
  CHECK(time.pieces > 30);
  CHECK(time.lost < 4.0 * time.kept);
  CHECK(unsafe == 0);
}
