// Deformable bodies in motion: Vega FEM's yardstick, orders and damping of the integrators, energy, momentum, recovery
// from scrambled elements.
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/geometry/tets/tet_cage.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/closed_form_cube.hpp"
#include "tests/support/mechanics/fem.hpp"

using namespace impinge;
using test::BodyOptions;

namespace {

std::unique_ptr<DeformableIntegrator> integrator(std::string_view name) {
  return find_entry(integrators(), name)->make();
}

/// Newton's method, where the scheme has one.
void tighten(DeformableIntegrator& scheme, const char* tolerance) {
  if (scheme.newton() != nullptr) configure(scheme, std::vector<RowText>{{"tolerance", tolerance}});
}

/// Steps a body for `time` seconds and calls `watch` after each step.
template <class Watch>
void run(const DeformableIntegrator& scheme, DeformableBody& body, const Vec3& gravity, double h, double time,
         Watch&& watch, std::string_view solver_name = "conjugate_gradient", double tolerance = 1e-10) {
  const auto solver = make_linear_solver(solver_name);
  solver->tolerance = tolerance;
  solver->analyze(*body.free_pattern());
  const int steps = static_cast<int>(std::lround(time / h));
  DeformableStep step;
  for (int i = 0; i < steps; ++i) {
    advance_alone(scheme, body, gravity, h, *solver, step);
    watch(step);
  }
}

DeformableBody vega_cube(const BodyOptions& options) {
  DeformableBody body = test::make_body(make_tet_box(Vec3::Ones(), 8, 8, 8), options);
  body.damping = {0.0, 0.01};
  body.hold(test::nodes_where(body, [](const Vec3& p) { return p.x() == 0.0; }));
  return body;
}

/// The height of its corner (1, 1, 1) above where it was, after each of 100 steps.
std::vector<double> vega_tips(const BodyOptions& options, std::string_view solver) {
  DeformableBody body = vega_cube(options);
  std::vector<double> tips;
  run(
      *integrator("linearly_implicit_euler"), body, Vec3(0, -9.81, 0), 0.01, 1.0,
      [&](const DeformableStep& step) {
        REQUIRE(step.converged);
        tips.push_back(body.position[3 * (body.nodes() - 1) + 1] - 1.0);
      },
      solver, 1e-8);
  return tips;
}

double vega_tip(const BodyOptions& options, std::string_view solver) { return vega_tips(options, solver).back(); }

/// A bar of 1 × 0.2 × 0.2 m, held at x = 0, E 1e6, ν 0.3: at rest, but moving in its lowest mode, `speed` at the tip.
struct Bar {
  DeformableBody body;
  double omega;
};
Bar plucked_bar(std::string_view material, double speed, MassKind mass = MassKind::consistent) {
  DeformableBody body = test::make_body(make_tet_box(Vec3(1, 0.2, 0.2), 10, 2, 2),
                                        {.material = material, .young = 1e6, .poisson = 0.3, .mass = mass});
  body.hold(test::nodes_where(body, [](const Vec3& p) { return p.x() == 0.0; }));
  const test::Mode mode = test::lowest_mode(body, "simplicial_llt", 80);
  body.velocity = speed * mode.shape / mode.shape.tail<3>().norm();
  return {std::move(body), mode.omega};
}

/// Cube of 0.2 m, `cells` a side, every node at a random place in it; seed 0 leaves it at rest.
DeformableBody scrambled_cube(int cells, std::string_view material, std::uint64_t seed, double young = 1e5,
                              double poisson = 0.45) {
  const double size = 0.2;
  DeformableBody body =
      test::make_body(make_tet_box(Vec3::Constant(size), cells, cells, cells),
                      {.material = material, .young = young, .poisson = poisson, .mass = MassKind::lumped});
  body.damping = {1.0, 0.02};
  test::Random random(seed);
  if (seed != 0)
    for (int i = 0; i < body.nodes(); ++i)
      body.position.segment<3>(3 * i) = Vec3::Constant(0.5 * size) + 0.5 * size * random.vector();
  return body;
}

/// Runs it for 20 s: no NaN on the way, then all volumes right and the shape that of rest up to a rigid motion.
bool returns_to_rest(DeformableBody& body, std::string_view scheme, double h) {
  run(
      *integrator(scheme), body, Vec3::Zero(), h, 20.0,
      [&](const DeformableStep&) { REQUIRE(body.position.allFinite()); }, "simplicial_llt");
  const double volume = body.smallest_volume_ratio(), distance = test::distance_from_rest(body) / 0.2;
  CAPTURE(volume, distance);
  CHECK(volume > 0.999);
  CHECK(distance < 1e-6);
  return volume > 0.999 && distance < 1e-6;
}

double total_energy(DeformableBody& body) { return body.kinetic_energy() + body.elastic_energy(); }

}  // namespace

