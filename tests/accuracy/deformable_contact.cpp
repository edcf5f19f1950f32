// Deformable bodies in contact against statics: rest, weight, attachments, moved nodes; every integrator.
#include <catch2/catch.hpp>

#include "engine/integrators/deformable_integrator.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Drops one or two cubes of 0.2 m from 5 mm and checks that they rest after `seconds`.
void check_rest(double young, int cells, bool stacked, double seconds, int substeps) {
  CAPTURE(young, cells, stacked);
  World world;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
  const SoftOptions options{young, 0.4, 1000.0, 0.01, "corotational"};
  world.add_body(soft_cube("lower", 0.2, cells, {0, 0.005, 0}, options));
  // not a lattice on its likeness: the upper one has other cells and stands beside the middle
  if (stacked) world.add_body(soft_cube("upper", 0.2, cells - 1, {0.004, 0.21, 0.004}, options));
  world.parameters.simulation.substeps = substeps;
  world.parameters.simulation.sleeping = false;
  world.start();
  run(world, static_cast<int>(seconds * 60));

  double weight = 0.0;
  for (const Body& body : world.bodies()) weight += body.kind() == BodyKind::deformable ? kGravity * body.mass : 0.0;
  CHECK(fastest_node(world) < 1e-3);
  CHECK(judge_overlap(world.bodies()).penetration < 1e-4 * 0.2);
  // what the floor bears: contacts of the plane, mean over a few frames, since a residual of the solver leaves a
  // tremble
  double force = 0.0;
  const int frames = 20;
  for (int i = 0; i < frames; ++i) {
    world.step();
    force -= contact_force_on(world, 0).y() / frames;
  }
  CHECK(force == Approx(weight).epsilon(1e-3));
}

}  // namespace

TEST_CASE("a deformable cube comes to rest on a floor and weighs what it weighs") {
  for (const double young : {1e4, 1e7}) check_rest(young, 3, false, 6.0, 2);
}

TEST_CASE("a deformable cube rests, every stiffness, ten seconds", "[long]") {
  for (const double young : {1e4, 1e5, 1e6, 1e7}) check_rest(young, 4, false, 10.0, 2);
}

TEST_CASE("two stacked deformable cubes come to rest") {
  for (const double young : {1e5, 1e6}) check_rest(young, 3, true, 3.0, 2);
}

TEST_CASE("two stacked deformable cubes rest, every stiffness, ten seconds", "[long]") {
  for (const double young : {1e4, 1e5, 1e6, 1e7}) check_rest(young, 3, true, 10.0, 2);
}

TEST_CASE("every integrator brings a deformable cube to rest on a floor") {
  for (const auto& e : integrators()) {
    CAPTURE(e.name);
    World world;
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(soft_cube("cube", 0.2, 3, {0, 0.002, 0}, {1e5, 0.3, 1000.0, 2e-3, "corotational"}));
    world.parameters.simulation.integrator = e.name;
    world.parameters.simulation.substeps = e.name == "symplectic_euler" ? 24 : 4;
    world.parameters.simulation.sleeping = false;
    world.start();
    run(world, 120);
    double force = 0.0;
    for (int i = 0; i < 60; ++i) {
      world.step();
      force += contact_force_on(world, 1).y() / 60;
    }
    // Newmark's rule gives the impulse half of a step's weight to either end of it: only the mean is the weight
    CHECK(force == Approx(kGravity * world.bodies()[1].mass).epsilon(1e-2));
    CHECK(judge_overlap(world.bodies()).penetration < 1e-4 * 0.2);
    CHECK(fastest_node(world) < 2e-2);
  }
}

