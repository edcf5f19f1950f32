// What rolls on its rim or stands on its tip goes round steadily where its spin balances its weight, and neither friction
// that sticks nor a floor takes energy from it: the moment of the floor's force about its centre is the turn of its
// angular momentum.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "engine/geometry/surface/thickened_surface.hpp"
#include "engine/shapes/surface_of_revolution.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

enum class Floor { plane, box, mesh };

BodyDescription floor_of(Floor kind) {
  BodyDescription d = fixed_plane("floor", Vec3::UnitY(), 0.0);
  if (kind == Floor::plane) return d;
  d.position = {0.01, -0.1, 0.02};
  d.shape = kind == Floor::mesh ? SharedShape(surface(box_surface(Vec3(2, 0.1, 2), Eigen::Vector3i(80, 1, 80))))
                                : SharedShape(Box{Vec3(2, 0.1, 2)});
  return d;
}

double total_energy(const RigidBody& body) {
  const Vec3 w = body.angular_velocity();
  return 0.5 * body.mass * body.velocity.squaredNorm() + 0.5 * w.dot(body.world_inertia() * w) +
         body.mass * kGravity * body.pose.position.y();
}

double tilt_of(const RigidBody& body) {
  return std::acos(std::min(1.0, std::abs((body.pose.rotation * Vec3::UnitY()).y()))) * 180.0 / M_PI;
}

struct Disc {
  double radius, thickness, tilt;  // metres, degrees
};

/// Its centre stays, and so does for an instant the point of the rim that touches: it turns about the line through both.
BodyDescription steady_disc(const Disc& of) {
  const double tilt = of.tilt * M_PI / 180.0, r = of.radius, t = of.thickness;
  BodyDescription d = dynamic_body("disc", cylinder(r, t), {});
  d.mass = 1.0;
  d.rotation = {0.0, 0.0, -of.tilt};
  const Vec3 axis(std::sin(tilt), std::cos(tilt), 0.0), rim(std::cos(tilt), -std::sin(tilt), 0.0),
      arm = r * rim - 0.5 * t * axis, along = arm.normalized();
  d.position = {0.0, -arm.y(), 0.0};
  // of w = W along: its axis goes round the vertical at Ω = W round, dL/dt = Ω × L = arm × m g
  const double across = 0.25 * r * r + t * t / 12.0, about = 0.5 * r * r,
               round = along.cross(axis).z() / Vec3::UnitY().cross(axis).z();
  const Vec3 momentum = about * axis * axis.dot(along) + across * (along - axis * axis.dot(along));
  const double moment = arm.cross(kGravity * Vec3::UnitY()).z(), turn = round * Vec3::UnitY().cross(momentum).z();
  d.angular_velocity = std::sqrt(moment / turn) * along;
  return d;
}

}  // namespace

TEST_CASE("a disc that rolls on its rim goes round steadily and keeps its energy, on any floor") {
  struct Case {
    Disc disc;
    int substeps;
    double energy, tilt;  // least and most share that is left after 5 s (less its distance from 1), degrees
  };
  // a coin of 24 x 1.7 mm turns by 0.17 rad in a sub-step with four of them
  for (const Case& c : {Case{{0.012, 1.7e-3, 30.0}, 4, 0.09, 2.5}, Case{{0.012, 1.7e-3, 30.0}, 16, 0.004, 0.3},
                        Case{{0.012, 1.7e-3, 20.0}, 16, 0.006, 0.5}, Case{{0.5, 2e-3, 30.0}, 1, 0.01, 1.0},
                        Case{{0.5, 2e-3, 30.0}, 4, 0.002, 0.3}, Case{{0.5, 0.2, 45.0}, 1, 0.004, 1.0},
                        Case{{0.5, 0.2, 45.0}, 16, 1e-4, 0.1}})
    for (const Floor floor : {Floor::plane, Floor::box, Floor::mesh}) {
      CAPTURE(c.disc.radius, c.disc.thickness, c.disc.tilt, c.substeps, static_cast<int>(floor));
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = c.substeps;
      world.parameters.contact.friction = 1.0;
      world.add_body(floor_of(floor));
      world.add_body(steady_disc(c.disc));
      world.start();
      const RigidBody& disc = rigid(world, 1);
      const double lying = kGravity * 0.5 * c.disc.thickness, begun = total_energy(disc) - lying;
      double least = 1.0, most = 1.0, off = 0.0;
      for (int i = 0; i < 300; ++i) {
        world.step();
        const double left = (total_energy(disc) - lying) / begun;
        least = std::min(least, left), most = std::max(most, left);
        off = std::max(off, std::abs(tilt_of(disc) - c.disc.tilt));
        REQUIRE(world.record().stats.unconverged == 0);
      }
      CHECK(least > 1.0 - c.energy);
      CHECK(most < 1.0 + 0.5 * c.energy);
      CHECK(off < c.tilt);
    }
}

