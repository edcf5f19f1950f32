// What every registered LCP solver promises. A new solver is tested by being on the list.
#include <catch2/catch.hpp>

#include "engine/contact/friction_cone.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/lcp/residual.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/response/operators/factored_delassus.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/dense_delassus.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// W = G G^T + epsilon I, with q such that take-off, stick and slip all occur.
struct RandomProblem {
  DenseDelassus w;
  ConeProblem problem;
  RandomProblem(Random& random, int contacts, int rank, double epsilon, double mu)
      : w(make(random, contacts, rank, epsilon)) {
    problem.w = &w;
    for (int i = 0; i < contacts; ++i) {
      problem.q.push_back(random.vector() + Vec3(-0.3, 0, 0));
      problem.mu.push_back(mu);
    }
  }
  static MatX make(Random& random, int contacts, int rank, double epsilon) {
    MatX g(3 * contacts, rank);
    for (Eigen::Index i = 0; i < g.size(); ++i) g.data()[i] = random.sym();
    return g * g.transpose() / rank + epsilon * MatX::Identity(3 * contacts, 3 * contacts);
  }
};

/// The frictionless problem by trying every active set: 0 <= λ ⊥ W λ + q >= 0.
bool by_enumeration(const MatX& w, const VecX& q, VecX& lambda) {
  const int n = static_cast<int>(q.size());
  for (int set = 0; set < (1 << n); ++set) {
    std::vector<int> active;
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) active.push_back(i);
    MatX a(active.size(), active.size());
    VecX b(active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
      b[i] = -q[active[i]];
      for (std::size_t j = 0; j < active.size(); ++j) a(i, j) = w(active[i], active[j]);
    }
    lambda = VecX::Zero(n);
    if (!active.empty()) {
      const VecX x = a.fullPivLu().solve(b);
      for (std::size_t i = 0; i < active.size(); ++i) lambda[active[i]] = x[i];
    }
    if (lambda.minCoeff() >= -1e-12 && (w * lambda + q).minCoeff() >= -1e-12) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("every LCP solver: the frictionless problem equals enumeration of active sets", "[methods]") {
  for (const auto& e : lcp_solvers()) {
    CAPTURE(e.name);
    const auto solver = e.make();
    Random random(21);
    for (int trial = 0; trial < 40; ++trial) {
      const int n = 1 + random.below(7);
      RandomProblem p(random, n, 3 * n + 2, 0.05, 0.0);
      std::vector<Vec3> lambda(n, Vec3::Zero());
      const LcpResult result = solver->solve(p.problem, {1e-13, 100000}, lambda);
      CHECK(result.reason == StopReason::converged);
      MatX wn(n, n);
      VecX qn(n), truth;
      for (int i = 0; i < n; ++i) {
        qn[i] = p.problem.q[i].x();
        for (int j = 0; j < n; ++j) wn(i, j) = p.w.matrix()(3 * i, 3 * j);
      }
      REQUIRE(by_enumeration(wn, qn, truth));
      for (int i = 0; i < n; ++i) {
        CHECK(lambda[i].x() == Approx(truth[i]).margin(1e-9));
        CHECK(lambda[i].tail<2>().norm() == 0.0);
      }
    }
  }
}

TEST_CASE("every LCP solver: with friction the judge agrees with every claim of convergence", "[methods]") {
  for (const FrictionLaw law : {FrictionLaw::cone, FrictionLaw::pyramid}) {
    int open = 0, stick = 0, slip = 0;
    for (const auto& e : lcp_solvers()) {
      CAPTURE(e.name, int(law));
      const auto solver = e.make();
      Random random(22);
      for (int trial = 0; trial < 60; ++trial) {
        const int n = 1 + random.below(20);
        const double mu = random.in(0.05, 0.9);
        RandomProblem p(random, n, 3 * n, 0.1, mu);
        p.problem.law = law;
        std::vector<Vec3> lambda(n, Vec3::Zero());
        const LcpResult result = solver->solve(p.problem, {1e-11, 50000}, lambda);
        if (!solver->applies(p.problem).empty()) {
          REQUIRE(result.reason == StopReason::refused);
          continue;
        }
        const Residual residual = judge(p.problem, lambda);
        CAPTURE(trial, n, mu, result.iterations, residual.natural_map, residual.worst, name_of(result.reason));
        REQUIRE(result.reason == StopReason::converged);
        CHECK(residual.map.relative <= 1e-11 * (1 + 1e-6));
        CHECK(residual.cone_violation <= 1e-12);
        for (int i = 0; i < n; ++i) {
          const double t =
              law == FrictionLaw::cone ? lambda[i].tail<2>().norm() : lambda[i].tail<2>().cwiseAbs().maxCoeff();
          ++(lambda[i].x() == 0.0 ? open : t < mu * lambda[i].x() * (1 - 1e-9) ? stick : slip);
        }
      }
    }
    CHECK(open > 20);
    CHECK(stick > 20);
    CHECK(slip > 20);
  }
}

TEST_CASE("every LCP solver: honest at the cap, at ease with nothing and with redundant contacts, the same twice",
          "[methods]") {
  for (const auto& e : lcp_solvers()) {
    CAPTURE(e.name);
    const auto solver = e.make();
    DenseDelassus none(MatX(0, 0));
    std::vector<Vec3> empty;
    CHECK(solver->solve({&none, {}, {}, {}}, {1e-8, 10}, empty).iterations == 0);

    Random random(23);
    RandomProblem hard(random, 30, 40, 1e-6, 0.5);
    if (!solver->applies(hard.problem).empty()) hard.problem.law = FrictionLaw::pyramid;
    if (!solver->applies(hard.problem).empty()) hard.problem.mu.assign(30, 0.0);
    REQUIRE(solver->applies(hard.problem).empty());
    std::vector<Vec3> lambda(30, Vec3::Zero());
    CHECK(solver->solve(hard.problem, {1e-14, 2}, lambda).reason == StopReason::iteration_cap);

    // the same contact four times: W is singular, λ is not unique, u is
    const Mat3 block = Vec3(1.0, 0.7, 0.7).asDiagonal();
    DenseDelassus redundant(block.replicate(4, 4));
    ConeProblem problem{&redundant, std::vector<Vec3>(4, Vec3(-1, 0.2, 0.1)), std::vector<double>(4, 0.5), {}};
    if (!solver->applies(problem).empty()) continue;
    std::vector<Vec3> a(4, Vec3::Zero()), b(4, Vec3::Zero());
    CHECK(solver->solve(problem, {1e-12, 10000}, a).reason == StopReason::converged);
    solver->solve(problem, {1e-12, 10000}, b);
    CHECK(a == b);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& l : a) sum += l;
    CHECK((sum - solve_one_contact(block, Vec3(-1, 0.2, 0.1), 0.5)).norm() < 1e-9);
  }
}

