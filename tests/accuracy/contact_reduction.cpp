// Fewer contacts, the same motion: meshes cut into many triangles against closed forms and against all their contacts.
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/shapes/surface_of_revolution.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

MeshPointer cut_cube(int cells) { return surface(box(Vec3::Constant(0.05), Eigen::Vector3i::Constant(cells))); }

}  // namespace

TEST_CASE("a cube of 768 triangles stands, slides and stops on four contacts") {
  for (const bool all : {true, false}) {
    World world;
    world.parameters.contact.reduction = all ? Reduction::none : Reduction::patch;
    world.parameters.contact.friction = 0.3;
    world.parameters.simulation.sleeping = false;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    BodyDescription d = dynamic_body("cube", cut_cube(8), {0, 0.05, 0});
    d.velocity = {1.0, 0, 0};
    world.add_body(d);
    world.start();
    run(world, 60);
    CHECK(world.record().contacts.size() == (all ? 81 : 4));
    // v² / (2 μ g), less half a sub-step's way: each moves by the velocity at its end
    const double way = 1.0 / (2.0 * 0.3 * kGravity) - 0.5 / 240.0;
    CHECK(rigid(world, 1).pose.position.x() == Approx(way).epsilon(1e-3));
    CHECK(rigid(world, 1).pose.position.y() == Approx(0.05).margin(1e-6));
    CHECK(tilt_degrees(world.bodies()[1]) < 1e-3);
    CHECK(rigid(world, 1).velocity.norm() < 1e-9);
  }
}

TEST_CASE("five cut cubes stand on one another with four contacts a pair") {
  World world;
  world.parameters.simulation.sleeping = false;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
  for (int k = 0; k < 5; ++k)
    world.add_body(dynamic_body("cube" + std::to_string(k), cut_cube(5 + k), {0.004 * (k % 2), 0.05 + 0.1 * k, 0}));
  world.start();
  run(world, 120);
  CHECK(world.record().contacts.size() <= 5 * 8);
  CHECK(world.record().stats.kinetic < 1e-12);
  CHECK(judge_overlap(world.bodies()).penetration < 1e-7);
  for (int k = 1; k <= 5; ++k) CHECK(rigid(world, k).pose.position.y() == Approx(0.1 * k - 0.05).margin(1e-5));
}

TEST_CASE("a finely cut coin tips over its rim at the angle of its whole rim") {
  // a cylinder of radius r and half height h on a slope tips where tan(slope) > r / h; friction holds it
  const double radius = 0.02, half = 0.04;
  for (const double share : {0.96, 1.02}) {
    const int around = 64;
    TriangleMesh mesh;
    for (const double y : {-half, half})
      for (int i = 0; i < around; ++i)
        mesh.vertices.emplace_back(radius * std::cos(2 * M_PI * i / around), y,
                                   radius * std::sin(2 * M_PI * i / around));
    mesh.vertices.emplace_back(0, -half, 0), mesh.vertices.emplace_back(0, half, 0);
    for (int i = 0; i < around; ++i) {
      const int j = (i + 1) % around;
      mesh.triangles.push_back({i, j, 2 * around});
      mesh.triangles.push_back({around + j, around + i, 2 * around + 1});
      mesh.triangles.push_back({i, around + i, j});
      mesh.triangles.push_back({j, around + i, around + j});
    }
    World world;
    world.parameters.contact.friction = 2.0;
    world.parameters.simulation.sleeping = false;
    const double slope = std::atan(share * radius / half);
    world.parameters.simulation.gravity = kGravity * Vec3(std::sin(slope), -std::cos(slope), 0.0);
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(dynamic_body("coin", surface(mesh), {0, half, 0}));
    world.start();
    run(world, 120);
    CAPTURE(share);
    CHECK(world.record().contacts.size() <= 24);
    const double upright = world.bodies()[1].pose.rotation.col(1).y();
    if (share < 1.0)
      CHECK(upright > std::cos(0.1 * M_PI / 180.0));
    else
      CHECK(upright < std::cos(1.0 * M_PI / 180.0));
  }
}

TEST_CASE("a ball of 1,280 triangles rolls as one with all its contacts does") {
  Vec3 place[2];
  for (const bool all : {true, false}) {
    World world;
    world.parameters.contact.reduction = all ? Reduction::none : Reduction::patch;
    world.parameters.contact.friction = 0.8;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    BodyDescription d = dynamic_body("ball", surface(icosphere(3, 0.1)), {0, 0.1, 0});
    d.velocity = {1.0, 0, 0};
    d.angular_velocity = {0, 0, -10.0};
    world.add_body(d);
    world.start();
    run(world, 60);
    place[all ? 0 : 1] = rigid(world, 1).pose.position;
  }
  CAPTURE(place[0].transpose(), place[1].transpose());
  CHECK((place[0] - place[1]).norm() < 0.01 * place[0].norm());
}

TEST_CASE("a disc of triangles that spins on a floor is braked as on its rim, whatever corners lie within it") {
  constexpr double kRadius = 0.2, kHeight = 0.04, kFriction = 0.3;
  for (const int corners : {4, 5, 8, 64})
    for (const bool has_ring : {false, true})
      for (const bool on_box : {false, true})
        for (const int substeps : {1, 4, 16}) {
          CAPTURE(corners, has_ring, on_box, substeps);
          // both ends have a vertex in their middle, and a ring of corners half way out
          std::vector<Vec2> rings = {{kRadius, -0.5 * kHeight}, {kRadius, 0.5 * kHeight}};
          if (has_ring)
            rings.emplace(rings.begin(), 0.5 * kRadius, -0.5 * kHeight),
                rings.emplace_back(0.5 * kRadius, 0.5 * kHeight);
          const SharedShape shape(surface(surface_of_revolution(rings, -0.5 * kHeight, 0.5 * kHeight, corners)));
          World world;
          world.parameters.simulation.sleeping = false;
          world.parameters.simulation.substeps = substeps;
          world.parameters.contact.friction = kFriction;
          BodyDescription floor = fixed_plane("floor", Vec3::UnitY(), 0.0);
          if (on_box) floor.shape = Box(Vec3(2.0, 0.1, 2.0)), floor.position = Vec3(0.0, -0.1, 0.0);
          world.add_body(floor);
          BodyDescription d = dynamic_body("disc", shape, Vec3(0.0, 0.5 * kHeight, 0.0));
          d.angular_velocity = Vec3(0.0, 20.0, 0.0);
          world.add_body(d);
          world.start();
          const RigidBody& disc = rigid(world, 1);
          const double due =
              kFriction * kGravity * kRadius * disc.mass / (disc.inertia_inverse.inverse())(1, 1);  // rad/s²
          run(world, 6);
          const double before = disc.angular_velocity().y();
          run(world, 12);
          CHECK((before - disc.angular_velocity().y()) / 0.2 == Approx(due).epsilon(0.01));
        }
}