TEST_CASE("Vega FEM's clamped cube: the same tip displacement") {
  // Vega 4.0, consistent mass, unit cube of 8³ cells; figures it printed to six digits
  CHECK(vega_tip({}, "conjugate_gradient") == Approx(-0.115675).epsilon(1e-5));
  CHECK(vega_tip({.tangent = Tangent::exact}, "conjugate_gradient") == Approx(-0.115781).epsilon(1e-5));
  CHECK(vega_tip({.mass = MassKind::lumped}, "conjugate_gradient") == Approx(-0.110).epsilon(0.005));
  // with its exact tangent StVK collapses in exactly the way Vega's does
  CHECK(vega_tip({.material = "stvk", .tangent = Tangent::exact}, "conjugate_gradient") ==
        Approx(-0.925736).epsilon(1e-5));
}

TEST_CASE("a neo-Hookean clamped cube: by tangent while it falls, one value at rest, that of a second implementation") {
  // One linearized step of h = 0.01 s is far from converged while the tip moves by millimetres a step: what it says at
  // t = 1 s depends on the tangent.
  const std::vector<double> exact = vega_tips({.material = "neo_hookean", .tangent = Tangent::exact}, "simplicial_llt"),
                            projected =
                                vega_tips({.material = "neo_hookean", .tangent = Tangent::projected}, "simplicial_llt");
  CHECK(exact.back() == Approx(-0.1111).margin(1e-4));
  CHECK(projected.back() == Approx(-0.1173).margin(1e-4));
  CHECK(exact[98] - exact[99] == Approx(5.7e-3).epsilon(0.05));

  // at rest nothing depends on it
  double residual = 0.0;
  const std::vector<Vec3> rest =
      test::neo_hookean_rest(make_tet_box(Vec3::Ones(), 8, 8, 8), 1e5, 0.4, 1000.0, -9.81, residual);
  REQUIRE(residual < 1e-9);
  CHECK(rest.back().y() - 1.0 == Approx(-0.276923).epsilon(1e-5));
  for (const Tangent tangent : {Tangent::exact, Tangent::projected}) {
    DeformableBody body = vega_cube({.material = "neo_hookean", .tangent = tangent});
    test::solve_static(body, applied_force(body, Vec3(0, -9.81, 0)));
    const auto farthest = [&] {
      double most = 0.0;
      for (int i = 0; i < body.nodes(); ++i)
        most = std::max(most, (Vec3(body.position.segment<3>(3 * i)) - rest[static_cast<std::size_t>(i)]).norm());
      return most;
    };
    CHECK(farthest() < 1e-9);
    body.velocity.setZero();
    run(
        *integrator("linearly_implicit_euler"), body, Vec3(0, -9.81, 0), 0.01, 0.1, [](const DeformableStep&) {},
        "simplicial_llt");
    CHECK(farthest() < 1e-9);
  }
}

TEST_CASE("backward Euler and Newmark damp a linear vibration by their own formulas") {
  const auto [start, omega] = plucked_bar("linear", 0.01);
  const double h = 0.1 / omega, energy = start.kinetic_energy();
  for (const char* name : {"linearly_implicit_euler", "implicit_euler"}) {
    DeformableBody body = start;
    auto scheme = integrator(name);
    tighten(*scheme, "1e-12");
    run(
        *scheme, body, Vec3::Zero(), h, 100.0 * h, [](const DeformableStep&) {}, "simplicial_llt");
    // amplitude a step 1/√(1 + (ωh)²): 0.6080 after 100
    CHECK(std::sqrt(total_energy(body) / energy) == Approx(std::pow(1.0 + 0.01, -50.0)).epsilon(1e-3));
  }
  DeformableBody body = start;
  auto newmark = integrator("newmark");
  tighten(*newmark, "1e-12");
  run(
      *newmark, body, Vec3::Zero(), h, 100.0 * h, [](const DeformableStep&) {}, "simplicial_llt");
  CHECK(total_energy(body) == Approx(energy).epsilon(1e-8));
}