TEST_CASE("every LCP solver: contradicting constraints end in a flagged, finite answer of least violation",
          "[methods]") {
  // a body of mass 1 between two walls that close at 1 m/s each: u_1 = v - 1, u_2 = -v - 1 can't both be >= 0
  MatX w = MatX::Zero(6, 6);
  w(0, 0) = w(3, 3) = 1.0;
  w(0, 3) = w(3, 0) = -1.0;
  DenseDelassus squeeze(w);
  const ConeProblem problem{&squeeze, {Vec3(-1, 0, 0), Vec3(-1, 0, 0)}, {0.0, 0.0}, {}};
  for (const auto& e : lcp_solvers()) {
    CAPTURE(e.name);
    std::vector<Vec3> lambda(2, Vec3::Zero());
    const LcpResult result = e.make()->solve(problem, {1e-10, 500}, lambda);
    CHECK_FALSE(result.solved());
    for (const Vec3& l : lambda) REQUIRE(l.allFinite());
    CHECK(std::abs(lambda[0].x() - lambda[1].x()) <= 1.0 + 1e-9);  // v: no wall is entered faster than it comes
  }
}

TEST_CASE("every LCP solver: attachments and sliding constraints hold as equations beside contacts", "[methods]") {
  for (const auto& e : lcp_solvers()) {
    CAPTURE(e.name);
    const auto solver = e.make();
    Random random(26);
    for (int trial = 0; trial < 20; ++trial) {
      RandomProblem p(random, 9, 30, 0.1, 0.4);
      for (int i = 0; i < 9; ++i)
        p.problem.kind.push_back(i % 3 == 0 ? RowKind::attachment : i % 3 == 1 ? RowKind::sliding : RowKind::contact);
      if (!solver->applies(p.problem).empty()) continue;
      std::vector<Vec3> lambda(9, Vec3::Zero());
      const LcpResult result = solver->solve(p.problem, {1e-11, 50000}, lambda);
      CAPTURE(trial, result.iterations, name_of(result.reason));
      REQUIRE(result.reason == StopReason::converged);
      VecX stacked(27);
      for (int i = 0; i < 9; ++i) stacked.segment<3>(3 * i) = lambda[i];
      const VecX u = p.w.matrix() * stacked;
      for (int i = 0; i < 9; ++i) {
        const Vec3 at = u.segment<3>(3 * i) + p.problem.q[i];
        if (i % 3 == 0) CHECK(at.norm() < 1e-10);
        if (i % 3 == 1) CHECK(std::abs(at.x()) < 1e-10);
        if (i % 3 == 1) CHECK(lambda[i].tail<2>().isZero(0.0));
        if (i % 3 == 2) CHECK(natural_map(p.w.diagonal(i), at, lambda[i], 0.4) < 1e-10);
      }
    }
  }
}

