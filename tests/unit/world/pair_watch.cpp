// What is said of a pair of bodies against what the frame's record shows, pair by pair, in a heap of all kinds of them.
#include "engine/world/pair_watch.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <memory>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Hands on to many.
class Watches : public StepWatcher {
 public:
  Watches(const World& world, int frame) {
    for (BodyIndex a(0); a < world.bodies().size(); ++a)
      for (BodyIndex b(a); b < world.bodies().size(); ++b)
        list.push_back(std::make_unique<PairWatch>(world, b, a, PairWatch::Asked{frame, {}}));
  }
  void found(const Bodies& bodies, const SubStep& step) override {
    for (const auto& watch : list) watch->found(bodies, step);
  }
  void moved(const Bodies& bodies, const SubStep& step, MotionGuard& guard, const std::optional<UnsafeMotion>& unsafe,
             bool is_kept) override {
    for (const auto& watch : list) watch->moved(bodies, step, guard, unsafe, is_kept);
  }
  void finished(const Bodies& bodies, int substep) override {
    for (const auto& watch : list) watch->finished(bodies, substep);
  }
  std::vector<std::unique_ptr<PairWatch>> list;
};

void fill(World& world) {
  Random random(77);
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  BodyDescription shelf = dynamic_body("shelf", Box{{0.3, 0.02, 0.3}}, {0, 0.4, 0});
  shelf.kind = BodyKind::fixed;
  world.add_body(shelf);
  const SharedShape shapes[] = {Sphere{0.1}, Box{{0.1, 0.08, 0.12}}, Capsule{0.06, 0.1}, surface(box({0.1, 0.1, 0.1})),
                                surface(scaled_to(bumpy_sphere(1), 0.2))};
  int number = 0;
  for (const SharedShape& shape : shapes) {
    BodyDescription body = dynamic_body("b" + std::to_string(number), shape,
                                        {0.12 * random.sym(), 0.7 + 0.25 * number, 0.12 * random.sym()});
    ++number;
    body.velocity = {0, -2.0, 0};
    world.add_body(body);
  }
  BodyDescription soft = soft_cube("soft", 0.2, 2, {-0.1, 2.0, -0.1});
  soft.self_collision = true;
  soft.velocity = {0, -3.0, 0};
  world.add_body(soft);
  world.parameters.simulation.substeps = 1;
  world.start();
}

}  // namespace

TEST_CASE("a pair has the contacts that the record shows, and one filter that stops it if there are none") {
  World world, unwatched;
  fill(world), fill(unwatched);
  std::map<std::string, int> stopped;
  int touching = 0;
  for (int frame = 1; frame <= 70; ++frame) {
    Watches watches(world, frame);
    world.watch(&watches);
    world.step();
    unwatched.step();
    REQUIRE(world.state_hash() == unwatched.state_hash());
    for (const auto& watch : watches.list) {
      REQUIRE(watch->verdict());
      const PairVerdict& v = *watch->verdict();
      CAPTURE(frame, v.name_a, v.name_b, v.nearest ? v.nearest->distance : 0.0, box_gap(v.box_a, v.box_b),
              box_gap(v.swept_a, v.swept_b));
      std::size_t shown = 0;
      for (const ContactRecord& c : world.record().contacts) shown += c.body_a == v.a && c.body_b == v.b ? 1 : 0;
      CHECK(v.contacts.size() == shown);
      CHECK(v.frame == frame);
      CHECK(v.substep == 1);
      if (v.in_contact()) {
        ++touching;
        CHECK(v.find("contacts")->outcome == FilterVerdict::passes);
        CHECK(v.find("response")->outcome == FilterVerdict::passes);
        CHECK(watch->first_contact());
      } else {
        REQUIRE(v.stopped_by() != nullptr);
        ++stopped[std::string(v.stopped_by()->filter)];
        if (v.pieces == 1) CHECK(!watch->first_contact());  // else it may have had one in a piece before the last
        // whoever is nearer than the activation distance is no victim of the boxes
        if (v.nearest &&
            v.nearest->distance <= activation_between(world.parameters, world.bodies()[v.a], world.bodies()[v.b]))
          CHECK(v.stopped_by()->filter != "boxes");
      }
    }
  }
  CHECK(touching > 100);
  CHECK(stopped["kind"] > 100);  // floor and shelf, rigid bodies with themselves
  CHECK(stopped["boxes"] > 100);
  CHECK(stopped["distance"] + stopped["candidates"] > 10);
}
