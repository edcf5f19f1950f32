// W by touched nodes and Newton's systems over them, against W assembled by contacts and its dense systems.
#include "engine/response/operators/node_delassus.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "engine/lcp/newton_system.hpp"
#include "engine/lcp/residual.hpp"
#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/operators/delassus_of.hpp"
#include "engine/response/operators/touched_nodes.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/deformable_stack.hpp"
#include "tests/support/mechanics/methods.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Soft cubes with a rigid one on top, and every contact `copies` times, each turned and moved a little: more contacts than
/// nodes. Some have no friction, of some both bodies are rigid.
SoftStack crowded(int copies, bool is_rigid_on_top) {
  SoftStack stack = make_soft_stack({.young = 1e5, .friction = 0.4, .cells = {3, 2}, .rigid_on_top = is_rigid_on_top});
  Random random(11);
  GroupSystem& group = stack.group;
  const std::vector<ContactRows> once = group.contacts;
  for (int k = 1; k < copies; ++k)
    for (ContactRows rows : once) {
      const Mat3 turn = Eigen::AngleAxisd(0.1 * random.sym(), random.vector().normalized()).toRotationMatrix();
      rows.directions = rows.directions * turn;
      rows.a.arm += 0.01 * random.vector(), rows.b.arm += 0.01 * random.vector();
      group.contacts.push_back(rows);
    }
  if (is_rigid_on_top) {
    group.rigid.push_back(group.rigid.front());  // touches the other at its corners
    for (int k = 0; k < 4; ++k) {
      ContactRows rows = once.back();
      rows.a = rows.b = ContactSide();
      rows.a.rigid = 1, rows.b.rigid = 0;
      rows.a.arm = 0.1 * random.vector(), rows.b.arm = 0.1 * random.vector();
      group.contacts.push_back(rows);
    }
  }
  for (std::size_t i = 0; i < group.contacts.size(); i += 7) group.contacts[i].friction = 0.0;
  group.lambda.assign(group.contacts.size(), Vec3::Zero());
  group.assembled.reset(), group.between_nodes.reset();
  return stack;
}

/// The assembled W with the rows that there are.
MatX rows_that_are(const ConeProblem& problem, MatX w) {
  for (std::size_t i = 0; i < problem.q.size(); ++i) {
    if (!problem.has_one_row(i)) continue;
    w.middleRows<2>(static_cast<Eigen::Index>(3 * i + 1)).setZero();
    w.middleCols<2>(static_cast<Eigen::Index>(3 * i + 1)).setZero();
  }
  return w;
}

}  // namespace

TEST_CASE("W by touched nodes is W by contacts: blocks, products, changes") {
  for (const bool rigid : {false, true}) {
    CAPTURE(rigid);
    SoftStack stack = crowded(4, rigid);
    const ConeProblem problem = make_cone_problem(stack.group);
    const MatX truth = rows_that_are(problem, AssembledDelassus(stack.group).matrix());
    NodeDelassus w(stack.group, touched_nodes(stack.group));
    const std::size_t n = w.contacts();
    REQUIRE(3 * n == static_cast<std::size_t>(truth.rows()));
    CHECK(static_cast<std::size_t>(w.node_space()->touched) < n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      CHECK((w.diagonal(i) - truth.block<3, 3>(at, at)).norm() <= 1e-11 * truth.norm());
    }
    Random random(3);
    std::vector<Vec3> lambda(n);
    VecX all(3 * n);
    const auto check = [&] {
      for (std::size_t i = 0; i < n; ++i) all.segment<3>(static_cast<Eigen::Index>(3 * i)) = lambda[i];
      const VecX u = truth * all;
      for (std::size_t i = 0; i < n; ++i)
        CHECK((w.row(i, false) - u.segment<3>(static_cast<Eigen::Index>(3 * i))).norm() <= 1e-11 * u.norm());
    };
    for (Vec3& l : lambda) l = random.vector();
    w.begin(lambda), check();
    for (std::size_t i = 0; i < n; i += 3) {
      const Vec3 delta = random.vector();
      w.change(i, delta, problem.has_one_row(i));
      lambda[i] += delta;
    }
    check();
  }
}

