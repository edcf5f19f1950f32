// A frame that is stopped in the middle, at any of its stages, and made once more comes out as if nobody had looked: in
// random heaps of rigid and deformable bodies, by every response.
#include "engine/world/stage_watch.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/response_worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void fill(World& world, std::string_view response, std::uint64_t seed) {
  Random random(seed);
  world.parameters.response.method = response;
  world.parameters.simulation.substeps = 1 + random.below(3);
  world.parameters.contact.friction = random.below(3) == 0 ? 0.0 : random.in(0.1, 0.9);
  if (random.below(3) == 0) world.parameters.contact.restitution = 0.6;
  world.add_body(fixed_plane("floor", {0.1 * random.sym(), 1.0, 0.1 * random.sym()}, 0.0));
  const SharedShape shapes[] = {Sphere{0.1}, Box{{0.1, 0.08, 0.12}}, Capsule{0.06, 0.1}, surface(box({0.1, 0.1, 0.1})),
                                surface(scaled_to(bumpy_sphere(1), 0.2))};
  const int bodies = 2 + random.below(4);
  for (int i = 0; i < bodies; ++i) {
    BodyDescription body = dynamic_body("b" + std::to_string(i), shapes[random.below(5)],
                                        {0.15 * random.sym(), 0.12 + 0.17 * i, 0.15 * random.sym()});
    body.velocity = 3.0 * random.vector();
    if (random.below(8) == 0) body.velocity = 80.0 * random.vector();
    body.angular_velocity = 4.0 * random.vector();
    world.add_body(body);
  }
  if (random.below(2) == 0) {
    BodyDescription soft = soft_cube("soft", 0.2, 1 + random.below(2), {-0.1, 0.2 + 0.17 * bodies, -0.1});
    soft.velocity = {random.sym(), -3.0, random.sym()};
    world.add_body(soft);
  }
  world.start();
}

std::string saved(const World& world) {
  ByteWriter out;
  world.save(out);
  return out.bytes();
}
void restore(World& world, const std::string& state) {
  ByteReader in(state);
  world.restore(in);
}

FrameStages list_of(World& world) {
  StageList list(world);
  world.watch(&list);
  world.step();
  world.watch(nullptr);
  return list.take();
}

/// The record there; the world stands there.
StepRecord stop_at(World& world, const FrameStages& stages, int place) {
  StageStop stop(world, stages, place);
  world.watch(&stop);
  CHECK_THROWS_AS(world.step(), StageReached);
  world.watch(nullptr);
  return stop.record();
}

}  // namespace

TEST_CASE("a frame stopped at its stages ends as if nobody had looked, 200 random scenes, every response") {
  std::vector<std::string> names;
  for (const auto& entry : responses()) names.emplace_back(entry.name);
  REQUIRE(names.size() >= 6);
  std::set<StageKind> met;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::string& response = names[seed % names.size()];
    World world;
    fill(world, response, 1000 + seed);
    Random random(seed);
    for (int frame = random.below(14); frame > 0; --frame) world.step();
    const std::string start = saved(world);
    world.step();
    const std::uint64_t plain = world.state_hash();
    CAPTURE(seed, response, world.frame());

    restore(world, start);
    const FrameStages stages = list_of(world);
    REQUIRE(world.state_hash() == plain);
    REQUIRE(stages.substeps == world.parameters.simulation.substeps);
    REQUIRE(stages.frame == world.frame());
    for (const StageEntry& entry : stages.entries) met.insert(entry.kind);

    // the last place is the end of the frame, before it is published
    std::set<int> places = {0, stages.places() - 1};
    while (places.size() < std::min<std::size_t>(6, static_cast<std::size_t>(stages.places())))
      places.insert(random.below(stages.places()));
    for (const int place : places) {
      restore(world, start);
      const StepRecord record = stop_at(world, stages, place);
      CAPTURE(place, stages.words(place));
      CHECK(record.bodies.size() == static_cast<std::size_t>(world.bodies().size().value()));
      CHECK(record.stats.frame == stages.frame);
      if (place == stages.places() - 1) CHECK(world.state_hash() == plain);
      restore(world, start);
      world.step();
      REQUIRE(world.state_hash() == plain);
    }
  }
  // scenes that cover less would prove less
  for (const StageKind kind :
       {StageKind::free_motion, StageKind::broad_phase, StageKind::narrow_phase, StageKind::reduction,
        StageKind::groups, StageKind::assembly, StageKind::iteration, StageKind::response, StageKind::push_out,
        StageKind::integration, StageKind::impact, StageKind::look_back, StageKind::end})
    CHECK(met.contains(kind));
}

