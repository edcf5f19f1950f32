// What every registered response promises of any group: Δv belongs to λ, no contact pulls, friction stays in its cone,
// the same answer again. And what those promise that solve complementarity: the judge's natural map.
#include <catch2/catch.hpp>

#include "engine/geometry/tets/tet_mesh.hpp"
#include "engine/response/group_judge.hpp"
#include "engine/response/response.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Random bodies, rigid and deformable, with contacts, attachments and sliding points between them, and what they refer
/// to.
struct RandomGroup {
  GroupSystem system;
  std::vector<BlockMatrix> a;
  std::vector<std::unique_ptr<LinearSolver>> solvers;

  RandomGroup(std::uint64_t seed, int rigid, int soft, bool lumped, int contacts, bool frictionless = false) {
    Random random(seed);
    for (int b = 0; b < rigid; ++b) {
      RigidBlock block;
      block.inverse_mass = random.in(0.2, 2.0);
      const Mat3 r = random.rotation();
      block.inverse_inertia =
          r * Vec3(random.in(0.5, 5), random.in(0.5, 5), random.in(0.5, 5)).asDiagonal() * r.transpose();
      block.velocity = random.vector();
      block.angular_velocity = random.vector();
      system.rigid.push_back(block);
    }
    const TetMesh mesh = make_tet_box(Vec3::Ones(), 2, 2, 2);
    const int nodes = static_cast<int>(mesh.vertices.size());
    a.reserve(soft);
    for (int s = 0; s < soft; ++s) {
      BlockMatrix& m = a.emplace_back(std::make_shared<const BlockPattern>(make_block_pattern(nodes, mesh.tets)));
      const BlockPattern& p = *m.pattern;
      for (int i = 0; i < nodes; ++i) {
        m.values[p.diagonal[i]] += random.in(0.02, 0.1) * Mat3::Identity();
        for (int k = p.begin[i]; !lumped && k < p.begin[i + 1]; ++k) {
          const int j = p.column[k];
          if (j <= i) continue;
          const Mat3 r = random.rotation(),
                     spring = r * Vec3(random.in(0.01, 0.3), random.in(0.01, 0.3), random.in(0.01, 0.3)).asDiagonal() *
                              r.transpose();
          m.values[p.diagonal[i]] += spring;
          m.values[p.diagonal[j]] += spring;
          m.values[k] -= spring;
          m.values[p.mirror[k]] -= spring.transpose();
        }
      }
      solvers.push_back(make_linear_solver("simplicial_llt"));
      solvers.back()->analyze(p);
      DeformableBlock block;
      block.a = &m;
      block.solver = solvers.back().get();
      block.is_diagonal = lumped;
      block.velocity = VecX::Zero(3 * nodes);
      for (Eigen::Index i = 0; i < block.velocity.size(); ++i) block.velocity[i] = random.sym();
      block.displacement_velocity = block.velocity;
      system.deformable.push_back(block);
    }
    const int bodies = rigid + soft;
    const auto side = [&](int body) {
      ContactSide side;
      if (body < 0) return side;
      if (body < rigid) {
        side.rigid = body;
        side.arm = 0.5 * random.vector();
        return side;
      }
      side.deformable = body - rigid;
      const Tet& tet = mesh.tets[random.below(static_cast<int>(mesh.tets.size()))];
      Vec3 w(random.in(0.1, 1), random.in(0.1, 1), random.in(0.1, 1));
      w /= w.sum();
      for (int k = 0; k < 3; ++k) side.nodes.push_back({tet[k], w[k]});
      return side;
    };
    for (int c = 0; c < contacts; ++c) {
      ContactRows rows;
      const int first = random.below(bodies),
                second = c % 3 == 0 ? -1 : (first + 1 + random.below(std::max(1, bodies - 1))) % bodies;
      rows.a = side(first);
      rows.b = side(second == first ? -1 : second);
      rows.directions = random.rotation();
      if (c % 11 == 5) rows.kind = RowKind::sliding;
      if (c % 11 == 7) rows.kind = RowKind::attachment;
      rows.friction = frictionless || rows.kind != RowKind::contact || c % 4 == 0 ? 0.0 : random.in(0.1, 0.6);
      rows.gap = 1e-3 * random.sym();
      rows.bound = rows.kind != RowKind::contact ? 0.0 : rows.gap > 0.0 ? -rows.gap * 240.0 : 0.0;
      system.contacts.push_back(rows);
    }
    system.lambda.assign(contacts, Vec3::Zero());
    system.clear_delta();
  }
};

struct Case {
  int rigid, soft;
  bool lumped;
  int contacts;
};
constexpr Case kCases[] = {{4, 0, false, 9},  {0, 2, false, 8}, {0, 2, true, 8},
                           {3, 1, false, 10}, {2, 2, true, 12}, {1, 0, false, 1}};

ResponseContext patient() {
  ResponseContext context;
  context.lcp = {1e-11, 100000};
  return context;
}
constexpr int kMost = 100000;

}  // namespace

