// Constraint anticipation and its iterative form against an interior-point method on dense matrices, and against each
// other.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "engine/response/group_judge.hpp"
#include "engine/response/operators/assembled_delassus.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/deformable_stack.hpp"
#include "tests/support/mechanics/methods.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A, J and q of a group as dense matrices, unknowns rigid bodies first.
struct Dense {
  MatX a, j;
  VecX q;
};

Dense dense(const GroupSystem& group) {
  Eigen::Index n = 6 * static_cast<Eigen::Index>(group.rigid.size());
  std::vector<Eigen::Index> first;
  for (const DeformableBlock& b : group.deformable) {
    first.push_back(n);
    n += b.velocity.size();
  }
  const auto m = static_cast<Eigen::Index>(group.contacts.size());
  Dense d{MatX::Zero(n, n), MatX::Zero(3 * m, n), VecX::Zero(3 * m)};
  VecX v = VecX::Zero(n);
  for (std::size_t b = 0; b < group.rigid.size(); ++b) {
    const auto at = static_cast<Eigen::Index>(6 * b);
    d.a.block<3, 3>(at, at) = Mat3::Identity() / group.rigid[b].inverse_mass;
    d.a.block<3, 3>(at + 3, at + 3) = group.rigid[b].inverse_inertia.inverse();
    v.segment<3>(at) = group.rigid[b].velocity;
    v.segment<3>(at + 3) = group.rigid[b].angular_velocity;
  }
  for (std::size_t s = 0; s < group.deformable.size(); ++s) {
    const BlockPattern& p = *group.deformable[s].a->pattern;
    for (int i = 0; i < p.rows; ++i)
      for (int k = p.begin[i]; k < p.begin[i + 1]; ++k)
        d.a.block<3, 3>(first[s] + 3 * i, first[s] + 3 * p.column[k]) = group.deformable[s].a->values[k];
    v.segment(first[s], group.deformable[s].velocity.size()) = group.deformable[s].velocity;
  }
  for (Eigen::Index c = 0; c < m; ++c) {
    const ContactRows& rows = group.contacts[c];
    for (const auto& [side, sign] : {std::pair(&rows.a, 1.0), std::pair(&rows.b, -1.0)})
      for (int k = 0; k < 3; ++k) {
        const Vec3 direction = rows.directions.row(k);
        if (side->rigid >= 0) {
          d.j.block<1, 3>(3 * c + k, 6 * side->rigid) += sign * direction.transpose();
          d.j.block<1, 3>(3 * c + k, 6 * side->rigid + 3) += sign * side->arm.cross(direction).transpose();
        }
        for (const NodeWeight& n : side->nodes)
          d.j.block<1, 3>(3 * c + k, first[side->deformable] + 3 * n.node) += sign * n.weight * direction.transpose();
      }
  }
  d.q = d.j * v;
  for (Eigen::Index c = 0; c < m; ++c) {
    d.q.segment<3>(3 * c) += group.contacts[c].surface;
    d.q[3 * c] -= group.contacts[c].bound;
  }
  return d;
}

VecX delta_of(const GroupSystem& group) {
  Eigen::Index n = 6 * static_cast<Eigen::Index>(group.rigid.size());
  for (const VecX& v : group.deformable_delta) n += v.size();
  VecX all(n);
  Eigen::Index at = 0;
  for (std::size_t b = 0; b < group.rigid.size(); ++b, at += 6) {
    all.segment<3>(at) = group.delta_velocity[b];
    all.segment<3>(at + 3) = group.delta_angular_velocity[b];
  }
  for (const VecX& v : group.deformable_delta) {
    all.segment(at, v.size()) = v;
    at += v.size();
  }
  return all;
}

