// What rolls on its rim or stands on its tip goes round steadily where its spin balances its weight, and neither friction
// that sticks nor a floor takes energy from it: the moment of the floor's force about its centre is the turn of its
// angular momentum.
#include <catch2/catch.hpp>

#include "engine/geometry/rotation.hpp"
#include "engine/geometry/surface/thickened_surface.hpp"
#include "engine/shapes/surface_of_revolution.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/rolling_polygon.hpp"
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
  BodyDescription d = dynamic_body("disc", cylinder(r, t), Vec3::Zero());
  d.mass = 1.0;
  d.rotation = {0.0, 0.0, -of.tilt};
  const Vec3 axis(std::sin(tilt), std::cos(tilt), 0.0), rim(std::cos(tilt), -std::sin(tilt), 0.0),
      arm = r * rim - 0.5 * t * axis, along = arm.normalized();
  d.position = Vec3(0.0, -arm.y(), 0.0);
  // of w = W along: its axis goes round the vertical at Ω = W round, dL/dt = Ω × L = arm × m g
  const double across = 0.25 * r * r + t * t / 12.0, about = 0.5 * r * r,
               round = along.cross(axis).z() / Vec3::UnitY().cross(axis).z();
  const Vec3 momentum = about * axis * axis.dot(along) + across * (along - axis * axis.dot(along));
  const double moment = arm.cross(kGravity * Vec3::UnitY()).z(), turn = round * Vec3::UnitY().cross(momentum).z();
  d.angular_velocity = std::sqrt(moment / turn) * along;
  return d;
}

Profile regular_polygon(int count, double radius) {
  Profile corners;
  for (int i = 0; i < count; ++i) {
    const double at = 2.0 * M_PI * (i + 0.5) / count - 0.5 * M_PI;
    corners.emplace_back(radius * std::cos(at), radius * std::sin(at));
  }
  return corners;
}

/// The lower half of a polygon of twice as many corners, about its centre of mass.
Profile half_polygon(int facets, double radius) {
  Profile corners;
  for (int i = 0; i <= facets; ++i) {
    const double at = M_PI * (static_cast<double>(i) / facets - 1.0);
    corners.emplace_back(radius * std::cos(at), radius * std::sin(at));
  }
  double area = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += 0.5 * cross, moment += cross * (a.y() + b.y()) / 6.0;
  }
  for (Eigen::Vector2d& corner : corners) corner.y() -= moment / area;
  return corners;
}

/// A prism of that profile on a floor, with friction that holds it.
struct PrismOnFloor {
  World world;

  PrismOnFloor(const Profile& profile, double length, bool is_hull, double angle, double speed, double spin,
               int substeps) {
    const TriangleMesh mesh = prism(profile, length);
    const SharedShape shape = is_hull ? made_hull(mesh.vertices) : SharedShape(surface(mesh));
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = substeps;
    world.parameters.contact.friction = 2.0;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    BodyDescription d = dynamic_body("prism", shape, Vec3::Zero());
    d.rotation = {0.0, 0.0, angle * 180.0 / M_PI};
    d.position.y() = -shape->bounds({rotation_from_degrees(d.rotation), Vec3::Zero()}).min.y();
    d.velocity = {speed, 0.0, 0.0}, d.angular_velocity = {0.0, 0.0, spin};
    world.add_body(d);
    world.start();
  }
  const RigidBody& body() const { return rigid(world, 1); }
  double inertia() const { return body().world_inertia()(2, 2) / body().mass; }
  /// Of whole frames.
  void go_on(double seconds) {
    for (int i = 0; i < std::lround(60.0 * seconds); ++i) {
      const double before = total_energy(body());
      world.step();
      REQUIRE(world.record().stats.unconverged == 0);
      // velocities are of half a sub-step before the pose
      REQUIRE(total_energy(body()) < before + 5e-3 * body().mass * kGravity * body().pose.position.y());
    }
  }
};

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