TEST_CASE("Newmark keeps the energy of a free vibration of finite amplitude, backward Euler's loss is reported") {
  for (const char* material : {"corotational", "neo_hookean"}) {
    CAPTURE(material);
    const auto [start, omega] = plucked_bar(material, 2.0);
    const double energy = start.kinetic_energy(), period = 2.0 * M_PI / omega, h = period / 50.0;
    DeformableBody body = start;
    double least = energy, most = energy, largest = 0.0;
    run(*integrator("newmark"), body, Vec3::Zero(), h, 10.0 * period, [&](const DeformableStep& step) {
      REQUIRE(step.converged);
      const double now = total_energy(body);
      least = std::min(least, now);
      most = std::max(most, now);
      largest = std::max(largest, (Vec3(body.position.tail<3>()) - body.fem.rest().vertices.back()).norm());
    });
    CHECK(largest > 0.1);  // a tenth of the length: not a small vibration
    CHECK(least > 0.99 * energy);
    CHECK(most < 1.01 * energy);
    DeformableBody damped = start;
    run(*integrator("linearly_implicit_euler"), damped, Vec3::Zero(), h, 10.0 * period, [](const DeformableStep&) {});
    WARN(material << ": energy over 10 periods of 50 steps, Newmark " << least / energy << " to " << most / energy
                  << ", backward Euler leaves " << total_energy(damped) / energy);
    // a linear vibration would keep (1 + (2π/50)²)^−500 = 0.04 %
    CHECK(total_energy(damped) < 0.01 * energy);
  }
}

TEST_CASE("convergence in time: backward Euler first order, Newmark second") {
  // one mode of a linear body: its exact motion is (speed/ω) sin ωt
  const auto [start, omega] = plucked_bar("linear", 0.1);
  const double end = 2.0 / omega;
  const VecX truth = start.position + start.velocity / omega * std::sin(omega * end);
  const auto error = [&, &start = start](const char* name, int steps) {
    DeformableBody body = start;
    auto scheme = integrator(name);
    tighten(*scheme, "1e-12");
    run(
        *scheme, body, Vec3::Zero(), end / steps, end, [](const DeformableStep&) {}, "simplicial_llt");
    return (body.position - truth).norm();
  };
  for (const auto& [name, order, coarse] : {std::tuple("linearly_implicit_euler", 1.0, 80),
                                            std::tuple("implicit_euler", 1.0, 80), std::tuple("newmark", 2.0, 25)}) {
    const double first = error(name, coarse), second = error(name, 2 * coarse);
    CAPTURE(name, first, second);
    CHECK(std::log2(first / second) == Approx(order).margin(0.1));
  }
}

TEST_CASE("symplectic Euler is stable below its limit and keeps the energy near, it agrees with the implicit schemes") {
  DeformableBody body = plucked_bar("corotational", 0.5, MassKind::lumped).body, other = body;
  const double energy = total_energy(body), start = 0.5 / 12.0;
  double worst = 0.0;
  run(*integrator("symplectic_euler"), body, Vec3::Zero(), 2e-4, 0.5,
      [&](const DeformableStep&) { worst = std::max(worst, std::abs(total_energy(body) / energy - 1.0)); });
  CHECK(worst < 0.05);
  run(*integrator("newmark"), other, Vec3::Zero(), 1e-3, 0.5, [](const DeformableStep&) {});
  // after some three periods the two differ by their phase errors, small against the amplitude
  CHECK((body.position - other.position).cwiseAbs().maxCoeff() < 0.05 * start);
}