TEST_CASE("every response: Δv belongs to λ, no contact pulls, friction stays in its cone", "[methods]") {
  for (const auto& e : responses())
    for (const Case& c : kCases)
      for (std::uint64_t seed = 1; seed <= 4; ++seed)
        for (const bool implicit : {true, false}) {
          if (!implicit && e.name != "penalty") continue;
          CAPTURE(e.name, c.rigid, c.soft, c.lumped, seed, implicit);
          RandomGroup group(seed, c.rigid, c.soft, c.lumped, c.contacts);
          std::vector<RowText> rows;
          if (e.name == "penalty")
            rows = implicit ? std::vector<RowText>{{"stiffness", "1e5"}, {"damping", "10"}}
                            : std::vector<RowText>{{"form", "explicit"}, {"stiffness", "1e3"}, {"damping", "0.1"}};
          if (e.name == "quick") rows = {{"deformable_iterations", std::to_string(kMost)}};
          const auto response = patient_response(e.name, kMost, rows);
          const ResponseResult result = response->solve(group.system, *lcp_solvers().front().make(), patient());
          CHECK(result.converged());
          const GroupVerdict verdict = judge_group(group.system);
          CHECK(verdict.momentum < 1e-9);
          if (!response->is_approximate()) CHECK(verdict.natural_map < 1e-8);
          double acting = 0.0;
          for (std::size_t i = 0; i < group.system.contacts.size(); ++i) {
            const ContactRows& rows = group.system.contacts[i];
            const Vec3& lambda = group.system.lambda[i];
            REQUIRE(lambda.allFinite());
            acting = std::max(acting, lambda.norm());
            if (rows.has_one_row()) CHECK(lambda.tail<2>().norm() == 0.0);
            if (rows.kind != RowKind::contact) continue;
            CHECK(lambda.x() >= 0.0);
            CHECK(lambda.tail<2>().norm() <= rows.friction * lambda.x() * (1.0 + 1e-12));
          }
          if (c.contacts > 1) CHECK(acting > 0.0);
        }
}

TEST_CASE("every response gives the same bits again", "[methods]") {
  for (const auto& e : responses()) {
    CAPTURE(e.name);
    std::vector<Vec3> first;
    for (int run = 0; run < 2; ++run) {
      RandomGroup group(9, 3, 2, false, 12);
      e.make()->solve(group.system, *lcp_solvers().front().make(), ResponseContext{});
      if (run == 0) first = group.system.lambda;
      CHECK(first == group.system.lambda);
    }
  }
}

TEST_CASE("without friction impulses and constraint anticipation move bodies alike") {
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    RandomGroup exact(seed, 2, 2, false, 12, true);
    make_response("constraint_anticipation")->solve(exact.system, *lcp_solvers().front().make(), patient());
    for (const char* name : {"sequential_impulse", "simultaneous_impulse"}) {
      CAPTURE(seed, name);
      RandomGroup group(seed, 2, 2, false, 12, true);
      patient_response(name, kMost)->solve(group.system, *lcp_solvers().front().make(), patient());
      for (std::size_t b = 0; b < 2; ++b) {
        CHECK((group.system.delta_velocity[b] - exact.system.delta_velocity[b]).norm() < 1e-7);
        CHECK((group.system.deformable_delta[b] - exact.system.deformable_delta[b]).lpNorm<Eigen::Infinity>() < 1e-7);
      }
    }
  }
}

TEST_CASE("the implicit penalty obeys its own law: λ of the velocities that it leaves") {
  for (std::uint64_t seed = 40; seed < 48; ++seed) {
    CAPTURE(seed);
    RandomGroup group(seed, 2, 1, false, 10);
    constexpr double kStiffness = 1e5, kDamping = 20.0, kSlipSpeed = 1e-3;
    ResponseContext context;
    context.lcp.tolerance = 1e-11;
    const auto penalty = make_response("penalty", {{"stiffness", "1e5"}, {"damping", "20"}, {"slip_speed", "1e-3"}});
    const ResponseResult result = penalty->solve(group.system, *lcp_solvers().front().make(), context);
    REQUIRE(result.converged());
    const double h = context.time_step, slope = h * (h * kStiffness + kDamping);
    for (std::size_t i = 0; i < group.system.contacts.size(); ++i) {
      const ContactRows& rows = group.system.contacts[i];
      if (rows.kind != RowKind::contact) continue;
      const Vec3 u = group.system.contact_velocity(i, true), lambda = group.system.lambda[i];
      const double normal =
          std::max(0.0, rows.gap > 0.0 ? -slope * (u.x() + rows.gap / h) : -h * kStiffness * rows.gap - slope * u.x());
      CHECK(lambda.x() == Approx(normal).margin(1e-7));
      const double y = std::min(1.0, u.tail<2>().norm() / kSlipSpeed);
      CHECK(lambda.tail<2>().norm() == Approx(rows.friction * normal * (2 * y - y * y)).margin(1e-6));
      if (rows.friction > 0.0 && normal > 1e-6) CHECK(lambda.tail<2>().dot(u.tail<2>()) <= 0.0);
    }
  }
}