TEST_CASE("wheels and balls of triangles finer than a sub-step's turn roll as round ones do") {
  constexpr double kRadius = 0.1, kSpeed = 2.0;  // metres, m/s: 0.083 rad in a sub-step with four
  const TriangleMesh wheel = surface_of_revolution({{kRadius, -0.1}, {kRadius, 0.1}}, -0.1, 0.1, 384);
  struct Case {
    SharedShape shape;
    Vec3 rotation;
    double least;  // of the energy after 1 s, 3.2 turns
  };
  for (const Case& c :
       {Case{SharedShape(surface(wheel)), {90, 0, 0}, 0.95}, Case{made_hull(wheel.vertices), {90, 0, 0}, 0.95},
        Case{SharedShape(surface(icosphere(5, kRadius))), {0, 0, 0}, 0.75}})
    for (const int substeps : {4, 16}) {
      CAPTURE(c.shape->name(), c.shape->mesh() != nullptr ? c.shape->mesh()->mesh.triangles.size() : 0, substeps);
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.parameters.contact.friction = 1.0;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription d = dynamic_body("roller", c.shape, {0.0, kRadius, 0.0});
      d.rotation = c.rotation;
      d.velocity = {kSpeed, 0.0, 0.0};
      d.angular_velocity = {0.0, 0.0, -kSpeed / kRadius};
      d.position.y() -= c.shape->bounds({rotation_from_degrees(d.rotation), d.position}).min.y();
      world.add_body(d);
      world.start();
      const RigidBody& roller = rigid(world, 1);
      const double begun = total_energy(roller), lying = roller.mass * kGravity * kRadius;
      for (int i = 0; i < 60; ++i) {
        world.step();
        REQUIRE(world.record().stats.substep_penetration < 1e-4);
        REQUIRE(total_energy(roller) < begun + 0.005 * (begun - lying));
      }
      CHECK(total_energy(roller) - lying > c.least * (begun - lying));
    }
}

TEST_CASE("a ball that rolls to and fro in a half-pipe of fine facets keeps its energy") {
  constexpr double kPipe = 0.5, kBall = 0.05, kFrom = 40.0, kFacet = 0.25, kEdge = 60.0;  // metres, degrees
  TriangleMesh pipe;
  const int facets = static_cast<int>(2.0 * kEdge / kFacet);
  for (int i = 0; i <= facets; ++i) {
    const double at = (i * kFacet - kEdge) * M_PI / 180.0;
    for (const double z : {-0.3, 0.3}) pipe.vertices.emplace_back(kPipe * std::sin(at), -kPipe * std::cos(at), z);
    if (i == 0) continue;
    const int a = 2 * (i - 1), b = 2 * i;
    pipe.triangles.push_back({a, a + 1, b}), pipe.triangles.push_back({a + 1, b + 1, b});
  }
  for (const auto& [substeps, least] : {std::pair(4, 0.97), std::pair(16, 0.99)}) {
    CAPTURE(substeps);
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = substeps;
    BodyDescription below =
        dynamic_body("pipe", SharedShape(surface(thickened(pipe, {SurfaceSides::front, 0.02}))), Vec3::Zero());
    below.kind = BodyKind::fixed, below.friction = 0.5;
    world.add_body(below);
    const double from = kFrom * M_PI / 180.0, swing = kPipe - kBall;
    BodyDescription ball = dynamic_body("ball", Sphere(kBall), swing * Vec3(std::sin(from), -std::cos(from), 0.0));
    ball.friction = 0.5, ball.mass = 1.0;
    world.add_body(ball);
    world.start();
    const double whole = kGravity * swing * (1.0 - std::cos(from)), begun = total_energy(rigid(world, 1));
    for (int i = 0; i < 60; ++i) {
      world.step();
      REQUIRE(world.record().stats.substep_penetration < 5e-5);
      REQUIRE(total_energy(rigid(world, 1)) < begun + 0.01 * whole);
    }
    CHECK(begun - total_energy(rigid(world, 1)) < (1.0 - least) * whole);
  }
}

