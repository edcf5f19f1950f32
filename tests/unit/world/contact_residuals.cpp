// The residual that a record gives each contact, against Coulomb's law evaluated here from what two records show.
#include <catch2/catch.hpp>

#include <map>

#include "engine/contact/contact_frame.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/mechanics/worlds.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Moving {
  Pose pose;
  Vec3 velocity, spin;
};

/// Cubes, whose inertia is a multiple of the identity: what turns them goes on as it is between records.
std::vector<Moving> motions(const StepRecord& record) {
  std::vector<Moving> all;
  for (const BodyRecord& b : record.bodies) all.push_back({b.pose, b.velocity, b.angular_velocity});
  return all;
}

/// The nearest point of the cone |t| <= mu n.
Vec3 on_cone(const Vec3& x, double mu) {
  const double t = std::hypot(x.y(), x.z());
  if (t <= mu * x.x()) return x;
  if (mu * t <= -x.x()) return Vec3::Zero();
  const double n = (x.x() + mu * t) / (1.0 + mu * mu);
  return {n, mu * n * x.y() / t, mu * n * x.z() / t};
}

}  // namespace

TEST_CASE("each contact's residual is its natural map by the group's largest velocity, from the record's own numbers") {
  // by rows that ask of a contact what its gap says, and no more where bodies turn
  int measured = 0;
  for (const auto& [method, iterations] :
       {std::pair("sequential_impulse", 1), {"sequential_impulse", 4}, {"simultaneous_impulse", 3}}) {
    CAPTURE(method, iterations);
    World world;
    world.add_body(fixed_plane("floor", Vec3(0.1, 1.0, 0.05), 0.0));
    const double size = 0.3;
    for (int i = 0; i < 2; ++i) {
      BodyDescription d = cube("c" + std::to_string(i), size, Vec3(2.0 * i, 0.2 + 0.02 * i, 0));
      d.rotation = Vec3(4.0 * i, 0, 3);
      d.velocity = Vec3(1, -1, 0.5 * i);
      d.angular_velocity = Vec3(0, 2, 1);
      world.add_body(d);
    }
    world.parameters.simulation.substeps = 1;
    world.parameters.response.method = method;
    allow_iterations(world, iterations);
    set(world, "narrow_phase.continuous", "off");  // no step in pieces: it begins where the record before ends
    set(world, "contact.push_out", "velocity");    // no motion beside that of the velocities
    set(world, "contact.max_push_out", 1e3);
    set(world, "contact.restitution", 0.0);
    set(world, "contact.friction", 0.4);
    set(world, "contact.turning_solves", 0);
    world.start();
    const double h = world.parameters.simulation.time_step();
    for (int frame = 0; frame < 25; ++frame) {
      const std::vector<Moving> before = motions(world.record());
      world.step();
      const StepRecord& record = world.record();
      const std::vector<Moving> after = motions(record);
      std::map<GroupIndex, double> scale;
      std::vector<double> maps;
      for (const ContactRecord& c : record.contacts) {
        const auto at_start = [&](BodyIndex b, const Vec3& point) {
          return before[b.value()].pose.apply(after[b.value()].pose.apply_inverse(point));
        };
        const Vec3 common = 0.5 * (at_start(c.body_a, c.point_a) + at_start(c.body_b, c.point_b));
        const auto velocity = [&](BodyIndex b, bool is_solved) -> Vec3 {
          const Moving& now = is_solved ? after[b.value()] : before[b.value()];
          if (record.bodies[b].mass == 0.0) return Vec3::Zero();
          const Vec3 free = is_solved ? Vec3::Zero() : Vec3(h * record.gravity);
          return now.velocity + free + now.spin.cross(common - before[b.value()].pose.position);
        };
        const Mat3 axes = contact_axes(c.normal);
        const Vec3 bound(-c.gap0 / h, 0, 0);
        const Vec3 u = axes * (velocity(c.body_a, true) - velocity(c.body_b, true)) - bound,
                   asked = axes * (velocity(c.body_a, false) - velocity(c.body_b, false)) - bound;
        double trace = 0.0;
        for (const BodyIndex b : {c.body_a, c.body_b}) {
          const double mass = record.bodies[b].mass;
          if (mass == 0.0) continue;
          const double inertia = mass * size * size / 6.0;
          trace += 3.0 / mass + 2.0 * (common - before[b.value()].pose.position).squaredNorm() / inertia;
        }
        const double rho = 3.0 / trace, mu = c.friction;
        const Vec3 raised(u.x() + mu * std::hypot(u.y(), u.z()), u.y(), u.z());
        maps.push_back((c.lambda - on_cone(c.lambda - rho * raised, mu)).norm() / rho);
        scale[c.group] = std::max(scale[c.group], asked.norm());
      }
      double most = 0.0;
      for (std::size_t i = 0; i < maps.size(); ++i) {
        const double wanted = maps[i] / scale[record.contacts[i].group], found = record.contacts[i].residual;
        CAPTURE(frame, i);
        CHECK(found == Approx(wanted).epsilon(1e-6).margin(1e-9));
        most = std::max(most, found);
        measured += wanted > 1e-6;
      }
      CHECK(most == Approx(record.stats.residual_coulomb).epsilon(1e-12).margin(0.0));
    }
  }
  CHECK(measured > 50);
}

TEST_CASE("a contact's residual is in the state that is saved, and nothing at frame 0") {
  World world, other;
  for (World* w : {&world, &other}) {
    w->add_body(fixed_plane("floor", Vec3::UnitY(), 0.0));
    w->add_body(cube("a", 0.3, Vec3(0, 0.151, 0)));
    w->parameters.response.method = "sequential_impulse";
    allow_iterations(*w, 1);
    w->start();
    for (const ContactRecord& c : w->record().contacts) CHECK(c.residual == 0.0);
  }
  run(world, 5);
  REQUIRE_FALSE(world.record().contacts.empty());
  ByteWriter state;
  world.save(state);
  ByteReader in(state.bytes());
  other.restore(in);
  for (std::size_t i = 0; i < world.record().contacts.size(); ++i)
    CHECK(other.record().contacts[i].residual == world.record().contacts[i].residual);
}