TEST_CASE("a deformable cube that nothing presses is at its root at once, whatever the implicit integrator") {
  for (const Entry<DeformableIntegrator>& scheme : integrators())
    for (const double gap : {0.0, 1e-4})
      for (const double gravity : {0.0, 1e-9}) {
        CAPTURE(scheme.name, gap, gravity);
        World world;
        world.parameters.simulation.integrator = scheme.name;
        if (world.parameters.simulation.integrator->is_explicit()) continue;
        world.parameters.simulation.sleeping = false;
        world.parameters.simulation.gravity = {0.0, -gravity, 0.0};
        world.add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
        SoftOptions options;
        options.young = 1e5;
        options.damping_beta = 0.01;
        world.add_body(soft_cube("cube", 0.2, 4, {-0.1, gap, -0.1}, options));
        world.start();
        for (int i = 0; i < 3; ++i) {
          world.step();
          CHECK(world.record().stats.unconverged == 0);
          CHECK(std::abs(world.bodies()[BodyIndex(1)].twist().linear.y()) <= 1.01 * gravity * world.time() + 1e-15);
        }
      }
}

TEST_CASE("deformable and rigid bodies share a group: a box on a soft cube, a soft cube under a box") {
  World world;
  world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
  world.add_body(soft_cube("soft", 0.2, 3, {0, 0.0005, 0}, {1e6, 0.4, 1000.0, 0.01, "corotational"}));
  BodyDescription box = cube("box", 0.16, {0.1, 0.282, 0.1});
  world.add_body(box);
  world.parameters.simulation.sleeping = false;
  world.start();
  run(world, 90);
  const double weight = kGravity * (world.bodies()[1].mass + world.bodies()[2].mass);
  CHECK(world.record().groups.size() == 1);
  double floor = 0.0, box_force = 0.0;
  const int frames = 60;
  for (int i = 0; i < frames; ++i) {
    world.step();
    floor -= contact_force_on(world, 0).y() / frames;
    box_force += contact_force_on(world, 2).y() / frames;
  }
  CHECK(floor == Approx(weight).epsilon(1e-3));
  CHECK(box_force == Approx(kGravity * world.bodies()[2].mass).epsilon(1e-3));
  CHECK(judge_overlap(world.bodies()).penetration < 2e-5);
}

namespace {

BodyDescription damped_cube() {
  BodyDescription d = soft_cube("hung", 0.2, 3, {0, 0, 0}, {1e5, 0.4, 1000.0, 0.02, "corotational"});
  auto soft = std::make_shared<DeformableDescription>(*d.deformable);
  soft->damping.alpha = 4.0;  // stills the swing about the hook that the lattice's own slant begins
  d.deformable = soft;
  return d;
}

}  // namespace

TEST_CASE("damping in proportion to mass takes e^(-alpha t) of a sliding body's momentum, whatever the integrator") {
  constexpr double kAlpha = 3.0, kSpeed = 1.0, kSeconds = 0.5;
  for (const Entry<DeformableIntegrator>& scheme : integrators())
    for (const double beta : {0.0, 0.01}) {
      CAPTURE(scheme.name, beta);
      World world;
      world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
      BodyDescription d = soft_cube("block", 0.2, 2, {0, 0, 0}, {1e5, 0.3, 1000.0, beta, "corotational"});
      auto soft = std::make_shared<DeformableDescription>(*d.deformable);
      soft->damping.alpha = kAlpha;
      d.deformable = soft, d.velocity = kSpeed * Vec3::UnitX();
      world.add_body(d);
      world.parameters.simulation.integrator = scheme.name;
      world.parameters.simulation.sleeping = false;
      world.parameters.contact.friction = 0.0;
      const bool is_explicit = world.parameters.simulation.integrator->is_explicit();
      if (is_explicit) world.parameters.simulation.substeps = 64;
      world.start();
      std::int64_t unsolved = 0;
      for (int frame = 0; frame < static_cast<int>(60 * kSeconds); ++frame) {
        world.step();
        unsolved += world.record().stats.unconverged;
      }
      // of first order they lose less by alpha h / 2 in a second of decay
      const double first = 0.5 * kAlpha * kAlpha * kSeconds * world.parameters.simulation.time_step();
      const double left = deformable(world, 1).momentum().x() / (world.bodies()[1].mass * kSpeed);
      CHECK(left == Approx(std::exp(-kAlpha * kSeconds)).epsilon(1.1 * first));
      CHECK(unsolved == 0);
    }
}

