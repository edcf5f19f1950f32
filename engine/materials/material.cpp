#include "engine/materials/material.hpp"

namespace impinge {

void Material::declare(const Rows& rows) {
  rows.add("young", settings_.young, {1e-3, 1e15, true}, "Pa", "Young's modulus.");
  rows.add("poisson", settings_.poisson, {0.0, 0.49999}, "", "Poisson's ratio.");
  rows.add("tangent", settings_.tangent,
           {{Tangent::automatic, "automatic"}, {Tangent::exact, "exact"}, {Tangent::projected, "projected"}},
           "Derivative of the force in linear systems: the material's own choice, exact, or never indefinite.");
}

TetRest make_tet_rest(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double fraction) {
  Mat3 edges;
  edges << b - a, c - a, d - a;
  const Mat3 inverse = edges.inverse();
  TetRest rest;
  for (int k = 0; k < 3; ++k) rest.gradient.col(k + 1) = inverse.row(k).transpose();
  rest.gradient.col(0) = -(rest.gradient.col(1) + rest.gradient.col(2) + rest.gradient.col(3));
  rest.volume = fraction * edges.determinant() / 6.0;
  rest.edge_length = {(b - a).norm(), (c - a).norm(), (d - a).norm(), (c - b).norm(), (d - b).norm(), (d - c).norm()};
  return rest;
}

Mat12 full_stiffness(const ElementResponse& response) {
  Mat12 k;
  for (int i = 0; i < 10; ++i) {
    k.block<3, 3>(3 * kBlockRow[i], 3 * kBlockColumn[i]) = response.stiffness[i];
    k.block<3, 3>(3 * kBlockColumn[i], 3 * kBlockRow[i]) = response.stiffness[i].transpose();
  }
  return k;
}

}  // namespace impinge