TEST_CASE("a top that stands on its tip keeps its energy, as a cone, a mesh and a hull") {
  constexpr double kRadius = 0.03, kTilt = 20.0, kSpin = 300.0;  // metres, degrees, rad/s
  const TriangleMesh corners = surface_of_revolution({{kRadius, 0.01}}, -0.03, 0.01, 24);
  for (const auto& [shape, upside] :
       {std::pair(cone(kRadius, 0.04), 180.0), std::pair(SharedShape(surface(corners)), 0.0),
        std::pair(made_hull(corners.vertices), 0.0)})
    for (const auto& [substeps, share] : {std::pair(4, 0.012), std::pair(16, 0.0005)}) {
      CAPTURE(shape->name(), substeps);
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.parameters.contact.friction = 1.0;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
      BodyDescription d = dynamic_body("top", shape, {0.0, 1.0, 0.0});
      d.mass = 1.0;
      d.rotation = {0.0, 0.0, upside + kTilt};
      const double tilt = kTilt * M_PI / 180.0;
      d.angular_velocity = kSpin * Vec3(-std::sin(tilt), std::cos(tilt), 0.0);
      const Pose pose{rotation_from_degrees(d.rotation), d.position};
      d.position.y() -= shape->bounds(pose).min.y();
      world.add_body(d);
      world.start();
      const RigidBody& top = rigid(world, 1);
      const double begun = total_energy(top), spin = 0.5 * top.angular_momentum.dot(top.angular_velocity());
      for (int i = 0; i < 120; ++i) {
        world.step();
        REQUIRE(total_energy(top) == Approx(begun).margin(share * spin));
        REQUIRE(tilt_of(top) < kTilt + 6.0);
      }
    }
}

TEST_CASE("a box on a turntable that speeds up stays where it stands on it") {
  const auto response =
      GENERATE(as<std::string>(), "constraint_anticipation", "sequential_impulse", "simultaneous_impulse");
  for (const double rate : {0.2, 0.5})  // rad/s²
    for (const int substeps : {1, 4}) {
      CAPTURE(response, rate, substeps);
      World world;
      world.parameters.simulation.sleeping = false;
      world.parameters.simulation.substeps = substeps;
      world.parameters.response.method = response;
      BodyDescription table = dynamic_body("table", Box{Vec3(2, 0.1, 2)}, {0, -0.1, 0});
      table.kind = BodyKind::scripted;
      for (int i = 0; i <= 30; ++i)
        table.motion.push_back({0.1 * i, Vec3(0, -0.1, 0), Vec3(0, 0.5 * rate * 0.01 * i * i * 180.0 / M_PI, 0)});
      world.add_body(table);
      world.add_body(cube("box", 0.05, {1, 0.025, 0}));
      world.start();
      run(world, 150);
      const double turned = rate * 2.5, chord = turned * turned * 2.5 / 6.0 * world.parameters.simulation.time_step();
      const Vec3 at = world.bodies()[1].pose.position;
      CHECK(std::abs(std::hypot(at.x(), at.z()) - 1.0) < 0.02 * chord);
    }
}
