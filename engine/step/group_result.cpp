#include "engine/step/group_result.hpp"

namespace impinge {

SolvedContact unsolved_contact(const Collision& collision, const MaterialPoint& a, const MaterialPoint& b,
                               double friction, const Bodies& bodies) {
  SolvedContact contact;
  contact.collision = collision;
  contact.point_a = a;
  contact.point_b = b;
  contact.local_normal = collision.normal;
  if (!collision.normal_owner.is_none())
    contact.local_normal = bodies[collision.normal_owner].pose.rotation.transpose() * collision.normal;
  contact.friction = friction;
  return contact;
}

double gap_of(const SolvedContact& contact, const Bodies& bodies) {
  const Collision& c = contact.collision;
  return normal_of(contact, bodies)
      .dot(bodies[c.body_a].position_of(contact.point_a) - bodies[c.body_b].position_of(contact.point_b));
}

Vec3 normal_of(const SolvedContact& contact, const Bodies& bodies) {
  const BodyIndex owner = contact.collision.normal_owner;
  return owner.is_none() ? contact.collision.normal : Vec3(bodies[owner].pose.rotation * contact.local_normal);
}

}  // namespace impinge