TEST_CASE("a free body keeps its momentum, and falls like a stone") {
  for (const char* name : {"linearly_implicit_euler", "implicit_euler", "newmark", "symplectic_euler"}) {
    CAPTURE(name);
    DeformableBody body = test::make_body(make_tet_box(Vec3(0.2, 0.2, 0.2), 3, 3, 3),
                                          {.material = "neo_hookean", .mass = MassKind::lumped});
    body.damping = {0.0, name == std::string("symplectic_euler") ? 1e-4 : 0.01};
    test::Random random(71);
    for (int i = 0; i < body.nodes(); ++i) {
      const Vec3 spin = Vec3(1, 2, 0.5).cross(body.fem.rest().vertices[i] - Vec3::Constant(0.1));
      body.velocity.segment<3>(3 * i) = Vec3(1, 3, 0) + spin + 0.05 * random.vector();
    }
    const Vec3 p0 = body.momentum(), c0 = body.center_of_mass();
    const double h = name == std::string("symplectic_euler") ? 2e-4 : 0.005;
    const int steps = static_cast<int>(std::lround(0.4 / h));
    run(
        *integrator(name), body, Vec3(0, -9.81, 0), h, 0.4, [](const DeformableStep&) {}, "simplicial_llt");
    const double m = body.fem.total_mass();
    CHECK((body.momentum() - p0 - m * Vec3(0, -9.81 * 0.4, 0)).norm() < 1e-6 * p0.norm());
    // discrete path of the scheme: Euler h²/2 n(n+1), Newmark exact
    const double fall = name == std::string("newmark") ? 0.5 * 0.16 : 0.5 * h * h * steps * (steps + 1);
    CHECK((body.center_of_mass() - c0 - 0.4 * p0 / m - Vec3(0, -9.81 * fall, 0)).norm() < 1e-6);
  }
}

TEST_CASE("held nodes move as they are told, in every scheme") {
  for (const auto& entry : integrators()) {
    CAPTURE(std::string(entry.name));
    for (const MassKind mass : {MassKind::lumped, MassKind::consistent}) {
      DeformableBody body =
          test::make_body(make_tet_box(Vec3(1, 0.2, 0.2), 5, 1, 1), {.young = 1e6, .poisson = 0.3, .mass = mass});
      const bool is_explicit = entry.name == "symplectic_euler";
      body.damping = {0.0, is_explicit ? 1e-4 : 0.1};
      const auto all = test::nodes_where(body, [](const Vec3& p) { return p.x() == 0.0; });
      body.hold(all);
      for (const int i : all) body.set_held_velocity(i, Vec3(0, 0.5, 0));
      const auto scheme = entry.make();
      run(*scheme, body, Vec3::Zero(), is_explicit ? 5e-4 : 0.02, 4.0,
          [](const DeformableStep& s) { REQUIRE(s.converged); });
      for (const int i : all)
        CHECK(body.position[3 * i + 1] == Approx(body.fem.rest().vertices[i].y() + 2.0).epsilon(1e-9));
      if (is_explicit) continue;  // damping enough to end the swing is beyond its stability
      // the swing has ended: the whole bar follows at the same speed, undeformed
      for (int i = 0; i < body.nodes(); ++i) CHECK(body.velocity[3 * i + 1] == Approx(0.5).margin(0.01));
      CHECK(body.elastic_energy() < 1e-4);
    }
  }
}

TEST_CASE("one Newton iteration of implicit_euler from Δq = 0 is the linearly implicit scheme") {
  // A and b as contact will use them: the solve of A v = b reproduces v*
  for (const auto& entry : integrators()) {
    CAPTURE(std::string(entry.name));
    DeformableBody body = plucked_bar("neo_hookean", 1.0, MassKind::lumped).body;
    body.damping = {0.1, 0.005};
    const auto scheme = entry.make();
    tighten(*scheme, "1e-11");
    const auto solver = make_linear_solver("simplicial_llt");
    solver->analyze(*body.free_pattern());
    DeformableStep step;
    scheme->begin(body, Vec3(0, -9.81, 0), 0.002, step);
    scheme->free_velocity(body, step, *solver);
    REQUIRE(step.converged);
    CHECK((step.a * step.v_star - step.b).norm() < 1e-8 * step.b.norm());
    // linearizing at v* gives the same fixed point
    const VecX v = step.v_star;
    scheme->linearize(body, v, step);
    VecX again;
    REQUIRE(solver->factorize(step.a) == SolveStatus::ok);
    solver->solve(step.b, again);
    CHECK((again - v).norm() < 1e-7 * v.norm());
  }
}