TEST_CASE("what a stage shows is what the step made of it") {
  for (const auto& entry : responses()) {
    World world;
    world.parameters.response.method = entry.name;
    world.parameters.simulation.substeps = 1;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    BodyDescription crate = cube("crate", 0.2, {0, 0.1, 0});
    crate.velocity = {1.0, -0.5, 0};
    world.add_body(crate);
    world.add_body(cube("lid", 0.1, {0, 0.25, 0}));
    world.start();
    const std::string start = saved(world);
    const FrameStages stages = list_of(world);
    StepRecord end;
    end.contacts = world.record().contacts;
    end.broad_pairs = world.record().broad_pairs;
    const double end_height = world.record().bodies[1].pose.position.y();
    CAPTURE(entry.name);
    const auto at = [&](StageKind kind, int within = 0) {
      int place = 0;
      for (const StageEntry& e : stages.entries) {
        if (e.kind == kind) {
          restore(world, start);
          return stop_at(world, stages, place + within);
        }
        place += e.count;
      }
      FAIL("no such stage");
      return StepRecord();
    };
    const double dt = world.parameters.simulation.time_step(), g = 9.81;

    const StepRecord free = at(StageKind::free_motion);
    CHECK(free.bodies[1].velocity.y() == Approx(-0.5 - g * dt));  // v* by hand
    CHECK(free.bodies[1].pose.position.y() == Approx(0.1));
    CHECK(free.contacts.empty());
    CHECK(free.broad_pairs.empty());

    const StepRecord broad = at(StageKind::broad_phase);
    CHECK(broad.broad_pairs == end.broad_pairs);
    CHECK(broad.contacts.empty());
    CHECK(broad.bodies[1].bounds.max.x() >= 0.1 + dt * 1.0);  // swept
    CHECK(free.bodies[1].bounds.max.x() == Approx(0.1));

    const StepRecord narrow = at(StageKind::narrow_phase), reduced = at(StageKind::reduction);
    CHECK(narrow.contacts.size() >= reduced.contacts.size());
    CHECK(reduced.contacts.size() >= 4);
    for (const ContactRecord& c : narrow.contacts) CHECK(c.lambda.isZero(0.0));
    CHECK(reduced.groups.empty());

    const StepRecord groups = at(StageKind::groups);
    REQUIRE(groups.groups.size() == 1);
    CHECK(groups.groups[0].size() == 2);

    const StepRecord solved = at(StageKind::response);
    CHECK(solved.bodies[1].pose.position.y() == Approx(0.1));  // nothing has moved
    const StepRecord moved = at(StageKind::integration);
    CHECK(moved.bodies[1].pose.position.y() == end_height);
    // a stage after the response has the impulses that are published
    REQUIRE(moved.contacts.size() == end.contacts.size());
    for (std::size_t i = 0; i < end.contacts.size(); ++i) {
      CHECK(moved.contacts[i].lambda == end.contacts[i].lambda);
      CHECK(moved.contacts[i].pair_id == end.contacts[i].pair_id);
    }
    // impulses of the first solve: they hold up what falls
    double sum = 0.0;
    for (const ContactRecord& c : solved.contacts)
      if (c.body_a == BodyIndex(0) || c.body_b == BodyIndex(0)) sum += c.lambda.x() * std::abs(c.normal.y());
    CHECK(sum > 0.0);

    const auto iterations = std::find_if(stages.entries.begin(), stages.entries.end(),
                                         [](const StageEntry& e) { return e.kind == StageKind::iteration; });
    if (iterations == stages.entries.end()) continue;
    double first_residual = 0.0, last_residual = 0.0;
    for (const int within : {0, iterations->count - 1}) {
      const StepRecord look = at(StageKind::iteration, within);
      CHECK(look.contacts.size() == reduced.contacts.size());
      (within == 0 ? first_residual : last_residual) = look.stats.residual_coulomb;
    }
    if (!regularised(entry.name)) CHECK(last_residual <= first_residual * (1.0 + 1e-9));
  }
}

TEST_CASE("a sub-step that is undone and cut shows its attempts") {
  World world;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.gravity.setZero();
  const Vec3 half(0.005, 0.005, 0.2), at(-0.1, 0.4, 0.0);
  BodyDescription post = dynamic_body("post", surface(box(half)), at);
  post.kind = BodyKind::fixed;
  world.add_body(post);
  BodyDescription rod = dynamic_body("rod", surface(box({0.5, 0.01, 0.01})), {0, 0, 0});
  rod.angular_velocity = {0, 0, 300.0};  // most of a turn in the sub-step
  world.add_body(rod);
  world.add_attachment({"axle", "rod", "", Vec3::Zero()});  // alone the two would meet in flight
  world.start();
  FrameStages stages;
  bool cut = false;
  for (int frame = 0; frame < 3 && !cut; ++frame) {
    const std::string start = saved(world);
    stages = list_of(world);
    for (const StageEntry& entry : stages.entries) cut |= entry.motion > 1;
    if (!cut) continue;
    int place = 0;
    for (const StageEntry& entry : stages.entries) {
      if (entry.kind == StageKind::look_back && entry.words.find("goes back") != std::string::npos) break;
      place += entry.count;
    }
    restore(world, start);
    const StepRecord met = stop_at(world, stages, place);
    REQUIRE_FALSE(met.contacts.empty());  // where they meet: on the post
    for (const ContactRecord& c : met.contacts) {
      const Vec3 on_post = (c.body_a == BodyIndex(0) ? c.point_a : c.point_b) - at;
      CHECK((on_post.cwiseAbs() - half).maxCoeff() == Approx(0.0).margin(1e-9));
    }
    CHECK(stages.words(place).find("attempt 1") != std::string::npos);
  }
  CHECK(cut);
}