TEST_CASE("an attachment carries a hanging body, rigid or deformable, and its impulse is the weight") {
  for (const bool soft : {false, true}) {
    CAPTURE(soft);
    World world;
    if (soft)
      world.add_body(damped_cube());
    else
      world.add_body(cube("hung", 0.2, {0.1, 0.1, 0.1}));
    world.add_attachment({"hook", "hung", "", {0.1, 0.2, 0.1}});
    world.parameters.simulation.sleeping = false;
    world.start();
    run(world, 180);
    const AttachmentRecord& hook = world.record().attachments[0];
    CHECK((hook.point_a - Vec3(0.1, 0.2, 0.1)).norm() < 1e-8);
    const Vec3 force = hook.impulse / world.parameters.simulation.time_step();
    CHECK(force.y() == Approx(kGravity * world.bodies()[0].mass).epsilon(1e-3));
    CHECK(std::hypot(force.x(), force.z()) < 1e-3 * force.y());
  }
}

TEST_CASE("two bodies joined by an attachment swing as one: total momentum is kept without gravity") {
  World world;
  world.add_body(soft_cube("soft", 0.2, 3, {0, 0, 0}, {1e5, 0.4, 1000.0, 0.0, "corotational"}));
  BodyDescription box = cube("box", 0.2, {0.3, 0.1, 0.1});
  box.velocity = {0, 1, 0.5};
  world.add_body(box);
  world.add_attachment({"pin", "box", "soft", {0.2, 0.1, 0.1}});
  world.parameters.simulation.gravity.setZero();
  world.parameters.lcp.tolerance = 1e-13;
  world.parameters.simulation.linear_solver = "simplicial_llt";  // iterations leave forces that don't sum to zero
  world.start();
  const Vec3 before = world.record().stats.momentum;
  run(world, 60);
  CHECK((world.record().stats.momentum - before).norm() < 1e-9 * before.norm());
  const AttachmentRecord& pin = world.record().attachments[0];
  CHECK((pin.point_a - pin.point_b).norm() < 1e-3);  // a rigid body's point turns on a circle: second order in the step
}

TEST_CASE("held nodes follow their key frames exactly and pull the body along") {
  World world;
  BodyDescription bar =
      soft_box("bar", {0.3, 0.1, 0.1}, {6, 2, 2}, {0, 0, 0}, {1e5, 0.3, 1000.0, 0.02, "corotational"});
  auto soft = std::make_shared<DeformableDescription>(*bar.deformable);
  NodeRegion left, right;
  left.min = {-0.01, -1, -1}, left.max = {0.001, 1, 1};
  right.min = {0.299, -1, -1}, right.max = {0.31, 1, 1};
  right.motion = {{0.0, Vec3::Zero(), Vec3::Zero()}, {0.5, {0.03, 0, 0}, {90, 0, 0}}};
  soft->fixed = {left, right};
  bar.deformable = soft;
  world.add_body(bar);
  world.parameters.simulation.gravity.setZero();
  world.start();
  run(world, 60);
  const DeformableBody& fem = deformable(world, 0);
  CHECK(fem.free_nodes() == 7 * 9 - 18);
  for (int i = 0; i < fem.nodes(); ++i) {
    const Vec3 rest = fem.rest_position(i), now = fem.position.segment<3>(3 * i);
    if (rest.x() < 1e-9) CHECK((now - rest).norm() < 1e-12);
    if (rest.x() > 0.299) {  // a quarter turn about the x axis through the middle of the face, and 3 cm along
      const Vec3 d = rest - Vec3(0.3, 0.05, 0.05);
      CHECK((now - Vec3(0.33, 0.05 - d.z(), 0.05 + d.y())).norm() < 1e-12);
    }
  }
  CHECK(fem.velocity.cwiseAbs().maxCoeff() < 1e-3);  // held again, at rest
  // the middle is stretched and turned by half of it
  const Body& body = world.bodies()[0];
  CHECK(body.center_of_mass().x() == Approx(0.165).epsilon(2e-2));
}