TEST_CASE("every LCP solver: the history holds the relative residual before the first and after each iteration",
          "[methods]") {
  for (const auto& e : lcp_solvers()) {
    CAPTURE(e.name);
    Random random(25);
    RandomProblem p(random, 12, 40, 0.1, 0.0);
    std::vector<double> history;
    std::vector<Vec3> lambda(12, Vec3::Zero());
    LcpSettings settings{1e-10, 5000};
    settings.history = &history;
    const LcpResult result = e.make()->solve(p.problem, settings, lambda);
    REQUIRE(result.reason == StopReason::converged);
    REQUIRE(history.size() >= 2);
    // pivots leave no λ in between
    if (e.name != "pivoting") CHECK(history.size() == std::size_t(result.iterations) + 1);
    CHECK(history.front() > 1e-3);
    CHECK(history.back() == Approx(judge(p.problem, lambda).map.relative).margin(1e-13));
  }
}

TEST_CASE("Gauss-Seidel on two stacked boxes contracts by r/(1+r) a sweep") {
  for (double r : {1.0, 10.0, 100.0}) {
    // box 1 (mass 1) on the ground, box 2 (mass r) on it; W of the two normals
    MatX w = MatX::Zero(6, 6);
    w(0, 0) = 1.0, w(0, 3) = w(3, 0) = -1.0, w(3, 3) = 1.0 + 1.0 / r;
    for (int i : {1, 2, 4, 5}) w(i, i) = 1.0;
    DenseDelassus operator_w(w);
    const Vec3 truth(1.0 + r, r, 0.0);
    const VecX exact = (VecX(6) << truth.x(), 0, 0, truth.y(), 0, 0).finished();
    const VecX q = -w * exact;
    ConeProblem problem{&operator_w, {q.head<3>(), q.tail<3>()}, {0.0, 0.0}, {}};
    const auto error_after = [&](int sweeps) {
      std::vector<Vec3> lambda(2, Vec3::Zero());
      find_entry(lcp_solvers(), "projected_gauss_seidel")->make()->solve(problem, {1e-300, sweeps}, lambda);
      return std::abs(lambda[0].x() - truth.x());
    };
    const double factor = std::pow(error_after(44) / error_after(4), 1.0 / 40.0);
    CHECK(factor == Approx(r / (1.0 + r)).epsilon(1e-6));
  }
}

