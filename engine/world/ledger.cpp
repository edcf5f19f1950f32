#include "engine/world/ledger.hpp"

namespace impinge {

Ledger make_ledger(std::span<RigidBody> bodies, const Vec3& gravity) {
  Ledger sum;
  for (RigidBody& body : bodies) {
    if (body.soft) {
      DeformableBody& fem = body.soft->fem;
      sum.kinetic += fem.kinetic_energy();
      sum.elastic += fem.elastic_energy();
      sum.potential += fem.potential_energy(gravity);
      sum.momentum += fem.momentum();
      sum.angular_momentum += fem.angular_momentum();
      continue;
    }
    if (!body.is_dynamic()) continue;
    const Vec3 p = body.mass * body.velocity;
    sum.kinetic += 0.5 * p.dot(body.velocity) + 0.5 * body.angular_momentum.dot(body.angular_velocity());
    sum.potential -= body.mass * gravity.dot(body.pose.position);
    sum.momentum += p;
    sum.angular_momentum += body.pose.position.cross(p) + body.angular_momentum;
  }
  return sum;
}

}  // namespace impinge
