#include "engine/elements/unwinding.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/support/mechanics/fem.hpp"

using namespace impinge;

namespace {

VecX flat(const TetMesh& mesh) {
  VecX x(3 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) x.segment<3>(3 * i) = mesh.vertices[i];
  return x;
}

/// n tetrahedra round the edge from (0, 0, 0) to (0, 0, 1), node k of the ring at `turns` k/n of a turn.
TetMesh ring(int n, double turns) {
  TetMesh mesh;
  mesh.vertices = {Vec3::Zero(), Vec3::UnitZ()};
  for (int k = 0; k < n; ++k) {
    const double angle = 2.0 * M_PI * turns * k / n;
    mesh.vertices.push_back(Vec3(std::cos(angle), std::sin(angle), 0.4 + 0.1 * (k % 3)));
    mesh.tets.push_back({0, 1, 2 + k, 2 + (k + 1) % n});
  }
  return mesh;
}

}  // namespace

TEST_CASE("inner edges are those that lie on no boundary triangle") {
  const TetMesh mesh = make_tet_box(Vec3(1, 2, 3), 3, 2, 4);
  std::set<std::array<int, 2>> inner;
  for (const Tet& tet : mesh.tets)
    for (const auto& [a, b] : kTetEdges) inner.insert({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
  for (const Triangle& t : boundary_triangles(mesh))
    for (int k = 0; k < 3; ++k) inner.erase({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  const TetWinding winding(mesh);
  REQUIRE(winding.inner_edges() == static_cast<int>(inner.size()));
  for (int i = 0; i < winding.inner_edges(); ++i) CHECK(inner.count(winding.edge(i)) == 1);
}

TEST_CASE("a winding is the turns of the ring: 1 however it is stretched, 2, −1 or 0 in a tangle") {
  for (int n = 5; n < 9; ++n)
    for (const int turns : {1, 2, -1, -2, 0}) {
      const TetWinding winding(ring(n, 1.0));
      REQUIRE(winding.inner_edges() == 1);
      const TetMesh wound = ring(n, turns);
      CHECK(winding.winding(flat(wound), 0) == turns);
      // wound twice, yet no element is inverted
      if (turns == 2)
        for (const Tet& tet : wound.tets) CHECK(tet_volume(wound, tet) > 0.0);
    }
  TetMesh box = make_tet_box(Vec3::Ones(), 3, 3, 3);
  test::shake_inside(box, Vec3::Ones(), 0.07, 1);
  const TetWinding winding(box);
  test::Random random(2);
  const Mat3 f = test::stretched(random, Vec3(5.0, 1.0, 0.01)), mirror = Vec3(1, 1, -1).asDiagonal();
  for (const auto& [map, expected] :
       {std::pair(f, 1), std::pair(Mat3(f * mirror), -1), std::pair(Mat3(Mat3::Zero()), 0)})
    for (int i = 0; i < winding.inner_edges(); ++i) {
      VecX x = flat(box);
      for (Eigen::Index k = 0; k < x.size(); k += 3) x.segment<3>(k) = map * x.segment<3>(k);
      CHECK(winding.winding(x, i) == expected);
    }
}

TEST_CASE("windings of nodes placed at random are the sum of the angles") {
  const TetMesh box = make_tet_box(Vec3::Ones(), 3, 3, 3);
  const TetWinding winding(box);
  test::Random random(3);
  VecX x(3 * box.vertices.size());
  for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = random.sym();
  int other = 0;
  for (int i = 0; i < winding.inner_edges(); ++i) {
    const auto at = [&](int node) { return Vec3(x.segment<3>(3 * node)); };
    const auto [a, b] = winding.edge(i);
    const Vec3 axis = (at(b) - at(a)).normalized();
    double sum = 0.0;
    for (const Tet& tet : box.tets) {
      std::vector<int> others;
      for (const int node : tet)
        if (node != a && node != b) others.push_back(node);
      if (others.size() != 2) continue;
      // order so that (a, b, c, d) is positive at rest
      if (tet_volume(box.vertices[a], box.vertices[b], box.vertices[others[0]], box.vertices[others[1]]) < 0.0)
        std::swap(others[0], others[1]);
      const Vec3 c = at(others[0]) - at(a), d = at(others[1]) - at(a);
      const Vec3 p = c - axis * axis.dot(c), q = d - axis * axis.dot(d);
      sum += std::atan2(axis.dot(p.cross(q)), p.dot(q));
    }
    const double turns = sum / (2.0 * M_PI);
    CHECK(winding.winding(x, i) == Approx(turns).margin(1e-9));
    other += winding.winding(x, i) != 1;
  }
  CHECK(other > 10);
}

TEST_CASE("only tangled elements of materials that unwind are let go, and while they are") {
  for (const auto& entry : materials()) {
    CAPTURE(std::string(entry.name));
    const bool unwinds = entry.name == "neo_hookean" || entry.name == "fixed_corotated";
    DeformableBody body = test::make_body(make_tet_box(Vec3::Ones(), 5, 4, 4), {.material = entry.name});
    const int elements = static_cast<int>(body.fem.elements().size());
    test::Random random(4);
    VecX x = body.position;
    // a strong deformation without inversion is no tangle
    for (int i = 0; i < body.nodes(); ++i)
      x.segment<3>(3 * i) = Vec3(Vec3(2.0, 0.7, 0.2).asDiagonal() * x.segment<3>(3 * i)) + 0.002 * random.vector();
    CHECK(body.fem.release_tangles(x) == 0);
    VecX own, f;
    body.fem.forces(x, own);
    // one node pushed through its neighbours: those round it and round them
    VecX pushed = body.position;
    const int node = (2 * 5 + 2) * 6 + 2;
    pushed[3 * node] += 0.5;
    const int count = body.fem.release_tangles(pushed);
    CHECK((count > 0) == unwinds);
    CHECK(count < elements);
    CHECK(body.fem.release_tangles(x) == 0);
    body.fem.forces(x, f);
    CHECK((f - own).norm() == 0.0);
  }
}

TEST_CASE(
    "elements that are let go: force and stiffness are derivatives, no net force, no torque, no tangled minimum") {
  DeformableBody body = test::make_body(make_tet_box(Vec3::Ones(), 2, 2, 2), {.material = "neo_hookean"});
  test::Random random(5);
  for (Eigen::Index k = 0; k < body.position.size(); ++k) body.position[k] = random.sym();
  REQUIRE(body.fem.release_tangles(body.position) == 48);
  VecX f, other, direction(body.position.size());
  BlockMatrix stiffness(body.fem.pattern());
  for (const Tangent tangent : {Tangent::automatic, Tangent::exact, Tangent::projected}) {
    body.fem.stiffness(body.position, tangent, f, stiffness);
    for (Eigen::Index k = 0; k < direction.size(); ++k) direction[k] = random.sym();
    const double h = 1e-5;
    const double slope =
        (body.fem.energy(body.position + h * direction) - body.fem.energy(body.position - h * direction)) / (2.0 * h);
    CHECK(slope == Approx(-f.dot(direction)).epsilon(1e-8));
    VecX more, less;
    body.fem.forces(body.position + h * direction, more);
    body.fem.forces(body.position - h * direction, less);
    CHECK(((less - more) / (2.0 * h) - stiffness * direction).norm() < 1e-8 * (stiffness * direction).norm());
  }
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  for (int i = 0; i < body.nodes(); ++i) {
    sum += f.segment<3>(3 * i);
    torque += Vec3(body.position.segment<3>(3 * i)).cross(Vec3(f.segment<3>(3 * i)));
  }
  CHECK(sum.norm() < 1e-11 * f.norm());
  CHECK(torque.norm() < 1e-11 * f.norm());
  // convex: one Newton step from anywhere is the minimum, a rigid motion of the rest shape
  test::solve_static(body, VecX::Zero(f.size()), "conjugate_gradient", 3, 1e-9);
  CHECK(test::distance_from_rest(body) < 1e-7);
  CHECK(body.smallest_volume_ratio() == Approx(1.0).epsilon(1e-6));
}
