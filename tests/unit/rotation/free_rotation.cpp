// The elliptic functions of free rotation against their integrals, and free rotation where its formulas have a seam.
#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "engine/geometry/rotation.hpp"
#include "engine/rotation/elliptic_functions.hpp"
#include "engine/rotation/free_rotation.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Tanh-sinh quadrature in long double over (0, end): end points may be singular like a square root.
template <class F>
long double integral(long double end, F f) {
  const long double h = 1.0L / 256;
  long double sum = 0;
  for (int i = -1100; i <= 1100; ++i) {
    const long double s = i * h, q = std::exp(-M_PIl * std::sinh(s));  // x = end/(1 + q)
    const long double weight = M_PIl * std::cosh(s) * q / ((1 + q) * (1 + q));
    if (weight < 1e-40L) continue;
    sum += weight * f(end / (1 + q));
  }
  return sum * h * end;
}

/// The same over all t > 0, for what falls at both ends of log t.
template <class F>
long double integral_to_infinity(F f) {
  const long double h = 1.0L / 256;
  long double sum = 0;
  for (int i = -1200; i <= 1200; ++i) {
    const long double s = i * h, t = std::exp(M_PIl / 2 * std::sinh(s));
    sum += M_PIl / 2 * std::cosh(s) * t * f(t);
  }
  return sum * h;
}

PrincipalInertia inertia_of(const Vec3& moments) { return principal_inertia(Mat3(moments.asDiagonal())); }

}  // namespace

TEST_CASE("sn, cn, dn invert the elliptic integral of the first kind") {
  for (const double complement : {1.0, 0.99, 0.5, 1e-2, 1e-6, 1e-14, 1e-30}) {
    const JacobiFunctions functions(complement);
    for (const double part : {1e-9, 1e-3, 0.1, 0.4, 0.8, 0.999, 1.0}) {
      CAPTURE(complement, part);
      const double u = part * functions.quarter_period();
      const auto [sn, cn, dn] = functions.at(u);
      CHECK(sn * sn + cn * cn == Approx(1.0).epsilon(1e-15));
      CHECK(dn * dn == Approx(cn * cn + complement * sn * sn).epsilon(1e-13));
      // u = ∫ dt/√((1 + t²)(1 + k'² t²)) to sn/cn, the form that keeps its digits near k = 1
      if (cn < 1e-3) continue;
      const long double truth = integral(sn / cn, [&](long double t) {
        return 1 / std::sqrt((1 + t * t) * (1 + static_cast<long double>(complement) * t * t));
      });
      CHECK(u == Approx(static_cast<double>(truth)).epsilon(1e-13));
      const auto negative = functions.at(-u);
      CHECK((negative.sn == -sn && negative.cn == cn && negative.dn == dn));
    }
    // K from the mean; by its integral where that is smooth enough, by its limit ln(4/k') where it is not
    const double k = functions.quarter_period();
    if (complement >= 1e-2) {
      const long double truth = integral(M_PIl / 2, [&](long double angle) {
        return 1 / std::sqrt(1 - (1 - static_cast<long double>(complement)) * std::sin(angle) * std::sin(angle));
      });
      CHECK(k == Approx(static_cast<double>(truth)).epsilon(1e-14));
    } else if (complement <= 1e-6) {
      CHECK(k == Approx(std::log(4.0 / std::sqrt(complement))).epsilon(1e-6));
    }
  }
}

TEST_CASE("R_J is its integral") {
  const auto truth = [](long double x, long double y, long double p) {
    return static_cast<double>(
        integral_to_infinity([&](long double t) { return 1.5L / ((t + p) * std::sqrt((t + x) * (t + y) * (t + 1))); }));
  };
  for (const double x : {0.0, 1e-12, 0.3, 0.99})
    for (const double y : {1e-12, 1e-3, 0.4, 1.0})
      for (const double p : {1.0, 1.0000001, 1.7, 40.0, 1e7}) {
        CAPTURE(x, y, p);
        CHECK(carlson_rj(x, y, 1.0, p) == Approx(truth(x, y, p)).epsilon(1e-13));
      }
  // p between the first two, as (p - y)(p - z) >= 0 allows
  CHECK(carlson_rj(0.1, 0.5, 1.0, 0.3) == Approx(truth(0.1, 0.5, 0.3)).epsilon(1e-13));
  CHECK(carlson_rj(0.0, 1e-9, 1.0, 1e-12) == Approx(truth(0.0, 1e-9, 1e-12)).epsilon(1e-12));
  CHECK(carlson_rj(2.0, 2.0, 2.0, 2.0) == Approx(std::pow(2.0, -1.5)).epsilon(1e-15));
}

