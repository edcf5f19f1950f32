// The linear systems of Newton's methods: over bodies' velocities against written-out matrices and dense LU.
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "engine/core/parallel.hpp"
#include "engine/lcp/body_matrix.hpp"
#include "engine/lcp/newton_system.hpp"
#include "engine/lcp/residual.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/response.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Bodies in a row that touch the next one, some pairs at random, some the ground, some nothing.
GroupSystem make_group(Random& random, int bodies, int contacts) {
  GroupSystem group;
  for (int b = 0; b < bodies; ++b) {
    const Mat3 r = random.rotation();
    RigidBlock block;
    block.inverse_mass = random.in(0.1, 10.0);
    block.inverse_inertia =
        r * Vec3(random.in(0.1, 9.0), random.in(0.1, 9.0), random.in(0.1, 9.0)).asDiagonal() * r.transpose();
    block.inverse_inertia = 0.5 * (block.inverse_inertia + Mat3(block.inverse_inertia.transpose()));
    group.rigid.push_back(block);
  }
  for (int c = 0; c < contacts; ++c) {
    ContactRows rows;
    rows.a.rigid = c < bodies ? c : random.below(bodies);
    rows.b.rigid = c % 5 == 0 ? -1 : c < bodies ? (c + 1) % bodies : random.below(bodies);
    if (rows.b.rigid == rows.a.rigid) rows.b.rigid = -1;
    rows.directions = random.rotation();
    rows.a.arm = random.vector(), rows.b.arm = random.vector();
    rows.friction = c % 4 == 3 ? 0.0 : 0.4;
    rows.bound = 0.1 * random.sym();
    group.contacts.push_back(rows);
    group.lambda.push_back(Vec3::Zero());
  }
  return group;
}

Mat3 random_matrix(Random& random) {
  Mat3 m;
  for (int k = 0; k < 3; ++k) m.row(k) = random.vector();
  return m;
}

}  // namespace

TEST_CASE("M + Jᵀ G J is solved as its dense copy is, whatever touches what") {
  Random random(5);
  for (const auto& [bodies, contacts] : {std::pair(1, 1), {2, 7}, {9, 20}, {60, 150}, {60, 40}, {130, 800}}) {
    GroupSystem group = make_group(random, bodies, contacts);
    FactoredDelassus w(group);
    const BodySpace& space = *w.body_space();
    MatX dense = MatX::Zero(6 * bodies, 6 * bodies);
    for (int b = 0; b < bodies; ++b) {
      dense.block<3, 3>(6 * b, 6 * b) = Mat3::Identity() / group.rigid[b].inverse_mass;
      dense.block<3, 3>(6 * b + 3, 6 * b + 3) = group.rigid[b].inverse_inertia.inverse();
    }
    std::vector<Mat3> g;
    for (int c = 0; c < contacts; ++c) {
      const Mat3 m = random_matrix(random);
      g.push_back(c % 7 == 6 ? Mat3(Mat3::Zero()) : Mat3(10.0 * m * m.transpose() + random_matrix(random)));
      const ContactRows& rows = group.contacts[c];
      MatX j = MatX::Zero(3, 6 * bodies);
      for (int k = 0; k < (rows.has_one_row() ? 1 : 3); ++k) {
        const Vec3 d = rows.directions.row(k);
        j.block<1, 3>(k, 6 * rows.a.rigid) += d.transpose();
        j.block<1, 3>(k, 6 * rows.a.rigid + 3) += rows.a.arm.cross(d).transpose();
        if (rows.b.rigid < 0) continue;
        j.block<1, 3>(k, 6 * rows.b.rigid) -= d.transpose();
        j.block<1, 3>(k, 6 * rows.b.rigid + 3) -= rows.b.arm.cross(d).transpose();
      }
      dense += j.transpose() * g.back() * j;
    }
    BodyMatrix matrix(space);
    BodyMatrix alone(space);
    for (int round = 0; round < 2; ++round) {  // the second time over what the first left
      matrix.factorize(g);
      const VecX b = VecX::NullaryExpr(6 * bodies, [&] { return random.sym(); });
      VecX x = b;
      matrix.solve(x);
      CAPTURE(bodies, contacts);
      CHECK((dense * x - b).norm() < 1e-9 * dense.norm() * x.norm());
      CHECK((x - dense.partialPivLu().solve(b)).norm() < 1e-8 * x.norm());
      set_thread_count(1);
      alone.factorize(g);
      set_thread_count(0);
      VecX y = b;
      alone.solve(y);
      CHECK(y == x);
    }
  }
}

TEST_CASE("Newton's system over bodies has the solution of the one over rows, or says that it has none") {
  Random random(6);
  for (const double size : {1.0, 1e-3, 1e-6, 1e-9, 1e-12}) {
    GroupSystem group = make_group(random, 20, 50);
    FactoredDelassus w(group);
    ConeProblem problem = make_cone_problem(group);
    problem.w = &w;
    std::vector<Mat3> a, b;
    std::vector<char> kept;
    for (std::size_t i = 0; i < 50; ++i) {
      const bool one = problem.has_one_row(i), open = i % 6 == 5;
      Mat3 scale = 0.2 * Mat3::Identity(), rest = size * Mat3::Identity();
      if (one) scale.bottomRightCorner<2, 2>().setZero(), rest.bottomRightCorner<2, 2>().setIdentity();
      if (!one && i % 6 == 2) {  // slides: its tangential rows follow the normal one
        scale(1, 0) = 0.08, scale(1, 1) = 0.0;
        rest(1, 0) = -0.4, rest(1, 1) = 1.0;
      }
      kept.push_back(!open);
      a.push_back(open ? Mat3(Mat3::Zero()) : scale);
      b.push_back(open ? Mat3(Mat3::Identity()) : rest);
    }
    VecX f = VecX::NullaryExpr(150, [&] { return random.sym(); });
    for (Eigen::Index i = 0; i < 50; ++i)
      if (problem.has_one_row(i)) f.segment<2>(3 * i + 1).setZero();
    const MatX dense = w.dense();
    MatX m(150, 150);
    for (Eigen::Index i = 0; i < 50; ++i) {
      m.middleRows<3>(3 * i) = a[i] * dense.middleRows<3>(3 * i);
      m.block<3, 3>(3 * i, 3 * i) += b[i];
    }
    VecX over_rows, over_bodies;
    const auto rows = newton_system_of_rows(problem);
    const auto bodies = newton_system_of_bodies(*w.body_space());
    rows->factorize(a, b, kept), rows->solve(f, over_rows);
    bodies->factorize(a, b, kept), bodies->solve(f, over_bodies);
    CAPTURE(size);
    if (size >= 1e-6) CHECK((m * over_bodies - f).norm() < 1e-9 * f.norm());
    CHECK((!over_bodies.allFinite() || (m * over_bodies - f).norm() < 0.6 * f.norm()));
    if (size >= 1e-9) CHECK((m * over_rows - f).norm() < 1e-6 * f.norm());
    if (size >= 1e-6) CHECK((over_bodies - over_rows).norm() < 1e-6 * over_rows.norm());
  }
}
