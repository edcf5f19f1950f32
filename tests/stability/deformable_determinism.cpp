// Deformable bodies: the same bits for any thread count, on a second run, after a snapshot in a fresh world; and what
// diverges says where.
#include <algorithm>
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/state_hashes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// The thread sanitizer takes minutes for seconds, and a race shows in the first frames of contact.
constexpr int frames_of(int all) {
#ifdef __SANITIZE_THREAD__
  return std::min(all, 5);
#else
  return all;
#endif
}

/// A soft cube falls on another, beside a rigid ball, with an attachment and moved nodes.
void fill(World& world) {
  // damping in proportion to stiffness bounds an explicit scheme's step more than the stiffness does
  const double beta = world.parameters.simulation.integrator->is_explicit() ? 1e-5 : 0.01;
  world.parameters.lcp.tolerance = 1e-6;
  world.parameters.lcp.max_iterations = 100;
  set(world, "response.iterative_constraint_anticipation.max_iterations", 200);
  set(world, "response.iterative_constraint_anticipation.factorizes", "false");
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
  world.add_body(soft_cube("lower", 0.2, 3, {0, 0.005, 0}, {5e4, 0.4, 1000.0, beta}));
  world.add_body(soft_cube("upper", 0.2, 2, {0.03, 0.22, 0.02}, {2e5, 0.45, 1000.0, beta}));
  world.add_body(dynamic_body("ball", Sphere{0.05}, {0.1, 0.5, 0.1}));
  BodyDescription bar = soft_box("bar", {0.3, 0.04, 0.04}, {6, 1, 1}, {-0.05, 0.46, 0.15}, {1e5, 0.4, 1000.0, beta});
  auto soft = std::make_shared<DeformableDescription>(*bar.deformable);
  NodeRegion end;
  end.min = {-1, -1, -1}, end.max = {-0.049, 1, 1};
  end.motion = {{0.0, Vec3::Zero(), Vec3::Zero()}, {0.3, {0, -0.1, 0}, {0, 20, 0}}};
  soft->fixed = {end};
  bar.deformable = soft;
  world.add_body(bar);
  world.add_attachment({"string", "ball", "bar", {0.14, 0.5, 0.13}});
  world.start();
}

}  // namespace

TEST_CASE(
    "deformable bodies in contact have the same hashes for 1, 2 and 4 threads, for every response and integrator") {
  for (const auto& response : responses())
    for (const auto& integrator : integrators()) {
      if (response.name != responses().front().name && integrator.name != integrators().front().name) continue;
      CAPTURE(response.name, integrator.name);
      std::vector<std::uint64_t> first;
      for (int threads : {1, 2, 4}) {
        const Threads guard(threads);
        World world;
        world.parameters.response.method = response.name;
        world.parameters.simulation.integrator = integrator.name;
        world.parameters.simulation.substeps = integrator.name == "symplectic_euler" ? 32 : 4;
        fill(world);
        const std::vector<std::uint64_t> list = hashes(world, frames_of(14));
        if (first.empty()) {
          first = list;
          CHECK(world.record().stats.contacts > 0);
        }
        CHECK(list == first);
      }
    }
}

TEST_CASE("groups that are solved side by side have the same hashes for 1, 2 and 4 threads, by every linear solver") {
  std::vector<std::string_view> solvers = {"automatic"};
  for (const auto& solver : linear_solvers()) solvers.push_back(solver.name);
  for (const std::string_view solver : solvers) {
    CAPTURE(solver);
    std::vector<std::uint64_t> first;
    for (const int threads : {1, 2, 4, 2}) {
      const Threads limit(threads);
      World world;
      world.parameters.simulation.linear_solver = solver;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      for (int i = 0; i < 8; ++i) {
        world.add_body(soft_cube("jelly" + std::to_string(i), 0.2, 3, {1.0 * i, 0.001, 0}, {5e4, 0.3, 500.0, 0.01}));
        world.add_body(cube("stone" + std::to_string(i), 0.1, {1.0 * i + 0.1, 0.25, 0.1 + 0.005 * i}));
      }
      world.start();
      const std::vector<std::uint64_t> found = hashes(world, frames_of(25));
      if (first.empty()) first = found;
      CHECK(found == first);
      CHECK(world.record().groups.size() == 8);
    }
  }
}

TEST_CASE("a snapshot of deformable bodies goes on bit for bit in a fresh world, for every integrator") {
  for (const auto& integrator : integrators()) {
    CAPTURE(integrator.name);
    const auto make = [&](World& world) {
      world.parameters.simulation.integrator = integrator.name;
      world.parameters.simulation.substeps = integrator.name == "symplectic_euler" ? 32 : 4;
      fill(world);
    };
    World world;
    make(world);
    run(world, 10);
    ByteWriter snapshot;
    world.save(snapshot);
    const std::vector<std::uint64_t> ahead = hashes(world, 6);
    World fresh;
    make(fresh);
    ByteReader into(snapshot.bytes());
    fresh.restore(into);
    CHECK(into.at_end());
    CHECK(hashes(fresh, 6) == ahead);
  }
}

TEST_CASE("an explicit scheme beyond its stability limit ends with a message that names frame and body") {
  World world;
  world.add_body(soft_cube("jelly", 0.2, 3, {0, 0, 0}, {1e8, 0.4, 1000.0, 0.0}));
  deformable(world, 0).velocity[0] = 1.0;
  world.parameters.simulation.integrator = "symplectic_euler";
  world.parameters.simulation.substeps = 1;
  world.start();
  std::string message;
  try {
    run(world, 200);
  } catch (const DivergenceError& e) {
    message = e.what();
  }
  CHECK(message.find("frame ") != std::string::npos);
  CHECK(message.find("body 'jelly'") != std::string::npos);
}
