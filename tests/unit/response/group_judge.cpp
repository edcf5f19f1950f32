// The judge of groups on one body over a held one, where everything is known: a falling mass m on a plane of normal z.
#include "engine/response/group_judge.hpp"

#include <catch2/catch.hpp>

using namespace impinge;

namespace {

constexpr double kMass = 2.0, kSpeed = 3.0;

/// Its row alone, no friction; v is what the body falls with, m/s.
GroupSystem falling(double v, double bound) {
  GroupSystem group;
  group.rigid.push_back({1.0 / kMass, Mat3::Identity(), Vec3(0, 0, -v), Vec3::Zero()});
  ContactRows rows;
  rows.directions << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  rows.a.rigid = 0;
  rows.bound = bound;
  group.contacts.push_back(rows);
  group.lambda.assign(1, Vec3::Zero());
  group.clear_delta();
  return group;
}

void answer(GroupSystem& group, double impulse) {
  group.lambda[0].x() = impulse;
  group.delta_velocity[0] = Vec3(0, 0, impulse / kMass);
}

}  // namespace

TEST_CASE("the relative residual of a group is what is left of the velocity that its contacts ask for") {
  for (const double bound : {0.0, -1.0, 2.5}) {
    CAPTURE(bound);
    GroupSystem group = falling(kSpeed, bound);
    const double asked = kSpeed + bound;
    CHECK(judge_group(group).relative == Approx(1.0));
    answer(group, kMass * asked * (1.0 - 1e-4));
    CHECK(judge_group(group).natural_map == Approx(1e-4 * asked));
    CHECK(judge_group(group).relative == Approx(1e-4));
    answer(group, kMass * asked);
    CHECK(judge_group(group).relative < 1e-14);
  }
}

TEST_CASE("the relative residual doesn't depend on units, and rounding is none") {
  for (const double unit : {1e-6, 1.0, 1e6}) {
    CAPTURE(unit);
    GroupSystem group = falling(kSpeed * unit, 0.0);
    answer(group, 0.75 * kMass * kSpeed * unit);
    CHECK(judge_group(group).relative == Approx(0.25));
  }
  // both fly at 1,000 m/s, and nothing is asked for but the last digit
  GroupSystem group = falling(1000.0, 0.0);
  group.contacts[0].surface.x() = 1000.0 - 1e-13;
  CHECK(judge_group(group).natural_map > 0.0);
  CHECK(judge_group(group).relative == 0.0);
}

TEST_CASE("what a spin's last digit asks for is rounding, and what positions are known to if somebody says so") {
  constexpr double kSpin = 50.0, kArm = 2.0, kDigit = 1e-14;
  GroupSystem group = falling(0.0, 0.0);
  group.rigid[0].angular_velocity = Vec3(0, -kSpin, 0);
  group.contacts[0].a.arm = Vec3(kArm, 0, 0);
  group.contacts[0].surface.x() = -kSpin * kArm - kDigit;
  CHECK(judge_group(group).natural_map > 0.0);
  CHECK(judge_group(group).relative == 0.0);
  group.rigid[0].angular_velocity.setZero();
  group.contacts[0].surface.x() = -kDigit;
  CHECK(judge_group(group).relative == Approx(1.0));
  CHECK(judge_group(group, nullptr, 2.0 * kDigit).relative == 0.0);
  CHECK(judge_group(group, nullptr, 0.5 * kDigit).relative == Approx(1.0));
}
