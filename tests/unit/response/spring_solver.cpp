// (A + Jᵀ H J) x = b by a factorization and by gradients: the answers of both are put back into the equation.
#include <catch2/catch.hpp>

#include "engine/response/spring_solver.hpp"
#include "tests/support/mechanics/deformable_stack.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

VecX left_of(const GroupOperator& a, const std::vector<Mat3>& h, const VecX& b, const VecX& x) {
  VecX rest = b - a.multiply(x);
  for (std::size_t i = 0; i < h.size(); ++i) a.add_impulse(i, -h[i] * a.row(i, x), rest);
  return rest;
}

std::vector<Mat3> springs(const GroupSystem& group, Random& random, bool is_symmetric) {
  std::vector<Mat3> all;
  for (const ContactRows& rows : group.contacts) {
    Mat3 h = Mat3::Zero();
    if (random.u() < 0.7) {  // the others are open
      h(0, 0) = std::pow(10.0, random.in(-1.0, 3.0));
      if (rows.friction > 0.0) {
        h(1, 1) = h(2, 2) = std::pow(10.0, random.in(-1.0, 3.0));
        if (!is_symmetric) h(1, 0) = random.in(-0.5, 0.5) * h(0, 0), h(2, 0) = random.in(-0.5, 0.5) * h(0, 0);
      }
    }
    all.push_back(h);
  }
  return all;
}

}  // namespace

TEST_CASE("systems with springs at contacts are solved alike by a factorization and by gradients") {
  Random random(77);
  for (const double young : {1e4, 1e6})
    for (const double friction : {0.0, 0.5})
      for (const bool is_symmetric : {true, false}) {
        SoftStack stack =
            make_soft_stack({.young = young, .friction = friction, .cells = {4, 3}, .rigid_on_top = friction > 0.0});
        CAPTURE(young, friction, is_symmetric, stack.group.contacts.size());
        const GroupOperator a(stack.group);
        const std::vector<Mat3> h = springs(stack.group, random, is_symmetric);
        VecX b(a.size());
        for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.sym();
        SpringSolver direct(stack.group, a, 0.0), gradients(stack.group, a, INFINITY);
        VecX x, y;
        if (is_symmetric)
          direct.solve(h, b, 1e-12, x), gradients.solve(h, b, 1e-12, y);
        else
          direct.solve_unsymmetric(h, b, 1e-12, x), gradients.solve_unsymmetric(h, b, 1e-12, y);
        CHECK(direct.is_factorized());
        CHECK_FALSE(gradients.is_factorized());
        CHECK(left_of(a, h, b, x).norm() < 1e-8 * b.norm());
        // stabilised bi-conjugate gradients break down earlier; they are asked for 1e-2 as a rule
        CHECK(left_of(a, h, b, y).norm() < (is_symmetric ? 1e-8 : 1e-4) * b.norm());
        if (is_symmetric) CHECK((x - y).norm() < 1e-6 * y.norm());
        VecX free;
        CHECK(direct.free(b, 1e-12, free));
        CHECK((a.multiply(free) - b).norm() < 1e-9 * b.norm());
      }
}

TEST_CASE("gradients give way to a factorization once they have taken as long") {
  Random random(78);
  SoftStack stack = make_soft_stack({.young = 1e7, .friction = 0.5, .cells = {5, 4}});
  const GroupOperator a(stack.group);
  SpringSolver solver(stack.group, a);
  CHECK_FALSE(solver.is_factorized());
  VecX b(a.size()), x;
  int asked = 0;
  for (; asked < 100 && !solver.is_factorized(); ++asked) {
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.sym();
    solver.solve(springs(stack.group, random, true), b, 1e-6, x);
  }
  CHECK(asked > 0);
  CHECK(asked < 100);
}
