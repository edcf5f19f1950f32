// Edge on edge: a box, or a hull of its corners, strikes another without friction. Two edges that cross give the way of the blow,
// e1 × e2, and rigid body mechanics the rest, however near that way is to a face's.
#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>

#include "engine/geometry/rotation.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Two boxes that touch with an edge each, and the unit way from the first, which stands still, to the second.
struct EdgeBlow {
  Vec3 half[2];
  Vec3 degrees[2];
  Mat3 rotation[2];
  Vec3 position = Vec3::Zero();  // of the second
  Vec3 place = Vec3::Zero(), way = Vec3::Zero();
  double nearest_face = 0.0;  // the largest cosine of the way and a face's normal
};

/// None: those two edges don't keep the boxes apart.
std::optional<EdgeBlow> edge_blow(Random& r) {
  EdgeBlow c;
  for (int k = 0; k < 2; ++k) {
    c.half[k] = Vec3(0.04 + 0.1 * r.u(), 0.04 + 0.1 * r.u(), 0.04 + 0.1 * r.u());
    c.degrees[k] = 180.0 * r.vector();
    c.rotation[k] = rotation_from_degrees(c.degrees[k]);
  }
  const int edge[2] = {static_cast<int>(3.0 * r.u()), static_cast<int>(3.0 * r.u())};
  Vec3 way = c.rotation[0].col(edge[0]).cross(c.rotation[1].col(edge[1]));
  if (way.norm() < 0.2) return std::nullopt;
  way.normalize();
  Vec3 middle[2];
  for (int k = 0; k < 2; ++k) {
    Vec3 corner;
    const Vec3 outwards = (k == 0 ? 1.0 : -1.0) * (c.rotation[k].transpose() * way);
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis] = outwards[axis] > 0.0 ? c.half[k][axis] : -c.half[k][axis];
      c.nearest_face = std::max(c.nearest_face, std::abs(outwards[axis]));
    }
    corner[edge[k]] = 0.8 * r.sym() * c.half[k][edge[k]];
    middle[k] = c.rotation[k] * corner;
  }
  c.place = middle[0], c.position = middle[0] - middle[1], c.way = way;
  return c;
}

}  // namespace

TEST_CASE("edges that cross strike along what is across both, near a face or not") {
  constexpr double kRestitution = 0.3,
                   kUntil = 2.95 / 60.0;  // seconds: soon after it a sub-step ends, before the next blow
  Random r(7);
  int near_face = 0, cases = 0;
  while (cases < 60) {  // half of them near a face
    const std::optional<EdgeBlow> c = edge_blow(r);
    if (!c) continue;
    const bool is_near = c->nearest_face > 0.97;
    if ((is_near ? near_face : cases - near_face) >= 30) continue;
    near_face += is_near ? 1 : 0;
    ++cases;
    const Vec3 velocity = -2.0 * c->way + 0.5 * r.vector();
    for (const bool is_hull : {false, true})
      for (const double rate : {60.0, 240.0, 3840.0}) {
        World world;
        world.parameters.simulation.gravity.setZero();
        world.parameters.simulation.sleeping = false;
        world.parameters.simulation.frame_time = 1.0 / rate;
        world.parameters.simulation.substeps = 1;
        world.parameters.contact.friction = 0.0;
        world.parameters.contact.restitution = kRestitution;
        for (int k = 0; k < 2; ++k) {
          const SharedShape shape =
              is_hull ? SharedShape(made_hull(box_corners(c->half[k]))) : SharedShape(Box(c->half[k]));
          BodyDescription d = k == 0 ? fixed_body("stands", shape) : dynamic_body("strikes", shape, Vec3::Zero());
          d.rotation = c->degrees[k];
          if (k == 1) d.velocity = velocity, d.position = c->position - kUntil * velocity;
          world.add_body(d);
        }
        world.start();
        const RigidBody& body = rigid(world, 1);
        const Vec3 arm = c->place - c->position, turn = arm.cross(c->way);
        const double mobility = 1.0 / body.mass + turn.dot(body.world_inertia().inverse() * turn),
                     impulse = -(1.0 + kRestitution) * c->way.dot(velocity) / mobility;
        const Vec3 due = body.mass * velocity + impulse * c->way;
        for (int frame = 0; body.velocity == velocity && frame < 400; ++frame) world.step();
        CAPTURE(cases, is_hull, rate, c->nearest_face, c->way);
        CHECK((body.mass * body.velocity - due).norm() < 0.01 * impulse);
      }
  }
}