TEST_CASE("a coin of triangles finer than its way round its rim goes round as a round one does") {
  constexpr double kRadius = 0.04, kThickness = 0.008;
  const TriangleMesh coin = surface_of_revolution({{kRadius, -0.5 * kThickness}, {kRadius, 0.5 * kThickness}},
                                                  -0.5 * kThickness, 0.5 * kThickness, 256);
  for (const SharedShape& shape : {SharedShape(surface(coin)), made_hull(coin.vertices)})
    for (const Floor floor : {Floor::plane, Floor::mesh})
      for (const int substeps : {4, 8, 16}) {  // 7.5 corners come down in a sub-step, 3.7, 1.9
        CAPTURE(shape->name(), static_cast<int>(floor), substeps);
        World world;
        world.parameters.simulation.sleeping = false;
        world.parameters.simulation.substeps = substeps;
        world.parameters.contact.friction = 1.0;
        world.add_body(floor_of(floor));
        BodyDescription d = steady_disc({kRadius, kThickness, 30.0});
        d.shape = shape;
        d.position.y() = -shape->bounds({rotation_from_degrees(d.rotation), Vec3::Zero()}).min.y();
        world.add_body(d);
        world.start();
        const RigidBody& disc = rigid(world, 1);
        const double lying = kGravity * 0.5 * kThickness, begun = total_energy(disc) - lying;
        for (int i = 0; i < 12; ++i) {
          world.step();
          REQUIRE(total_energy(disc) - lying < 1.02 * begun);
        }
        CHECK(total_energy(disc) - lying > 0.93 * begun);  // its corners take 0.04
        CHECK(std::abs(tilt_of(disc) - 30.0) < 2.5);
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

TEST_CASE("a wheel of facets that rolls loses what its corners take") {
  struct Case {
    int facets, substeps;
    double off;  // of the speed after 1 s
  };
  for (const Case& c : {Case{12, 4, 0.06}, Case{12, 16, 0.02}, Case{24, 4, 0.02}, Case{24, 16, 0.01}, Case{32, 4, 0.03},
                        Case{32, 16, 0.01}, Case{64, 4, 0.03}, Case{64, 16, 0.01}, Case{64, 64, 0.005}})
    for (const bool is_hull : {false, true}) {
      CAPTURE(c.facets, c.substeps, is_hull);
      constexpr double kRadius = 0.1, kSpeed = 0.8;
      const double height = kRadius * std::cos(M_PI / c.facets);
      PrismOnFloor on(regular_polygon(c.facets, kRadius), 0.05, is_hull, 0.0, kSpeed, -kSpeed / height, c.substeps);
      // what begins flat on a facet goes on about the corner ahead
      const double spin = -kSpeed / height * (on.inertia() + height * height) / (on.inertia() + kRadius * kRadius);
      RollingPolygon due(regular_polygon(c.facets, kRadius), on.inertia(), -1e-9, spin);
      due.go_on(1.0, kGravity);
      on.go_on(1.0);
      CHECK(on.body().angular_velocity().z() == Approx(due.spin()).epsilon(c.off));
    }
}

TEST_CASE("a cart on four wheels of facets loses what their corners take") {
  constexpr double kRadius = 0.1, kSpeed = 0.8;
  struct Case {
    int facets, substeps;
    double off;  // of the speed after 1 s
  };
  for (const Case& c :
       {Case{24, 2, 0.08}, Case{24, 4, 0.08}, Case{24, 16, 0.02}, Case{64, 4, 0.04}, Case{64, 16, 0.02}}) {
    CAPTURE(c.facets, c.substeps);
    const Profile profile = regular_polygon(c.facets, kRadius);
    const double height = kRadius * std::cos(M_PI / c.facets);
    World world;
    world.parameters.simulation.sleeping = false;
    world.parameters.simulation.substeps = c.substeps;
    world.parameters.contact.friction = 2.0;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    BodyDescription box = dynamic_body("box", Box(Vec3(0.3, 0.05, 0.15)), Vec3(0.0, height + 0.06, 0.0));
    box.velocity = {kSpeed, 0.0, 0.0};
    world.add_body(box);
    const SharedShape wheel(surface(prism(profile, 0.05)));
    for (const double x : {-0.2, 0.2})
      for (const double z : {-0.2, 0.2}) {
        BodyDescription d = dynamic_body("wheel" + std::to_string(world.bodies().size()), wheel, Vec3(x, height, z));
        d.velocity = box.velocity, d.angular_velocity = {0.0, 0.0, -kSpeed / height};
        world.add_body(d);
        for (const double side : {-0.02, 0.02}) {
          AttachmentDescription hub{d.name + (side < 0.0 ? " left" : " right"), "box", d.name,
                                    Vec3(x, height, z + side)};
          hub.collide = false;
          world.add_attachment(hub);
        }
      }
    world.start();
    // in step with one another: one polygon with the mass of all, and the inertia of the wheels
    double mass = rigid(world, 1).mass, inertia = 0.0;
    for (int i = 2; i < 6; ++i) mass += rigid(world, i).mass, inertia += rigid(world, i).world_inertia()(2, 2);
    inertia /= mass;
    const double spin = -kSpeed / height * (inertia + height * height) / (inertia + kRadius * kRadius);
    RollingPolygon due(profile, inertia, -1e-9, spin);
    due.go_on(1.0, kGravity);
    run(world, 60);
    CHECK(rigid(world, 2).angular_velocity().z() == Approx(due.spin()).epsilon(c.off));
    CHECK(world.record().stats.unconverged == 0);
  }
}

TEST_CASE("a coin of facets that rolls upright goes straight") {
  for (const int facets : {40, 64, 128, 256}) {
    CAPTURE(facets);
    constexpr double kRadius = 0.012, kSpeed = 0.3;
    PrismOnFloor on(regular_polygon(facets, kRadius), 0.002, false, 0.0, kSpeed,
                    -kSpeed / (kRadius * std::cos(M_PI / facets)), 4);
    run(on.world, 300);
    CHECK(on.body().pose.position.x() > 1.0);
    CHECK(std::abs(on.body().pose.position.z()) < 2e-3);
    CHECK(std::abs(on.body().pose.rotation(1, 2)) < 1e-6);
  }
}

TEST_CASE("a slender block that rocks swings no wider than its impacts leave it, and nearly as wide") {
  const Profile profile = {{-0.05, -0.3}, {0.05, -0.3}, {0.05, 0.3}, {-0.05, 0.3}};
  const double from = 0.5 * std::atan2(0.05, 0.3);
  for (const auto& [substeps, off] : {std::pair(4, 0.15), std::pair(16, 0.06), std::pair(64, 0.02)}) {
    PrismOnFloor on(profile, 0.2, true, from, 0.0, 0.0, substeps);
    RollingPolygon due(profile, on.inertia(), from, 0.0);
    double widest = 0.0, widest_due = 0.0;  // of the third second
    for (int i = 0; i < 180; ++i) {
      on.world.step(), due.go_on(1.0 / 60.0, kGravity);
      if (i < 120) continue;
      const Mat3& turned = on.body().pose.rotation;
      widest = std::max(widest, std::abs(std::atan2(turned(1, 0), turned(0, 0))));
      widest_due = std::max(widest_due, std::abs(due.angle()));
    }
    CAPTURE(substeps, widest / from, widest_due / from);
    CHECK(widest < 1.01 * widest_due);
    CHECK(widest > (1.0 - off) * widest_due);
  }
}

TEST_CASE("half a cylinder of facets that rocks loses what its corners take") {
  constexpr double kFrom = 20.0 * M_PI / 180.0;
  for (const auto& [substeps, off] :
       {std::pair(4, 0.18), std::pair(8, 0.09), std::pair(16, 0.05), std::pair(64, 0.02)}) {
    CAPTURE(substeps);
    const Profile profile = half_polygon(64, 0.1);
    PrismOnFloor on(profile, 0.1, false, kFrom, 0.0, 0.0, substeps);
    RollingPolygon due(profile, on.inertia(), kFrom, 0.0);
    const double begun = due.energy(kGravity);
    const double least = RollingPolygon(profile, on.inertia(), 0.0, 0.0).energy(kGravity);
    due.go_on(3.0, kGravity);
    on.go_on(3.0);
    const double left = (total_energy(on.body()) / on.body().mass - least) / (begun - least),
                 wanted = (due.energy(kGravity) - least) / (begun - least);
    CAPTURE(left, wanted);
    CHECK(std::abs(left - wanted) < off);
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