TEST_CASE("a parameter moves held nodes evenly over a frame, materials change between frames") {
  World world;
  BodyDescription bar =
      soft_box("bar", {0.3, 0.1, 0.1}, {3, 1, 1}, {0, 0, 0}, {1e5, 0.3, 1000.0, 0.02, "corotational"});
  auto soft = std::make_shared<DeformableDescription>(*bar.deformable);
  NodeRegion left;
  left.min = {-0.01, -1, -1}, left.max = {0.001, 1, 1};
  soft->fixed = {left};
  bar.deformable = soft;
  world.add_body(bar);
  world.parameters.simulation.gravity.setZero();
  ParameterSet rows;
  world.bind_bodies(rows);
  world.start();
  rows.find("body.bar.fixed_0.displacement")->set(Vec3(0, 0.01, 0));
  world.parameters_changed();
  world.step();
  const DeformableBody& fem = deformable(world, 0);
  const int node = deformable(world, 0).held[0].nodes[0];
  CHECK(Vec3(fem.position.segment<3>(3 * node)).y() == Approx(fem.rest_position(node).y() + 0.01).margin(1e-12));
  CHECK(Vec3(fem.velocity.segment<3>(3 * node)).y() == Approx(0.01 * 60).epsilon(1e-9));
  world.step();
  CHECK(Vec3(fem.velocity.segment<3>(3 * node)).norm() == 0.0);
  rows.find("body.bar.material.young")->set(2e5);
  CHECK(deformable(world, 0).material->settings().young == 2e5);
  // twice as stiff: twice the energy in the same shape
  DeformableBody& body = deformable(world, 0);
  const double stiff = body.elastic_energy();
  rows.find("body.bar.material.young")->set(1e5);
  CHECK(stiff == Approx(2.0 * body.elastic_energy()).epsilon(1e-12));
}

TEST_CASE("a deformable cube sleeps, is woken by what falls on it, and a snapshot goes on bit for bit") {
  const auto make = [](World& world) {
    world.add_body(fixed_plane("floor", Vec3::UnitY(), 0));
    world.add_body(soft_cube("cube", 0.2, 3, {0, 0.001, 0}, {1e5, 0.4, 1000.0, 0.02, "corotational"}));
    world.add_body(dynamic_body("ball", Sphere{0.05}, {0.1, 6.0, 0.1}));
    world.start();
  };
  World world;
  make(world);
  run(world, 60);
  CHECK(world.bodies()[1].asleep);
  ByteWriter saved;
  world.save(saved);
  run(world, 30);
  CHECK_FALSE(world.bodies()[1].asleep);
  World again;
  make(again);
  ByteReader reader(saved.bytes());
  again.restore(reader);
  run(again, 30);
  CHECK(again.record().stats.state_hash == world.record().stats.state_hash);
}