TEST_CASE("principal axes are those of the matrix, right-handed, moments ascending") {
  Random random(21);
  for (int i = 0; i < 300; ++i) {
    Vec3 moments(random.in(0.1, 1.0), random.in(0.1, 1.0), 1.0);
    if (i % 4 == 1) moments[0] = moments[1];
    if (i % 4 == 2) moments.setConstant(0.7);
    const Mat3 axes = random.rotation(), matrix = axes * moments.asDiagonal() * axes.transpose();
    const PrincipalInertia p = principal_inertia(0.5 * (matrix + matrix.transpose()));
    CHECK((p.moments[0] <= p.moments[1] && p.moments[1] <= p.moments[2]));
    CHECK(p.axes.determinant() == Approx(1.0).epsilon(1e-14));
    CHECK((p.matrix() - matrix).norm() < 1e-14);
    CHECK((p.inverse() * matrix - Mat3::Identity()).norm() < 1e-12);
  }
  // diagonal ones to the last bit, in any order, needles of any ratio among them
  for (const Vec3& moments : {Vec3(3, 1, 2), Vec3(1e24, 1e-3, 1e24), Vec3(2, 2, 1), Vec3(5, 5, 5)}) {
    const PrincipalInertia p = inertia_of(moments);
    CHECK(p.matrix() == Mat3(moments.asDiagonal()));
    CHECK(p.axes.determinant() == 1.0);
  }
  // what rounding has made of a needle's least moment is no moment
  Mat3 needle = Mat3::Zero();
  needle << 1.0, 1e-17, 0.0, 1e-17, 1.0, 0.0, 0.0, 0.0, -1e-17;
  CHECK(principal_inertia(needle).moments[0] == Approx(1e-15));
}

TEST_CASE("about a principal axis a body turns evenly, the middle axis included") {
  const Vec3 moments(1.0, 2.5, 4.0);
  const PrincipalInertia inertia = inertia_of(moments);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0})
      for (const double turn : {1e-200, 1e-9, 0.3, 7.0, 1e5}) {
        CAPTURE(axis, side, turn);
        const Mat3 q = free_rotation(inertia, moments[axis] * side * turn * Vec3::Unit(axis), 1.0);
        CHECK((q - Mat3(Eigen::AngleAxisd(side * turn, Vec3::Unit(axis)))).norm() < 1e-15 + 4e-16 * turn);
      }
}

TEST_CASE("in one step a symmetric body precesses as the closed form says, whatever the ratio of its moments") {
  // Q = exp(m/I) exp((1/J - 1/I) l e): about the momentum m first, then about the body's own axis e, l = m·e
  Random random(24);
  for (const double ratio : {0.5, 1.0 + 1e-14, 3.0, 1e3, 1e6, 1e12})
    for (const double turn : {1e-6, 0.1, 2.0, 20.0, 1e4})
      for (int axis = 0; axis < 3; ++axis) {
        CAPTURE(ratio, turn, axis);
        Vec3 moments = Vec3::Constant(ratio);
        moments[axis] = 1.0;
        const Vec3 momentum = moments.cwiseProduct(turn * random.direction());
        const Mat3 truth = rotation_exp(momentum / ratio) *
                           Eigen::AngleAxisd((1.0 - 1.0 / ratio) * momentum[axis], Vec3::Unit(axis)).toRotationMatrix();
        CHECK((free_rotation(inertia_of(moments), momentum, 1.0) - truth).norm() < 4e-15 * (1.0 + turn));
      }
}

TEST_CASE("a body that is nearly symmetric or nearly on an axis turns nearly as one that is") {
  // what differs by 1e-12 turns by 1e-12 times the angle apart: no branch of the formulas shows
  Random random(22);
  for (const Vec3& moments : {Vec3(1, 1, 3), Vec3(1, 3, 3), Vec3(2, 2, 2), Vec3(1, 2, 3)})
    for (const double small : {1e-8, 1e-12, 1e-15, 1e-16})
      for (int i = 0; i < 30; ++i) {
        CAPTURE(moments.transpose(), small, i);
        Vec3 momentum = 3.0 * random.direction(), near = moments;
        if (i % 3 == 1) momentum = 3.0 * Vec3::Unit(i % 2 * 2);  // the stable axes
        for (int k = 0; k < 3; ++k) near[k] *= 1.0 + small * random.sym();
        const Vec3 other = momentum + small * random.vector();
        const Mat3 a = free_rotation(inertia_of(moments), momentum, 1.0),
                   b = free_rotation(inertia_of(near), other, 1.0);
        CHECK((a - b).norm() < 60.0 * small + 1e-14);
      }
}