TEST_CASE("the factored W of rigid bodies is the dense one") {
  Random random(24);
  GroupSystem group;
  for (int b = 0; b < 4; ++b) {
    RigidBlock block;
    block.inverse_mass = random.in(0.2, 2.0);
    const Mat3 r = random.rotation();
    block.inverse_inertia =
        r * Vec3(random.in(0.5, 5), random.in(0.5, 5), random.in(0.5, 5)).asDiagonal() * r.transpose();
    block.velocity = random.vector();
    block.angular_velocity = random.vector();
    group.rigid.push_back(block);
  }
  for (int c = 0; c < 12; ++c) {
    ContactRows rows;
    rows.a.rigid = random.below(4);
    rows.b.rigid = c % 3 == 0 ? -1 : (rows.a.rigid + 1 + random.below(3)) % 4;
    rows.directions = random.rotation();
    rows.a.arm = random.vector();
    rows.b.arm = random.vector();
    rows.friction = c % 2 ? 0.4 : 0.0;
    rows.bound = 0.1 * random.sym();
    group.contacts.push_back(rows);
    group.lambda.push_back(Vec3::Zero());
  }
  // J and A⁻¹ written out, [Haapaoja16 Eq. 4.11]
  MatX j = MatX::Zero(36, 24), inverse = MatX::Zero(24, 24);
  for (int b = 0; b < 4; ++b) {
    inverse.block<3, 3>(6 * b, 6 * b) = group.rigid[b].inverse_mass * Mat3::Identity();
    inverse.block<3, 3>(6 * b + 3, 6 * b + 3) = group.rigid[b].inverse_inertia;
  }
  for (int c = 0; c < 12; ++c)
    for (int k = 0; k < 3; ++k) {
      const ContactRows& rows = group.contacts[c];
      const Vec3 d = rows.directions.row(k);
      j.block<1, 3>(3 * c + k, 6 * rows.a.rigid) += d.transpose();
      j.block<1, 3>(3 * c + k, 6 * rows.a.rigid + 3) += rows.a.arm.cross(d).transpose();
      if (rows.b.rigid < 0) continue;
      j.block<1, 3>(3 * c + k, 6 * rows.b.rigid) -= d.transpose();
      j.block<1, 3>(3 * c + k, 6 * rows.b.rigid + 3) -= rows.b.arm.cross(d).transpose();
    }
  const MatX w = j * inverse * j.transpose();
  FactoredDelassus factored(group);
  std::vector<Vec3> lambda;
  VecX stacked(36);
  for (int c = 0; c < 12; ++c) {
    lambda.push_back(random.vector());
    if (group.contacts[c].friction == 0.0) lambda.back().tail<2>().setZero();
    stacked.segment<3>(3 * c) = lambda.back();
  }
  factored.begin(lambda);
  const VecX product = w * stacked;
  std::vector<Vec3> applied;
  factored.apply(lambda, applied);
  for (int c = 0; c < 12; ++c) CHECK((applied[c] - product.segment<3>(3 * c)).norm() < 1e-13);
  const MatX copy_of_w = factored.dense();
  for (const int r : rows_of(make_cone_problem(group)))
    for (const int c : rows_of(make_cone_problem(group))) CHECK(copy_of_w(r, c) == Approx(w(r, c)).margin(1e-13));
  factored.begin(lambda);
  for (int c = 0; c < 12; ++c) {
    CHECK((factored.diagonal(c) - w.block<3, 3>(3 * c, 3 * c)).norm() < 1e-13);
    CHECK((factored.row(c, false) - product.segment<3>(3 * c)).norm() < 1e-13);
    CHECK(factored.row(c, true).x() == Approx(product[3 * c]).margin(1e-13));
  }
  // every response: the judge, which builds neither W nor q, agrees that Δv = A⁻¹ J^T λ and that the contacts hold
  for (const auto& e : responses()) {
    GroupSystem copy = group;
    CAPTURE(e.name);
    const auto response = patient_response(e.name, 100000);
    ResponseContext context;
    context.lcp = {1e-12, 100000};
    CHECK(response->solve(copy, *lcp_solvers().front().make(), context).converged());
    const GroupVerdict verdict = judge_group(copy);
    if (!response->is_approximate()) CHECK(verdict.natural_map < 1e-10);
    CHECK(verdict.momentum < 1e-13);
  }
}