TEST_CASE("Newton's system over touched nodes has the solution of its written-out matrix") {
  for (const bool rigid : {false, true})
    for (const double size : {1.0, 1e-3, 1e-6}) {
      CAPTURE(rigid, size);
      SoftStack stack = crowded(3, rigid);
      ConeProblem problem = make_cone_problem(stack.group);
      NodeDelassus w(stack.group, touched_nodes(stack.group));
      problem.w = &w;
      const MatX dense = rows_that_are(problem, AssembledDelassus(stack.group).matrix());
      const std::size_t n = w.contacts();
      std::vector<Mat3> a, b;
      std::vector<char> kept;
      MatX m(3 * n, 3 * n);
      VecX f(3 * n);
      Random random(8);
      for (std::size_t i = 0; i < n; ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        const bool one = problem.has_one_row(i), open = i % 6 == 5;
        const double scale = 1.0 / w.diagonal(i)(0, 0);
        Mat3 by_u = scale * Mat3::Identity(), by_lambda = size * Mat3::Identity();
        if (one) by_u.bottomRightCorner<2, 2>().setZero(), by_lambda.bottomRightCorner<2, 2>().setIdentity();
        if (!one && i % 6 == 2) {  // slides
          by_u(1, 0) = 0.4 * scale, by_u(1, 1) = 0.0;
          by_lambda(1, 0) = -0.4, by_lambda(1, 1) = 1.0;
        }
        kept.push_back(!open);
        a.push_back(open ? Mat3(Mat3::Zero()) : by_u), b.push_back(open ? Mat3(Mat3::Identity()) : by_lambda);
        m.middleRows<3>(at) = a[i] * dense.middleRows<3>(at);
        m.block<3, 3>(at, at) += b[i];
        f.segment<3>(at) = one ? Vec3(random.sym(), 0.0, 0.0) : random.vector();
      }
      const auto system = newton_system(problem);
      system->factorize(a, b, kept);
      VecX x;
      system->solve(f, x);
      REQUIRE(x.allFinite());
      CHECK((m * x - f).norm() <= 1e-8 * f.norm());
      if (size >= 1e-3) {
        const VecX truth = m.partialPivLu().solve(f);
        CHECK((x - truth).norm() <= 1e-6 * truth.norm());
      }
    }
}

TEST_CASE("constraint anticipation by touched nodes ends where it does by contacts") {
  for (const bool rigid : {false, true}) {
    CAPTURE(rigid);
    SoftStack by_nodes = crowded(6, rigid), by_contacts = crowded(6, rigid);
    REQUIRE(delassus_of(by_nodes.group)->node_space() != nullptr);
    LcpSettings settings;
    settings.tolerance = 1e-10;
    ResponseContext context;
    context.lcp = settings;
    CHECK(make_response("constraint_anticipation")
              ->solve(by_nodes.group, *make_named(lcp_solvers(), "automatic"), context)
              .converged());
    ConeProblem problem = make_cone_problem(by_contacts.group);
    AssembledDelassus w(by_contacts.group);
    problem.w = &w;
    CHECK(judge(problem, by_nodes.group.lambda).map.relative <= 1e-9);  // with the other W
    CHECK(make_named(lcp_solvers(), "semismooth_newton")->solve(problem, settings, by_contacts.group.lambda).solved());
    apply_impulses(by_contacts.group);
    for (std::size_t s = 0; s < by_nodes.group.deformable_delta.size(); ++s) {
      const VecX &one = by_nodes.group.deformable_delta[s], &other = by_contacts.group.deformable_delta[s];
      CHECK((one - other).norm() <= 1e-6 * other.norm());
    }
  }
}
