// A second implementation of neo-Hookean statics, from the textbook's closed form: nothing of it is shared with
// engine/materials or engine/bodies.
#pragma once

#include <Eigen/SparseCholesky>
#include <cmath>
#include <vector>

#include "engine/geometry/tets/tet_mesh.hpp"

namespace impinge::test {

/// Equilibrium of linear tetrahedra with Ψ = μ/2 (tr FᵀF − 3) − μ ln J + λ/2 ln²J under gravity along y, consistent
/// mass; nodes at x = 0 are held. P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ, and its differential
/// dP = μ dF + (μ − λ ln J) F⁻ᵀ dFᵀ F⁻ᵀ + λ tr(F⁻¹ dF) F⁻ᵀ. Newton's method, steps halved while the energy rises.
/// Returns the positions; `residual` gets the largest force on a free node, N.
inline std::vector<Vec3> neo_hookean_rest(const TetMesh& mesh, double young, double poisson, double density,
                                          double gravity, double& residual) {
  const double mu = young / (2.0 * (1.0 + poisson)),
               lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  struct Tet {
    std::array<int, 4> node;
    Eigen::Matrix<double, 4, 3> gradient;  // of the shape functions
    double volume;
  };
  std::vector<Tet> tets;
  std::vector<double> weight(mesh.vertices.size(), 0.0);  // N, along y
  for (const auto& t : mesh.tets) {
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = mesh.vertices[t[k + 1]] - mesh.vertices[t[0]];
    Tet tet{{t[0], t[1], t[2], t[3]}, {}, edges.determinant() / 6.0};
    tet.gradient.bottomRows<3>() = edges.inverse();
    tet.gradient.row(0) = -tet.gradient.bottomRows<3>().colwise().sum();
    tets.push_back(tet);
    for (const int n : tet.node) weight[n] += density * gravity * tet.volume / 4.0;
  }
  std::vector<int> index(mesh.vertices.size(), -1);
  int free = 0;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (mesh.vertices[i].x() != 0.0) index[i] = free++;
  std::vector<Vec3> x = mesh.vertices;
  const auto deformation = [&](const std::vector<Vec3>& at, const Tet& t) {
    Mat3 f = Mat3::Zero();
    for (int k = 0; k < 4; ++k) f += at[t.node[k]] * t.gradient.row(k);
    return f;
  };
  const auto energy = [&](const std::vector<Vec3>& at) {
    double sum = 0.0;
    for (const Tet& t : tets) {
      const Mat3 f = deformation(at, t);
      if (!(f.determinant() > 0.0)) return std::numeric_limits<double>::infinity();
      const double log_j = std::log(f.determinant());
      sum += t.volume * (0.5 * mu * (f.squaredNorm() - 3.0) - mu * log_j + 0.5 * lambda * log_j * log_j);
    }
    for (std::size_t i = 0; i < at.size(); ++i) sum -= weight[i] * at[i].y();
    return sum;
  };
  residual = 0.0;
  for (int iteration = 0; iteration < 50; ++iteration) {
    VecX force = VecX::Zero(3 * free);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < index.size(); ++i)
      if (index[i] >= 0) force[3 * index[i] + 1] += weight[i];
    for (const Tet& t : tets) {
      const Mat3 f = deformation(x, t), inverse = f.inverse(), g = inverse.transpose();
      const double log_j = std::log(f.determinant());
      const Mat3 stress = mu * (f - g) + lambda * log_j * g;
      for (int a = 0; a < 4; ++a) {
        if (index[t.node[a]] < 0) continue;
        const Vec3 grad_a = t.gradient.row(a);
        force.segment<3>(3 * index[t.node[a]]) -= t.volume * stress * grad_a;
        for (int b = 0; b < 4; ++b)
          for (int c = 0; c < 3 && index[t.node[b]] >= 0; ++c) {
            const Mat3 df = Vec3::Unit(c) * t.gradient.row(b);
            const Mat3 dp =
                mu * df + (mu - lambda * log_j) * g * df.transpose() * g + lambda * (inverse * df).trace() * g;
            const Vec3 column = t.volume * dp * grad_a;
            for (int r = 0; r < 3; ++r)
              entries.emplace_back(3 * index[t.node[a]] + r, 3 * index[t.node[b]] + c, column[r]);
          }
      }
    }
    residual = force.cwiseAbs().maxCoeff();
    if (residual < 1e-9) break;
    Eigen::SparseMatrix<double> k(3 * free, 3 * free);
    k.setFromTriplets(entries.begin(), entries.end());
    const VecX step = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(k).solve(force);
    const std::vector<Vec3> before = x;
    const double start = energy(before);
    for (double length = 1.0; length > 1e-6; length *= 0.5) {
      for (std::size_t i = 0; i < x.size(); ++i)
        if (index[i] >= 0) x[i] = before[i] + length * step.segment<3>(3 * index[i]);
      if (energy(x) <= start + 1e-12 * std::abs(start)) break;
    }
  }
  return x;
}

}  // namespace impinge::test