TEST_CASE("a deformable body that touches itself stays out of itself") {
  // an open ring, cut at one side, squeezed until its ends meet: a C of lattice cells between two moved ends
  const auto run_case = [](bool self_collision) {
    TetMesh block = make_tet_box({0.3, 0.02, 0.05}, 24, 2, 2);
    const double radius = 0.3 / (1.7 * M_PI);  // bends the bar into 306 degrees of a ring
    for (Vec3& v : block.vertices) {
      const double angle = v.x() / radius, r = radius - v.y();  // inside out would turn every element over
      v = {r * std::sin(angle), -r * std::cos(angle), v.z()};
    }
    World world;
    BodyDescription d =
        soft_box("ring", {0.3, 0.02, 0.05}, {24, 2, 2}, {0, 0, 0}, {1e5, 0.3, 1000.0, 0.02, "corotational"});
    auto soft = std::make_shared<DeformableDescription>(*d.deformable);
    soft->mesh = block;
    TriangleMesh skin = boundary_surface(block);
    soft->embedding = embed(block, skin.vertices);
    NodeRegion first, last;
    first.kind = last.kind = NodeRegion::list;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        first.nodes.push_back((k * 3 + j) * 25);
        last.nodes.push_back((k * 3 + j) * 25 + 12);
      }
    // the middle is held, the first end is driven through the place where the other end is
    first.motion = {{0.0, Vec3::Zero(), Vec3::Zero()}, {0.5, {-0.06, 0.025, 0}, {0, 0, 0}}};
    soft->fixed = {last, first};
    d.shape = surface(std::move(skin));
    d.deformable = soft;
    d.self_collision = self_collision;
    world.add_body(d);
    world.parameters.simulation.gravity.setZero();
    world.start();
    std::int64_t contacts = 0;
    for (int i = 0; i < 40; ++i) {
      world.step();
      contacts = std::max(contacts, world.record().stats.contacts);
    }
    // independent truth: surface vertices of the far end inside the near end's tetrahedra
    const DeformableBody& fem = deformable(world, 0);
    int inside = 0;
    for (int v = 0; v < fem.nodes(); ++v) {
      if (v % 25 < 18) continue;
      const Vec3 x = fem.position.segment<3>(3 * v);
      for (const Tet& t : fem.fem.rest().tets) {
        if (t[0] % 25 > 8) continue;
        Vec3 p[4];
        for (int k = 0; k < 4; ++k) p[k] = fem.position.segment<3>(3 * t[k]);
        if (barycentric(x, p[0], p[1], p[2], p[3]).minCoeff() > 1e-3) {
          ++inside;
          break;
        }
      }
    }
    return std::pair(contacts, inside);
  };
  const auto [none, through] = run_case(false);
  CHECK(none == 0);
  CHECK(through > 0);  // the case is one: without self-collision the ends pass through each other
  const auto [contacts, inside] = run_case(true);
  CHECK(contacts > 0);
  CHECK(inside == 0);
}

TEST_CASE("a soft ball that falls on the point of a cone stays outside of it") {
  // the point makes a dent, and is below no face there: it went 38 mm in
  for (const int substeps : {1, 4})
    for (const double speed : {1.0, 2.0}) {
      CAPTURE(substeps, speed);
      World world;
      world.parameters.simulation.substeps = substeps;
      BodyDescription spike = dynamic_body("spike", cone(0.03, 0.15), {0.0, 0.075, 0.0});
      spike.kind = BodyKind::fixed;
      world.add_body(spike);
      BodyDescription ball =
          soft_cube("ball", 0.11, 6, {-0.052, 0.151, -0.054}, {2e5, 0.4, 1000.0, 0.002, "neo_hookean"});
      auto soft = std::make_shared<DeformableDescription>(*ball.deformable);
      TriangleMesh skin = icosphere(3, 0.05);
      for (Vec3& x : skin.vertices) x += Vec3::Constant(0.055);
      soft->embedding = embed(soft->mesh, skin.vertices);
      ball.shape = surface(std::move(skin));
      ball.deformable = soft;
      ball.velocity = {0.0, -speed, 0.0};
      world.add_body(ball);
      world.start();
      double deepest = 0.0, shown = 0.0;
      std::int64_t contacts = 0;
      for (int i = 0; i < 15; ++i) {
        world.step();
        contacts += world.record().stats.contacts;
        deepest = std::max(deepest, judge_overlap(world.bodies()).deepest);
        shown = std::max(shown, world.record().stats.max_penetration);
      }
      CHECK(deepest < 1e-4);
      CHECK(shown < 2e-4);
      CHECK(contacts > 3);
    }
}
