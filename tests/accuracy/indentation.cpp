// A rigid ball pressed into a slab that is bonded to its bed, against a published formula for thin layers, which is
// Hertz' where the ball's contact is small beside the slab's thickness [Dimitriadis02].
#include <catch2/catch.hpp>

#include <numbers>

#include "engine/shapes/primitives.hpp"
#include "tests/support/mechanics/deformable_bodies.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kYoung = 1e5, kThickness = 0.1, kWidth = 0.3, kBall = 2.0, kDepth = 8e-4;

/// Force of a ball of radius r that is pressed into a bonded layer of thickness h by d, N.
double bonded_layer(double young, double nu, double r, double d, double h) {
  const double pi = std::numbers::pi, chi = std::sqrt(r * d) / h;
  const double a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu),
               b = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1.0 - nu);
  const double thin = 1.0 - 2.0 * a / pi * chi + 4.0 * a * a / (pi * pi) * chi * chi -
                      8.0 / std::pow(pi, 3) * (std::pow(a, 3) + 4.0 * pi * pi / 15.0 * b) * std::pow(chi, 3) +
                      16.0 * a / std::pow(pi, 4) * (std::pow(a, 3) + 3.0 * pi * pi / 5.0 * b) * std::pow(chi, 4);
  return 4.0 * young / (3.0 * (1.0 - nu * nu)) * std::sqrt(r) * std::pow(d, 1.5) * thin;
}

/// The same of a slab of elements, `cells` of them in its thickness, at rest.
double pressed(ElementKind element, int cells, double nu) {
  World world;
  BodyDescription slab =
      soft_box("slab", {kWidth, kThickness, kWidth}, {3 * cells, cells, 3 * cells}, {-0.5 * kWidth, 0.0, -0.5 * kWidth},
               {kYoung, nu, 1000.0, 0.05, "corotational", element});
  auto soft = std::make_shared<DeformableDescription>(*slab.deformable);
  NodeRegion bed;
  bed.min = {-1, -1, -1}, bed.max = {1, 1e-6, 1};
  soft->fixed = {bed};
  slab.deformable = soft;
  world.add_body(slab);
  BodyDescription ball;
  ball.name = "ball", ball.kind = BodyKind::scripted, ball.shape = Sphere{kBall};
  ball.position = {0, kThickness + kBall, 0};
  ball.motion = {{0.0, ball.position, {0, 0, 0}}, {0.25, ball.position - Vec3(0, kDepth, 0), {0, 0, 0}}};
  world.add_body(ball);
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = 1;
  world.parameters.contact.friction = 0.0;
  world.start();
  run(world, 40);
  CHECK(world.record().stats.unconverged == 0);
  return contact_force_on(world, 1).y();
}

}  // namespace

TEST_CASE("a ball pressed into a slab of quadratic elements meets a thin layer's force, near Poisson's ratio 0.5 too") {
  for (const double nu : {0.3, 0.499}) {
    CAPTURE(nu);
    const double wanted = bonded_layer(kYoung, nu, kBall, kDepth, kThickness);
    CHECK(pressed(ElementKind::quadratic, 4, nu) == Approx(wanted).epsilon(0.07));
  }
  const double wanted = bonded_layer(kYoung, 0.499, kBall, kDepth, kThickness);
  CHECK(pressed(ElementKind::linear, 8, 0.499) > 1.3 * wanted);  // as many nodes: they lock
}
