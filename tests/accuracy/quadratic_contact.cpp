// Quadratic tetrahedra in contact: weight, pressure, every response and integrator, self-made snapshots.
#include <catch2/catch.hpp>

#include "engine/bodies/element_stress.hpp"
#include "engine/core/archive.hpp"
#include "engine/core/parallel.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/response/response.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

SoftOptions quadratic(double young, double poisson, double beta, const std::string& model = "corotational") {
  return {young, poisson, 1000.0, beta, model, ElementKind::quadratic};
}

/// Mean force of the floor, body 0, on what lies on it, N.
double floor_force(World& world, int frames) {
  double force = 0.0;
  for (int i = 0; i < frames; ++i) {
    world.step();
    force -= contact_force_on(world, 0).y() / frames;
  }
  return force;
}

}  // namespace

TEST_CASE("a cube of quadratic elements rests and weighs what it weighs, to Poisson's ratio 0.499") {
  for (const char* model : {"corotational", "neo_hookean"})
    for (const double poisson : {0.3, 0.499}) {
      CAPTURE(model, poisson);
      World world;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
      world.add_body(soft_cube("cube", 0.2, 2, {0, 0.002, 0}, quadratic(1e5, poisson, 0.01, model)));
      world.parameters.simulation.sleeping = false;
      world.start();
      run(world, 180);
      CHECK(fastest_node(world) < 1e-3);
      CHECK(floor_force(world, 20) == Approx(kGravity * world.bodies()[1].mass).epsilon(1e-3));
      CHECK(judge_overlap(world.bodies()).penetration < 2e-5);
    }
}

TEST_CASE("pressed between smooth plates a block of quadratic elements has one stress, E times the strain") {
  // the pressure of a face is at the midpoints of its triangles, and nothing at their corners: contacts find that
  for (const double poisson : {0.3, 0.499}) {
    CAPTURE(poisson);
    World world;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(soft_cube("block", 0.2, 2, {0, 0, 0}, quadratic(1e6, poisson, 0.01)));
    BodyDescription plate = cube("plate", 0.3, {0.1, 0.35, 0.1});
    plate.kind = BodyKind::scripted;
    plate.motion = {{0.0, {0.1, 0.35, 0.1}, {0, 0, 0}}, {1.0, {0.1, 0.348, 0.1}, {0, 0, 0}}};
    world.add_body(plate);
    world.parameters.simulation.gravity = Vec3::Zero();
    world.parameters.contact.friction = 0.0;
    world.parameters.simulation.sleeping = false;
    world.start();
    run(world, 240);
    const double wanted = 1e6 * 0.01, force = -contact_force_on(world, 0).y();
    CHECK(force == Approx(wanted * 0.04).epsilon(0.02));  // the face grows by ν of the strain
    const auto& block = *world.bodies()[1].as<DeformableBody>();
    double largest = 0.0;
    for (int e = 0; e < static_cast<int>(block.fem.elements().size()); ++e) {
      const Mat3 stress = element_state(block, e).stress;
      largest = std::max(largest, (stress + wanted * Vec3::UnitY() * Vec3::UnitY().transpose()).norm());
    }
    CHECK(largest < 0.03 * wanted);
  }
}

TEST_CASE("quadratic elements rest with every response and every integrator") {
  const auto rests = [](const std::string& response, const std::string& integrator, int cells) {
    CAPTURE(response, integrator);
    World world;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(soft_cube("cube", 0.2, cells, {0, 0.002, 0}, quadratic(1e5, 0.4, 2e-3)));
    world.parameters.response.method = response;
    world.parameters.simulation.integrator = integrator;
    world.parameters.simulation.substeps = integrator == "symplectic_euler" ? 60 : 4;
    world.parameters.simulation.sleeping = false;
    world.start();
    run(world, 120);
    CHECK(floor_force(world, 60) == Approx(kGravity * world.bodies()[1].mass).epsilon(1e-2));
    CHECK(fastest_node(world) < 2e-2);
  };
  for (const auto& e : integrators()) rests("constraint_anticipation", std::string(e.name), 2);
  for (const auto& e : responses()) rests(std::string(e.name), "linearly_implicit_euler", 1);
}

TEST_CASE("quadratic elements: the same hashes for any number of threads, and from a snapshot on") {
  const auto make = [](World& world) {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(soft_cube("lower", 0.2, 2, {0, 0.001, 0}, quadratic(1e5, 0.45, 0.002, "neo_hookean")));
    world.add_body(soft_cube("upper", 0.15, 2, {0.03, 0.21, 0.03}, quadratic(2e5, 0.3, 0.002)));
    world.start();
  };
  std::vector<std::uint64_t> hashes[2];
  std::string kept;
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    World world;
    make(world);
    for (int frame = 0; frame < 12; ++frame) {
      world.step();
      hashes[threads / 4].push_back(world.record().stats.state_hash);
      if (threads == 1 && frame == 5) {
        ByteWriter out;
        world.save(out);
        kept = out.bytes();
      }
    }
  }
  set_thread_count(0);
  CHECK(hashes[0] == hashes[1]);
  World again;
  make(again);
  ByteReader in(kept);
  again.restore(in);
  for (int frame = 6; frame < 12; ++frame) {
    again.step();
    CHECK(again.record().stats.state_hash == hashes[0][static_cast<std::size_t>(frame)]);
  }
}
