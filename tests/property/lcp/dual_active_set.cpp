// Contacts without friction, many more of them than bodies can tell apart, and equations among them: the dual active-set
// method against optimality itself (the answer's velocities are unique) and against Newton's.
#include <catch2/catch.hpp>

#include "engine/lcp/lcp_solver.hpp"
#include "tests/support/mechanics/dense_delassus.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Linkage {
  MatX jacobian;  // 3 rows a contact
  VecX mass, free;
  DenseDelassus w;
  ConeProblem problem;
};

/// `contacts` between bodies of unlike masses (over `decades`), each row on two of them; one of `equations` holds a point.
Linkage make_linkage(Random& random, int bodies, int contacts, double decades, int equations) {
  MatX j = MatX::Zero(3 * contacts, 6 * bodies);
  VecX mass(6 * bodies), free(6 * bodies);
  for (int b = 0; b < bodies; ++b) mass.segment<6>(6 * b).setConstant(std::pow(10.0, random.in(0.0, decades)));
  for (double& v : free) v = random.sym();
  for (int i = 0; i < contacts; ++i) {
    const int a = random.below(bodies), b = random.below(bodies);
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 6; ++c) j(3 * i + k, 6 * a + c) = random.sym();
      if (a == b) continue;
      for (int c = 0; c < 6; ++c) j(3 * i + k, 6 * b + c) = random.sym();
    }
    if (i % 3 == 2) j.row(3 * i) = j.row(3 * i - 3);  // the same again
  }
  const MatX w = j * mass.cwiseInverse().asDiagonal() * j.transpose();
  Linkage made{j, mass, free, DenseDelassus(0.5 * (w + w.transpose())), {}};
  const VecX closing = j * free;
  for (int i = 0; i < contacts; ++i) {
    made.problem.q.push_back(closing.segment<3>(3 * i));
    made.problem.mu.push_back(0.0);
    made.problem.kind.push_back(i >= equations ? RowKind::contact
                                : i % 2 == 0   ? RowKind::attachment
                                               : RowKind::sliding);
  }
  return made;
}

VecX velocities_of(const Linkage& linkage, const std::vector<Vec3>& lambda) {
  VecX all(linkage.jacobian.rows());
  for (std::size_t i = 0; i < lambda.size(); ++i) all.segment<3>(3 * static_cast<Eigen::Index>(i)) = lambda[i];
  return linkage.free + linkage.mass.cwiseInverse().asDiagonal() * (linkage.jacobian.transpose() * all);
}

LcpResult solve_by(const char* name, const Linkage& linkage, std::vector<Vec3>& lambda) {
  ConeProblem problem = linkage.problem;
  DenseDelassus w = linkage.w;
  problem.w = &w;
  const LcpResult result = find_entry(lcp_solvers(), name)->make()->solve(problem, {1e-9, 20000}, lambda);
  if (result.reason == StopReason::converged) CHECK(judge(problem, lambda).map.relative <= 1e-9);
  return result;
}

}  // namespace

TEST_CASE("contacts without friction that are redundant are answered exactly, also beside equations") {
  Random random(77);
  int answered = 0, by_both = 0, most = 0;
  for (int i = 0; i < 300; ++i) {
    const int bodies = 1 + random.below(12), contacts = 1 + random.below(8 * bodies);
    const Linkage made = make_linkage(random, bodies, contacts, random.in(0.0, 4.0), std::min(bodies, contacts / 4));
    std::vector<Vec3> lambda(contacts, Vec3::Zero()), other = lambda;
    if (i % 2 == 0)
      for (Vec3& of_contact : lambda) of_contact.x() = std::max(0.0, random.sym());  // from anywhere
    CAPTURE(i, bodies, contacts);
    const LcpResult result = solve_by("dual_active_set", made, lambda);
    if (result.reason != StopReason::converged) continue;  // more asked for than bodies can do: looked at below
    ++answered;
    most = std::max(most, result.iterations);
    CHECK(result.iterations <= 20 * (contacts + 1));
    // the answer is the velocity that is nearest to the free one of those that are allowed: none on the way to it is
    const VecX v = velocities_of(made, lambda);
    if (solve_by("semismooth_newton", made, other).reason != StopReason::converged) continue;
    ++by_both;
    const VecX apart = v - velocities_of(made, other);
    CHECK(apart.cwiseAbs().maxCoeff() < 1e-5);
  }
  CAPTURE(answered, by_both, most);
  CHECK(answered > 150);
  CHECK(by_both > 100);
}

