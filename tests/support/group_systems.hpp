// Groups of rigid bodies as systems, without bodies of a world: for solvers by themselves.
#pragma once

#include "engine/contact/group_system.hpp"
#include "tests/support/random.hpp"

namespace impinge::test {

/// Boxes on one another, in from the left and out to the right, that fall onto the ground with 0.1635 m/s.
inline GroupSystem tower(int levels) {
  GroupSystem group;
  for (int level = 0; level < levels; ++level) {
    RigidBlock block;
    block.inverse_mass = 1e-3;
    block.inverse_inertia = 6e-3 * Mat3::Identity();
    block.velocity = Vec3(0.0, -0.1635, 0.0);
    group.rigid.push_back(block);
    for (int corner = 0; corner < 4; ++corner) {
      ContactRows rows;
      const Vec3 at(corner % 2 ? 0.5 : -0.5, 0.0, corner / 2 ? 0.5 : -0.5);
      rows.a.rigid = level, rows.a.arm = at - Vec3(0.0, 0.5, 0.0);
      rows.b.rigid = level - 1, rows.b.arm = at + Vec3(0.0, 0.5, 0.0);
      rows.directions << 0, 1, 0, 0, 0, 1, 1, 0, 0;
      rows.friction = 0.5;
      group.contacts.push_back(rows);
      group.lambda.push_back(Vec3::Zero());
    }
  }
  return group;
}

/// Bodies in a cloud, each with contacts of any direction with its neighbours and the ground, thrown at one another.
inline GroupSystem heap(Random& random, int bodies, int contacts) {
  GroupSystem group;
  for (int b = 0; b < bodies; ++b) {
    RigidBlock block;
    block.inverse_mass = random.in(0.5, 2.0);
    block.inverse_inertia = random.in(2.0, 9.0) * Mat3::Identity();
    block.velocity = random.in(0.0, 1.0) * random.direction() - Vec3(0.0, 1.0, 0.0);
    group.rigid.push_back(block);
  }
  for (int c = 0; c < contacts; ++c) {
    ContactRows rows;
    const int a = c % bodies, b = a - 1 - random.below(6);
    rows.a.rigid = a, rows.b.rigid = b < 0 ? -1 : b;
    rows.a.arm = 0.5 * random.direction(), rows.b.arm = 0.5 * random.direction();
    const Vec3 n = (Vec3(0.0, 1.0, 0.0) + 0.7 * random.direction()).normalized();
    const Vec3 t = n.unitOrthogonal();
    rows.directions << n.transpose(), t.transpose(), n.cross(t).transpose();
    rows.friction = 0.4;
    group.contacts.push_back(rows);
    group.lambda.push_back(Vec3::Zero());
  }
  return group;
}

}  // namespace impinge::test
