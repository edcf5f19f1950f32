// Bodies that come to life between frames, held against worlds that have them from the start, or never.
#include <catch2/catch.hpp>

#include "engine/step/act.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/state_hashes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

Act addition(const std::string& body) {
  Act act;
  act.verb = Act::add;
  act.body = body;
  return act;
}

void add_those_there(World& world) {
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(cube("low", 0.3, Vec3(0, 0.15, 0)));
  world.add_body(soft_cube("soft", 0.3, 2, Vec3(0.6, 0.02, 0)));
}

/// Onto the low cube, and onto the soft one.
std::vector<BodyDescription> newcomers() {
  BodyDescription rigid = cube("rigid_2", 0.2, Vec3(0.02, 0.45, 0.01)),
                  soft = soft_cube("soft_2", 0.2, 2, Vec3(0.62, 0.4, 0));
  rigid.velocity = Vec3(0, -1, 0.2);
  rigid.rotation = Vec3(5, 10, 15);
  soft.velocity = Vec3(0, -0.5, 0);
  return {rigid, soft};
}

std::vector<std::uint64_t> hashes_of(World& world, int frames) {
  std::vector<std::uint64_t> list = {world.record().stats.state_hash};
  for (int k = 0; k < frames; ++k) world.step(), list.push_back(world.record().stats.state_hash);
  return list;
}

}  // namespace

TEST_CASE("a body that is added at frame 0 makes the states of a world that ends with it, by every response",
          "[methods]") {
  for (const auto& response : responses()) {
    CAPTURE(response.name);
    World with, added;
    for (World* world : {&with, &added}) {
      add_those_there(*world);
      world->parameters.response.method = response.name;
      world->parameters.simulation.substeps = 2;
    }
    for (const BodyDescription& d : newcomers()) with.add_body(d), added.add_absent_body(d);
    with.start(), added.start();
    CHECK(added.record().bodies.size() == 3);
    CHECK(added.record_of_all().bodies.size() == 5);
    for (const BodyDescription& d : newcomers()) added.act(addition(d.name));
    added.start();
    CHECK((hashes_of(added, 25) == hashes_of(with, 25)));
    CHECK(added.record().stats.bodies == 5);
    CHECK(added.record().contacts.size() == with.record().contacts.size());
  }
}

TEST_CASE("before a body is added all is as without it, and one that nobody meets moves as it would from the start") {
  for (const bool soft : {false, true}) {
    CAPTURE(soft);
    BodyDescription far = soft ? soft_cube("far", 0.3, 2, Vec3(50, 40, 0)) : cube("far", 0.3, Vec3(50, 40, 0));
    far.velocity = Vec3(1, 2, 3);
    if (!soft) far.rotation = Vec3(10, 20, 30);
    World plain, from_start, later;
    for (World* world : {&plain, &from_start, &later}) add_those_there(*world);
    from_start.add_body(far), later.add_absent_body(far);
    for (World* world : {&plain, &from_start, &later}) world->start();
    CHECK((hashes_of(later, 12) == hashes_of(plain, 12)));
    later.act(addition("far"));
    const auto state_of = [](const World& world, const char* name) {
      ByteWriter out;
      world.bodies()[world.bodies().find(name)].save(out);
      return out.take();
    };
    for (int k = 0; k < 20; ++k) {
      for (World* world : {&plain, &from_start, &later}) world->step();
      CHECK((state_of(later, "far") == state_of(from_start, "far")));
      for (const char* other : {"low", "soft"}) CHECK((state_of(later, other) == state_of(plain, other)));
    }
    // a second time nothing comes of it
    later.act(addition("far"));
    CHECK((state_of(later, "far") == state_of(from_start, "far")));
  }
}

TEST_CASE("a body that comes to life wakes nobody but whom it meets") {
  World world;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(cube("a", 0.3, Vec3(0, 0.15, 0)));
  world.add_body(cube("b", 0.3, Vec3(5, 0.15, 0)));
  world.add_absent_body(cube("c", 0.3, Vec3(0, 0.5, 0)));
  world.parameters.simulation.sleeping = true;
  world.start();
  run(world, 120);
  REQUIRE(world.record().stats.asleep == 2);
  world.act(addition("c"));
  world.parameters_changed();
  run(world, 30);
  CHECK_FALSE(world.record().bodies[1].asleep);
  CHECK(world.record().bodies[2].asleep);
  // what is changed of it from now on counts as of any other
  world.bodies()[3].friction = 0.1;
  world.parameters_changed();
  world.step();
  CHECK(world.record().stats.asleep == 0);
}

TEST_CASE(
    "states of worlds that bodies are added to are the same on any thread, and from snapshots of before and after") {
  const auto make = [](World& world) {
    add_those_there(world);
    for (const BodyDescription& d : newcomers()) world.add_absent_body(d);
    world.parameters.simulation.integrator = "newmark";
    world.start();
  };
  const auto go = [](World& world, int from, int to) {
    std::vector<std::uint64_t> list;
    for (int k = from; k < to; ++k) {
      if (k == 5) world.act(addition("rigid_2"));
      if (k == 15) world.act(addition("soft_2"));
      if (k == 20) world.act({Act::remove, "rigid_2"});
      world.step();
      list.push_back(world.record().stats.state_hash);
    }
    return list;
  };
  World first;
  std::vector<std::uint64_t> wanted;
  {
    const Threads one(1);
    make(first);
    wanted = go(first, 0, 30);
  }
  const Threads two(2);
  for (const int at : {3, 10, 18, 25}) {
    CAPTURE(at);
    World second, third;
    make(second), make(third);
    go(third, 0, 30);  // it has seen them all before
    go(second, 0, at);
    ByteWriter state;
    second.save(state);
    ByteReader in(state.bytes());
    third.restore(in);
    CHECK(in.at_end());
    CHECK((third.record().bodies.size() == (at < 5 ? 3u : at < 15 ? 4u : 5u)));
    CHECK((go(third, at, 30) == std::vector(wanted.begin() + at, wanted.end())));
  }
}