/// Δv of the frictionless problem: min ½ λ^T W λ + q^T λ over λ >= 0 by a primal-dual interior-point method.
VecX frictionless_reference(const Dense& d) {
  const Eigen::Index m = d.q.size() / 3;
  MatX j(m, d.a.cols());
  VecX q(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    j.row(i) = d.j.row(3 * i);
    q[i] = d.q[3 * i];
  }
  const Eigen::LLT<MatX> a(d.a);
  const MatX w = j * a.solve(MatX(j.transpose()));
  VecX lambda = VecX::Constant(m, 1.0), s = (w * lambda + q).cwiseMax(1.0);
  for (int k = 0; k < 200; ++k) {
    const double mean = lambda.dot(s) / static_cast<double>(m), target = 0.1 * mean;
    const VecX dual = w * lambda + q - s;
    if (mean < 1e-18 && dual.cwiseAbs().maxCoeff() < 1e-13) break;
    MatX system = w;
    system.diagonal() += s.cwiseQuotient(lambda);
    // Δs = W Δλ + dual, λ Δs + s Δλ = target - λ s
    const VecX step = Eigen::LDLT<MatX>(system).solve(VecX(target * lambda.cwiseInverse() - s - dual));
    const VecX s_step = w * step + dual;
    double length = 1.0;
    for (Eigen::Index i = 0; i < m; ++i) {
      if (step[i] < 0.0) length = std::min(length, -0.995 * lambda[i] / step[i]);
      if (s_step[i] < 0.0) length = std::min(length, -0.995 * s[i] / s_step[i]);
    }
    lambda += length * step;
    s += length * s_step;
  }
  return a.solve(VecX(j.transpose() * lambda));
}

double relative_error(const MatX& a, const VecX& x, const VecX& truth) {
  return std::sqrt((x - truth).dot(a * (x - truth)) / truth.dot(a * truth));
}

double largest_speed(const Dense& d) {
  double scale = 0.0;
  for (Eigen::Index i = 0; i < d.q.size() / 3; ++i) scale = std::max(scale, d.q.segment<3>(3 * i).norm());
  return scale;
}

ResponseResult respond(const Response& response, GroupSystem& group, double tolerance) {
  ResponseContext context;
  context.lcp = {tolerance, 200000};
  return response.solve(group, *make_named(lcp_solvers(), "projected_gauss_seidel"), context);
}
ResponseResult respond(const char* name, GroupSystem& group, double tolerance) {
  return respond(*patient_response(name, 20000, by_itself(name)), group, tolerance);
}

constexpr const char* kExact = "constraint_anticipation";
constexpr const char* kIterative = "iterative_constraint_anticipation";

}  // namespace

TEST_CASE("the assembled Delassus operator is J A^-1 J^T, symmetric") {
  // many contacts a node, few contacts a node, rigid bodies among them
  for (const bool rigid : {false, true})
    for (const std::size_t keep : {std::size_t{1000}, std::size_t{5}}) {
      CAPTURE(rigid, keep);
      SoftStack stack = make_soft_stack({.young = 1e6, .friction = 0.5, .cells = {3, 2}, .rigid_on_top = rigid});
      if (stack.group.contacts.size() > keep)
        stack.group.contacts.erase(stack.group.contacts.begin(), stack.group.contacts.end() - keep);
      const Dense d = dense(stack.group);
      const MatX truth = d.j * d.a.ldlt().solve(MatX(d.j.transpose()));
      const AssembledDelassus w(stack.group);
      CHECK((w.matrix() - truth).norm() < 1e-11 * truth.norm());
      CHECK((w.matrix() - w.matrix().transpose()).norm() <= 1e-13 * truth.norm());
    }
}

TEST_CASE("without friction both anticipations find the minimum that an interior-point method finds") {
  for (const double young : {1e4, 1e5, 1e6})
    for (const bool rigid : {false, true}) {
      CAPTURE(young, rigid);
      const SoftStack stack = make_soft_stack({.young = young, .cells = {3, 2}, .rigid_on_top = rigid});
      const Dense d = dense(stack.group);
      const VecX truth = frictionless_reference(d);
      GroupSystem exact = stack.group, iterative = stack.group;
      CHECK(respond(kExact, exact, 1e-11).converged());
      CHECK(respond(kIterative, iterative, 1e-11).converged());
      CHECK(relative_error(d.a, delta_of(exact), truth) < 1e-7);
      CHECK(relative_error(d.a, delta_of(iterative), truth) < 1e-7);
    }
}