TEST_CASE("two steps are one of twice the length, near the separatrix too") {
  // on the separatrix itself, and off it by decades on either side
  const Vec3 moments(1.0, 2.0, 5.0), inverse = moments.cwiseInverse();
  const PrincipalInertia inertia = inertia_of(moments);
  const double slope = std::sqrt((inverse[0] - inverse[1]) / (inverse[1] - inverse[2]));
  for (const double off : {0.0, 1e-15, -1e-15, 1e-10, -1e-10, 1e-5, -1e-5, 1e-2, -1e-2})
    for (const double x : {0.5, 1e-2, 1e-5}) {
      const double z = slope * x * (1.0 + off);
      const Vec3 momentum = 4.0 * Vec3(x, std::sqrt(std::max(0.0, 1.0 - x * x - z * z)), z).normalized();
      for (const double time : {0.1, 1.0, 3.0}) {
        CAPTURE(off, x, time);
        const Mat3 first = free_rotation(inertia, momentum, time);
        const Mat3 second = free_rotation(inertia, first.transpose() * momentum, time);
        const Mat3 whole = free_rotation(inertia, momentum, 2.0 * time);
        // rounding of the state in the middle grows as fast as motions part there: e^(rate time)
        const double rate = 4.0 * std::sqrt((inverse[0] - inverse[1]) * (inverse[1] - inverse[2]));
        CHECK((first * second - whole).norm() < 1e-14 * std::exp(2.0 * rate * time) / x);
        const Vec3 own = whole.transpose() * momentum;
        CHECK(own.dot(own.cwiseProduct(inverse)) ==
              Approx(momentum.dot(momentum.cwiseProduct(inverse))).epsilon(1e-14));
        CHECK((whole * whole.transpose() - Mat3::Identity()).norm() < 1e-14);
      }
    }
}

TEST_CASE("needles of any ratio keep momentum and energy in a step of any length") {
  Random random(23);
  for (const double ratio : {1e6, 1e10, 1e15, 1e24})
    for (const Vec3& moments : {Vec3(1, ratio, ratio), Vec3(1, ratio - 1, ratio), Vec3(1, ratio * (1 - 1e-9), ratio)})
      for (const double turn : {1e-30, 1e-5, 1.0, 20.0}) {
        // spun fast about the needle's axis, or end over end
        const Vec3 spin = turn * (random.below(2) == 0 ? random.direction() : Vec3(0, random.sym(), random.sym()));
        const Vec3 momentum = moments.cwiseProduct(spin);
        CAPTURE(moments.transpose(), turn, spin.transpose());
        const Mat3 q = free_rotation(inertia_of(moments), momentum, 1.0);
        CHECK((q * q.transpose() - Mat3::Identity()).norm() < 1e-14);
        const Vec3 own = q.transpose() * momentum;
        const double before = momentum.dot(momentum.cwiseQuotient(moments));
        // what a rotation of doubles can hold of it
        CHECK(std::abs(own.dot(own.cwiseQuotient(moments)) - before) <
              before * (1e-14 + 1e-15 * std::sqrt(ratio) + 1e-30 * ratio));
      }
}

TEST_CASE("a turn that can't be followed is refused") {
  const PrincipalInertia box = inertia_of(Vec3(1, 2, 3)), ball = inertia_of(Vec3::Ones());
  CHECK_NOTHROW(free_rotation(box, Vec3(1e8, 1e8, 1e8), 1.0));
  CHECK_THROWS_AS(free_rotation(box, Vec3(1e10, 1e10, 1e10), 1.0), DivergenceError);
  CHECK_THROWS_AS(free_rotation(ball, Vec3(1e10, 0, 0), 1.0), DivergenceError);
  CHECK_THROWS_AS(free_rotation(box, Vec3(NAN, 1, 0), 1.0), DivergenceError);
  CHECK_THROWS_AS(free_rotation(box, Vec3(INFINITY, 1, 0), 1.0), DivergenceError);
  CHECK_THROWS_AS(free_rotation(box, Vec3(1e200, 1, 1e200), 1e200), DivergenceError);
}
