// Free rotation: the exact turn against rules that step along it.
#include <fmt/format.h>
#include <cstdio>
#include <ctime>

#include <Eigen/LU>
#include <algorithm>
#include <functional>

#include "engine/geometry/rotation.hpp"
#include "engine/rotation/free_rotation.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Body {
  Vec3 moments;
  PrincipalInertia inertia;
  Mat3 rotation;
  Vec3 momentum;

  Vec3 own() const { return rotation.transpose() * momentum; }
  double energy() const { return 0.5 * own().dot(own().cwiseQuotient(moments)); }
};

using Rule = std::function<bool(Body&, double)>;  // whether the step settled

bool exact(Body& body, double h) {
  body.rotation = orthonormalized(body.rotation * free_rotation(body.inertia, body.own(), h));
  return true;
}

/// R' = exp(h w) R with w = I(R half-way)⁻¹ L, by fixed-point rounds.
bool lie_midpoint(Body& body, double h) {
  const Mat3 start = body.rotation;
  const auto velocity = [&](const Mat3& r) {
    return Vec3(r * (r.transpose() * body.momentum).cwiseQuotient(body.moments));
  };
  Vec3 w = velocity(start);
  bool settled = false;
  for (int i = 0; i < 50 && !settled; ++i) {
    const Vec3 next = velocity(rotation_exp(0.5 * h * w) * start);
    settled = (next - w).norm() <= 1e-15 * next.norm();
    w = next;
  }
  body.rotation = orthonormalized(rotation_exp(h * w) * start);
  return settled;
}

Mat3 cross(const Vec3& w) {
  Mat3 k;
  k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return k;
}

/// The energy-momentum rule [Simo91]: the midpoint rule for the body's own momentum, by Newton's method, and Cayley's
/// transform of its midpoint velocity for the attitude.
bool energy_momentum(Body& body, double h) {
  const Vec3 start = body.own(), inverse = body.moments.cwiseInverse();
  Vec3 middle = start;
  bool settled = false;
  for (int i = 0; i < 50 && !settled; ++i) {
    const Vec3 w = inverse.cwiseProduct(middle), off = middle - start - 0.5 * h * middle.cross(w);
    const Mat3 slope = Mat3::Identity() - 0.5 * h * (cross(middle) * inverse.asDiagonal() - cross(w));
    const Vec3 change = slope.partialPivLu().solve(off);
    middle -= change;
    settled = change.norm() <= 1e-14 * start.norm();
  }
  const Vec3 w = h * inverse.cwiseProduct(middle);
  const Mat3 k = cross(w);
  body.rotation =
      orthonormalized(body.rotation * (Mat3::Identity() + (k + 0.5 * k * k) / (1.0 + 0.25 * w.squaredNorm())));
  return settled;
}

Mat3 by_small_steps(const Body& body, double time, int steps) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  using Matrix = Eigen::Matrix<long double, 3, 3>;
  const Vector l = body.momentum.cast<long double>(), inverse = body.moments.cast<long double>().cwiseInverse();
  const auto rate = [&](const Matrix& r) -> Matrix {
    const Vector w = r * inverse.cwiseProduct(r.transpose() * l);
    Matrix k;
    k << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
    return k * r;
  };
  const long double h = static_cast<long double>(time) / steps;
  Matrix r = body.rotation.cast<long double>();
  for (int i = 0; i < steps; ++i) {
    const Matrix k1 = rate(r), k2 = rate(r + h / 2 * k1), k3 = rate(r + h / 2 * k2), k4 = rate(r + h * k3);
    r += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return r.cast<double>();
}

std::vector<Body> make_bodies(const Vec3& moments, double speed, int count) {
  Random random(31);
  std::vector<Body> bodies;
  for (int i = 0; i < count; ++i) {
    Body body{moments, principal_inertia(Mat3(moments.asDiagonal())), random.rotation(), Vec3::Zero()};
    body.momentum = body.rotation * moments.cwiseProduct(speed * random.direction());
    bodies.push_back(body);
  }
  return bodies;
}

double nanoseconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

void report(const char* name, const Rule& rule, const Vec3& moments, double turn) {
  constexpr double kStep = 1.0 / 240.0;
  std::vector<Body> bodies = make_bodies(moments, turn / kStep, 1000);
  double least = HUGE_VAL;
  for (int k = 0; k < 20; ++k) {
    const double begin = nanoseconds();
    for (Body& body : bodies) rule(body, kStep);
    least = std::min(least, (nanoseconds() - begin) / static_cast<double>(bodies.size()));
  }
  double drift = 0.0, off = 0.0;
  int unsettled = 0;
  for (Body& body : make_bodies(moments, turn / kStep, 5)) {
    const Body start = body;
    for (int i = 0; i < 10000; ++i) {
      unsettled += !rule(body, kStep);
      const double change = std::abs(body.energy() - start.energy()) / start.energy();
      if (!(change <= drift)) drift = change;
    }
    Body ten = start;
    const int steps = std::clamp(static_cast<int>(std::min(10.0 / turn, 1e3) + 0.5), 1, 1000);
    for (int i = 0; i < steps; ++i) rule(ten, kStep);
    off = std::max(off, (ten.rotation - by_small_steps(start, kStep * steps, 20000)).norm());
  }
  fmt::print("  {:<18}{:>6.0f} ns{:>12.1e}{:>12.1e}{:>10}\n", name, least, drift, off, unsettled);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  BenchArguments arguments(
      "bench_free_rotation",
      "Free rotation of 1,000 bodies: the exact turn against rules that step along it. Time a body and\n"
      "step, energy gained or lost over 10,000 steps, attitude after ten radians (or 1,000 steps) against\n"
      "small steps in long double, and steps that did not settle.");
  arguments.read_or_exit(argc, argv);
  fmt::print("{:<20}{:>9}{:>12}{:>12}{:>10}\n", "", "a step", "energy", "attitude", "unsettled");
  for (const auto& [name, moments] :
       {std::pair("a box, 1 : 2 : 2.5", Vec3(1, 2, 2.5)), std::pair("a ball", Vec3(1, 1, 1)),
        std::pair("a pencil, 1 : 340 : 341", Vec3(1, 340, 341)), std::pair("a wire, 1 : 1e5 : 1e5", Vec3(1, 1e5, 1e5))})
    for (const double turn : {1e-10, 0.01, 0.1, 0.5, 2.0}) {
      fmt::print("{}, Δt|w| = {}\n", name, turn);
      report("exact", exact, moments, turn);
      report("energy-momentum", energy_momentum, moments, turn);
      report("Lie midpoint", lie_midpoint, moments, turn);
    }
}