TEST_CASE("two stacked cubes: the iterative form meets the exact one to a millionth in energy") {
  for (const double young : {1e4, 1e5, 1e6}) {
    CAPTURE(young);
    const SoftStack stack = make_soft_stack({.young = young, .cells = {5, 4}});
    const Dense d = dense(stack.group);
    GroupSystem exact = stack.group, iterative = stack.group;
    CHECK(respond(kExact, exact, 1e-10).converged());
    const ResponseResult result = respond(kIterative, iterative, 1e-9);
    CHECK(result.converged());
    CHECK(result.outer_iterations < 1000);
    CHECK(relative_error(d.a, delta_of(iterative), delta_of(exact)) < 1e-6);
  }
}

TEST_CASE(
    "the iterative form leaves a stiff group to the exact one at once, and a soft one after as many steps as are worth "
    "it") {
  const auto steps = [](double young, int cells) {
    const SoftStack stack = make_soft_stack({.young = young, .friction = 0.4, .cells = {cells, cells - 1}});
    const Dense d = dense(stack.group);
    GroupSystem truth = stack.group, group = stack.group;
    CHECK(respond(kExact, truth, 1e-11).converged());
    const ResponseResult result = respond(*patient_response(kIterative, 20000), group, 1e-9);
    CHECK(result.converged());
    CHECK(relative_error(d.a, delta_of(group), delta_of(truth)) < 1e-6);
    CHECK(judge_group(group).residual() < 1e-8 * largest_speed(d));
    return result.outer_iterations;
  };
  CHECK(steps(1e8, 4) == 0);
  const int of_soft = steps(1e3, 6);
  CHECK(of_soft > 0);
  CHECK(of_soft < 1000);
}

TEST_CASE("with friction both anticipations reach the natural map they were asked for") {
  for (const double young : {1e4, 1e6})
    for (const bool rigid : {false, true}) {
      const SoftStack stack =
          make_soft_stack({.young = young, .friction = 0.4, .cells = {4, 3}, .rigid_on_top = rigid});
      const Dense d = dense(stack.group);
      GroupSystem exact = stack.group, iterative = stack.group;
      CHECK(respond(kExact, exact, 1e-9).converged());
      CHECK(respond(kIterative, iterative, 1e-9).converged());
      const double difference = relative_error(d.a, delta_of(iterative), delta_of(exact));
      CAPTURE(young, rigid, difference);
      const double allowed = 1e-8 * largest_speed(d);
      CHECK(judge_group(exact).residual() < allowed);
      CHECK(judge_group(iterative).residual() < allowed);
      int sliding = 0, sticking = 0;  // the case has both
      for (std::size_t i = 0; i < iterative.contacts.size(); ++i) {
        const Vec3& l = iterative.lambda[i];
        if (l.x() > 0.0) ++(std::hypot(l.y(), l.z()) > 0.4 * l.x() * (1.0 - 1e-9) ? sliding : sticking);
      }
      CHECK(sliding > 0);
      CHECK(sticking > 0);
      CHECK(difference < 1e-4);  // Coulomb's law allows more than one answer in principle; here there is one
    }
}