TEST_CASE("contacts that contradict each other are given up, and nothing is claimed") {
  // one body of one kilogram between two walls that close: its velocity is to be over 1 and below -1
  MatX w = MatX::Zero(6, 6);
  w.diagonal().setOnes();
  w(0, 3) = w(3, 0) = -1.0;
  DenseDelassus operator_of(w);
  ConeProblem problem;
  problem.w = &operator_of;
  problem.q = {Vec3(-1, 0, 0), Vec3(-1, 0, 0)};
  problem.mu = {0.0, 0.0};
  std::vector<Vec3> lambda(2, Vec3::Zero());
  const LcpResult result = find_entry(lcp_solvers(), "dual_active_set")->make()->solve(problem, {1e-8, 1000}, lambda);
  CHECK(result.reason == StopReason::contradiction);
  CHECK(result.iterations < 20);
  // along it they move nothing and push against what is asked for
  CHECK(lambda[0].x() == Approx(lambda[1].x()).epsilon(1e-12));
  CHECK(lambda[0].x() == Approx(1.0).epsilon(0.1));
  CHECK(judge(problem, lambda).map.relative <= 1.0);  // no worse than nothing
}

TEST_CASE("a wedge between walls that close goes out, and contradicts them where no motion would do") {
  // one kilogram in the plane, normals (1, slope) and (-1, slope), each wall at 1 m/s: it has to go out with 1 / slope
  for (const double slope : {1.0, 0.1, 1e-2, 3e-3, 1e-5, 1e-7, 0.0}) {
    MatX w = MatX::Zero(6, 6);
    w.diagonal().setOnes();
    w(0, 0) = w(3, 3) = 1.0 + slope * slope;
    w(0, 3) = w(3, 0) = slope * slope - 1.0;
    DenseDelassus operator_of(w);
    ConeProblem problem;
    problem.w = &operator_of;
    problem.q = {Vec3(-1, 0, 0), Vec3(-1, 0, 0)};
    problem.mu = {0.0, 0.0};
    for (const double from : {0.0, 1e9}) {  // also from what somebody left who found no answer
      std::vector<Vec3> lambda = {Vec3(from, 0, 0), Vec3(from, 0, 0)};
      const LcpResult result =
          find_entry(lcp_solvers(), "dual_active_set")->make()->solve(problem, {1e-8, 1000}, lambda);
      CAPTURE(slope, from, lambda[0].x(), lambda[1].x());
      const bool is_thin = slope <= 1e-5;
      CHECK(result.reason == (is_thin ? StopReason::contradiction : StopReason::converged));
      if (is_thin) continue;
      CHECK(slope * (lambda[0].x() + lambda[1].x()) == Approx(1.0 / slope).epsilon(1e-6));
    }
  }
}

TEST_CASE("of many forces that carry alike those are taken that are nearest to what came") {
  // four legs under one body that only rises: any split of its weight will do
  MatX w = MatX::Zero(12, 12);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) w(3 * a, 3 * b) = 1.0;
  for (Eigen::Index k = 0; k < 12; ++k)
    if (k % 3 != 0) w(k, k) = 1.0;
  DenseDelassus operator_of(w);
  ConeProblem problem;
  problem.w = &operator_of;
  problem.q.assign(4, Vec3(-10, 0, 0));
  problem.mu.assign(4, 0.0);
  std::vector<Vec3> lambda = {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3::Zero()};
  const LcpResult result = find_entry(lcp_solvers(), "dual_active_set")->make()->solve(problem, {1e-10, 1000}, lambda);
  REQUIRE(result.reason == StopReason::converged);
  // the nearest: 4 N s more in all, one more for each
  CHECK(lambda[0].x() == Approx(2.0).margin(1e-4));
  CHECK(lambda[1].x() == Approx(3.0).margin(1e-4));
  CHECK(lambda[2].x() == Approx(4.0).margin(1e-4));
  CHECK(lambda[3].x() == Approx(1.0).margin(1e-4));
}
