// Deformable bodies for tests, and static solutions to compare them with.
#pragma once

#include <Eigen/SVD>
#include <cmath>

#include "engine/geometry/tets/quadratic_tets.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "tests/support/mechanics/elements.hpp"

namespace impinge::test {

struct BodyOptions {
  std::string_view material = "corotational";
  double young = 1e5, poisson = 0.4, density = 1000.0;
  MassKind mass = MassKind::consistent;
  Tangent tangent = Tangent::automatic;
  ElementKind element = ElementKind::linear;
};

inline DeformableBody make_body(TetMesh mesh, const BodyOptions& o = {}) {
  std::shared_ptr<const Material> material = make_material(o.material, o.young, o.poisson, o.tangent);
  if (o.element == ElementKind::quadratic) mesh = cut_at_midpoints(mesh);
  return DeformableBody(FemAssembly(std::move(mesh), {{material, o.density}}, o.mass, {}, {}, o.element));
}

/// Nodes whose rest position fulfils the condition.
template <class Condition>
std::vector<int> nodes_where(const DeformableBody& body, Condition&& condition) {
  std::vector<int> nodes;
  for (int i = 0; i < body.nodes(); ++i)
    if (condition(body.fem.rest().vertices[i])) nodes.push_back(i);
  return nodes;
}

/// Moves inner nodes of a box mesh by up to `amount` of the cell, so that no two elements are alike.
inline void shake_inside(TetMesh& mesh, const Vec3& size, double amount, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& v : mesh.vertices) {
    const Vec3 move = amount * random.vector();
    if ((v.array() > 1e-9).all() && ((size - v).array() > 1e-9).all()) v += move;
  }
}

/// Equilibrium of the free nodes under `force` (over all nodes, N), by Newton's method from the present position, each
/// step halved while the energy rises. `pinned` (3 node + axis) components keep their position. Returns the last
/// residual, N.
inline double solve_static(DeformableBody& body, const VecX& force, std::string_view solver_name = "simplicial_llt",
                           int most = 60, double tolerance = 1e-10, const std::vector<int>& pinned = {}) {
  const auto solver = make_linear_solver(solver_name);
  solver->tolerance = 1e-12;
  solver->max_iterations = 100000;
  solver->analyze(*body.free_pattern());
  BlockMatrix k(body.fem.pattern());
  DeformableStep step;
  VecX f;
  double residual = 0.0;
  for (int i = 0; i < most; ++i) {
    const double energy = body.fem.stiffness(body.position, Tangent::projected, f, k) - force.dot(body.position);
    VecX all = f + force;
    for (const int c : pinned) all[c] = 0.0;
    const VecX g = body.gather_free(all);
    residual = g.norm();
    if (residual <= tolerance * std::max(f.norm(), 1e-12)) break;
    fill_system(body, 0.0, 0.0, 1.0, &k, step);
    // a diagonal entry this large leaves a pinned component where it is
    for (const int c : pinned)
      step.a.values[body.free_pattern()->diagonal[body.free_index()[c / 3]]](c % 3, c % 3) *= 1e20;
    if (solver->factorize(step.a) != SolveStatus::ok) return 1e300;
    VecX d = VecX::Zero(body.dofs());
    solver->solve(g, d);
    const VecX before = body.position;
    for (double length = 1.0; length > 1e-6; length *= 0.5) {
      VecX moved = VecX::Zero(before.size());
      body.scatter_free(length * d, moved);
      body.position = before + moved;
      if (body.fem.energy(body.position) - force.dot(body.position) <= energy + 1e-12 * std::abs(energy)) break;
    }
  }
  return residual;
}

/// Lowest mode of vibration about the rest shape: its shape over all nodes (unit modal mass) and ω in rad/s, by inverse
/// iteration on K φ = ω² M φ from a bend in no particular direction.
struct Mode {
  VecX shape;
  double omega = 0.0;
};
inline Mode lowest_mode(DeformableBody& body, std::string_view solver_name = "simplicial_llt", int iterations = 40) {
  const auto solver = make_linear_solver(solver_name);
  solver->tolerance = 1e-9;
  solver->max_iterations = 100000;
  solver->analyze(*body.free_pattern());
  BlockMatrix k(body.fem.pattern());
  VecX f, mass;
  body.fem.stiffness(body.position, Tangent::exact, f, k);
  DeformableStep step;
  fill_system(body, 0.0, 0.0, 1.0, &k, step);
  Mode mode;
  if (solver->factorize(step.a) != SolveStatus::ok) return mode;
  mode.shape.setZero(3 * body.nodes());
  for (const int i : body.free_node()) {
    const double x = body.fem.rest().vertices[i].x();
    mode.shape.segment<3>(3 * i) = x * x * Vec3(0, 1, -0.6);
  }
  VecX x = body.gather_free(mode.shape);
  for (int i = 0; i < iterations; ++i) {
    body.fem.multiply_mass(mode.shape, mass);
    solver->solve(body.gather_free(mass), x);
    body.scatter_free(x, mode.shape);
    body.fem.multiply_mass(mode.shape, mass);
    const double modal_mass = mode.shape.dot(mass);
    mode.omega = std::sqrt(x.dot(step.a * x) / modal_mass);
    mode.shape /= std::sqrt(modal_mass);
    x /= std::sqrt(modal_mass) * mode.omega * mode.omega;  // what the next solve will give: a good start
  }
  return mode;
}

/// Largest distance between nodes and the rest shape after the best rigid motion, m.
inline double distance_from_rest(const DeformableBody& body) {
  const Vec3 center = body.center_of_mass();
  Vec3 rest_center = Vec3::Zero();
  for (int i = 0; i < body.nodes(); ++i)
    rest_center += body.fem.node_mass()[i] * body.fem.rest().vertices[i] / body.fem.total_mass();
  Mat3 covariance = Mat3::Zero();
  for (int i = 0; i < body.nodes(); ++i)
    covariance += body.fem.node_mass()[i] * (Vec3(body.position.segment<3>(3 * i)) - center) *
                  (body.fem.rest().vertices[i] - rest_center).transpose();
  Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() < 0.0) turn = svd.matrixU() * Vec3(1, 1, -1).asDiagonal() * svd.matrixV().transpose();
  double largest = 0.0;
  for (int i = 0; i < body.nodes(); ++i)
    largest = std::max(
        largest,
        (Vec3(body.position.segment<3>(3 * i)) - center - turn * (body.fem.rest().vertices[i] - rest_center)).norm());
  return largest;
}

}  // namespace impinge::test