TEST_CASE("attachments and sliding rows are equations to both anticipations") {
  SoftStack stack = make_soft_stack({.young = 1e5, .friction = 0.3, .cells = {3, 2}, .rigid_on_top = true});
  for (std::size_t i = 0; i < stack.group.contacts.size(); ++i) {
    if (i % 5 == 1) stack.group.contacts[i].kind = RowKind::attachment;
    if (i % 5 == 3) stack.group.contacts[i].kind = RowKind::sliding;
  }
  const Dense d = dense(stack.group);
  for (const char* name : {kExact, kIterative}) {
    CAPTURE(name);
    GroupSystem group = stack.group;
    CHECK(respond(name, group, 1e-9).converged());
    const VecX u = d.j * delta_of(group) + d.q;
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
      const Vec3 at = u.segment<3>(static_cast<Eigen::Index>(3 * i));
      if (i % 5 == 1) CHECK(at.norm() < 1e-7);
      if (i % 5 == 3) {
        CHECK(std::abs(at.x()) < 1e-7);
        CHECK(group.lambda[i].tail<2>().norm() == 0.0);
      }
    }
    CHECK(judge_group(group).residual() < 1e-8 * largest_speed(d));
  }
}

TEST_CASE("the seed's form is honest: its 5 % rule stops far away, and a cap is not convergence") {
  const SoftStack soft = make_soft_stack({.young = 1e4, .cells = {3, 2}}),
                  stiff = make_soft_stack({.young = 1e6, .cells = {3, 2}});
  const Dense d = dense(soft.group), d_stiff = dense(stiff.group);
  const auto seed = patient_response(kIterative, 20000, {{"form", "seed"}});
  {
    GroupSystem group = soft.group;  // soft and without friction it does get there
    CHECK(respond(*seed, group, 1e-9).converged());
    CHECK(relative_error(d.a, delta_of(group), frictionless_reference(d)) < 1e-6);
  }
  {
    GroupSystem group = stiff.group;
    allow_iterations(*seed, 100);
    const ResponseResult result = respond(*seed, group, 1e-9);
    CHECK_FALSE(result.converged());
    CHECK(result.outer_iterations == 100);
  }
  GroupSystem group = stiff.group;
  configure(*seed, std::vector<RowText>{{"stop", "change"}});
  const ResponseResult result = respond(*seed, group, 1e-9);
  CHECK(result.converged());
  CHECK(result.outer_iterations < 100);
  CHECK(relative_error(d_stiff.a, delta_of(group), frictionless_reference(d_stiff)) > 1e-2);
}

TEST_CASE("bodies whose matrix is block diagonal take one outer step and no factorization") {
  SoftStack stack = make_soft_stack({.young = 1e5, .friction = 0.3, .cells = {3, 2}, .rigid_on_top = true});
  std::vector<BlockMatrix> lumped;
  for (DeformableBlock& block : stack.group.deformable) {
    lumped.push_back(*block.a);
    BlockMatrix& a = lumped.back();
    for (int i = 0; i < a.pattern->rows; ++i)
      for (int k = a.pattern->begin[i]; k < a.pattern->begin[i + 1]; ++k)
        if (k != a.pattern->diagonal[i]) a.values[k].setZero();
  }
  for (std::size_t s = 0; s < lumped.size(); ++s) {
    stack.group.deformable[s].a = &lumped[s];
    stack.group.deformable[s].is_diagonal = true;
    stack.group.deformable[s].solver = nullptr;
  }
  for (const char* name : {kExact, kIterative}) {
    CAPTURE(name);
    GroupSystem group = stack.group;
    const ResponseResult result = respond(name, group, 1e-10);
    CHECK(result.converged());
    CHECK(result.outer_iterations == (name == kIterative ? 1 : 0));
    CHECK(judge_group(group).residual() < 1e-9 * largest_speed(dense(group)));
  }
}

TEST_CASE("a start near the answer shortens both anticipations") {
  const SoftStack stack = make_soft_stack({.young = 1e5, .friction = 0.4, .cells = {4, 3}});
  GroupSystem cold = stack.group;
  const ResponseResult first = respond(kIterative, cold, 1e-8);
  GroupSystem warm = stack.group;
  warm.lambda = cold.lambda;
  const ResponseResult second = respond(kIterative, warm, 1e-8);
  CHECK(second.converged());
  CHECK(2 * second.outer_iterations < first.outer_iterations);
}