TEST_CASE("flattened and collapsed elements, and slightly scrambled ones, return to rest") {
  // all nodes moved at random by up to 0.6 of a cell (a third of the elements inverted), or pressed to a point, a
  // plane, a line
  for (int shape = 0; shape < 6; ++shape) {
    CAPTURE(shape);
    const double size = 0.2, cell = size / 3.0;
    DeformableBody body = scrambled_cube(3, "neo_hookean", 0);
    test::Random random(72 + shape);
    for (int i = 0; i < body.nodes(); ++i) {
      Vec3 p = body.fem.rest().vertices[i];
      if (shape < 3) p += 0.6 * cell * random.vector();
      if (shape == 3) p = Vec3::Constant(0.5 * size);
      if (shape == 4) p.y() = 0.0;
      if (shape == 5) p = Vec3(p.x(), 0.0, 0.0);
      body.position.segment<3>(3 * i) = p;
    }
    if (shape < 3) CHECK(body.smallest_volume_ratio() < -0.5);
    CHECK(returns_to_rest(body, "implicit_euler", 0.05));
  }
}

TEST_CASE("a cube whose nodes are placed at random returns to rest within 20 s") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const int cells : {2, 3}) {
      CAPTURE(seed, cells);
      DeformableBody body = scrambled_cube(cells, "neo_hookean", seed);
      CHECK(body.smallest_volume_ratio() < -1.0);
      CHECK(returns_to_rest(body, "implicit_euler", 0.05));
    }
  // with the seed's one iteration a step, and the other material that is meant to survive inversion
  for (std::uint64_t seed = 7; seed <= 8; ++seed) {
    CAPTURE(seed);
    DeformableBody once = scrambled_cube(3, "neo_hookean", seed), fixed = scrambled_cube(3, "fixed_corotated", seed);
    CHECK(returns_to_rest(once, "linearly_implicit_euler", 0.02));
    CHECK(returns_to_rest(fixed, "implicit_euler", 0.05));
  }
}

TEST_CASE("larger and stiffer cubes return to rest from random places too", "[long]") {
  for (std::uint64_t seed = 11; seed <= 40; ++seed) {
    CAPTURE(seed);
    DeformableBody small = scrambled_cube(2, "neo_hookean", seed), middle = scrambled_cube(3, "neo_hookean", seed);
    CHECK(returns_to_rest(small, "implicit_euler", 0.05));
    CHECK(returns_to_rest(middle, "implicit_euler", 0.05));
  }
  for (std::uint64_t seed = 41; seed <= 43; ++seed) {
    CAPTURE(seed);
    DeformableBody fine = scrambled_cube(6, "neo_hookean", seed);
    CHECK(returns_to_rest(fine, "linearly_implicit_euler", 0.02));
    for (const double young : {1e4, 1e6}) {
      CAPTURE(young);
      DeformableBody other = scrambled_cube(3, "neo_hookean", seed, young, 0.49);
      CHECK(returns_to_rest(other, "implicit_euler", 0.02));
    }
  }
}

TEST_CASE("a cage thrown about returns to rest") {
  // body-centred tetrahedra, partly filled ones among them
  const TetCage cage = make_tet_cage(test::icosphere(2, 0.1), {.cells = 4});
  std::shared_ptr<const Material> material = test::make_material("neo_hookean", 1e5, 0.45);
  DeformableBody body(FemAssembly(cage.mesh, {{material, 1000.0}}, MassKind::lumped, {}, cage.fraction));
  body.damping = {1.0, 0.02};
  test::Random random(91);
  for (int i = 0; i < body.nodes(); ++i) body.position.segment<3>(3 * i) = 0.1 * random.vector();
  CHECK(returns_to_rest(body, "implicit_euler", 0.05));
}

TEST_CASE("a step gives the same bits for any number of threads") {
  VecX first;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    DeformableBody body = plucked_bar("corotational", 1.0).body;
    run(*integrator("linearly_implicit_euler"), body, Vec3(0, -9.81, 0), 0.005, 0.1, [](const DeformableStep&) {});
    if (threads == 1) first = body.position;
    CHECK((first.array() == body.position.array()).all());
  }
  set_thread_count(0);
}
