#include "engine/preflight/highest_frequency.hpp"

#include <cmath>

#include "engine/core/interrupt.hpp"

namespace impinge {
namespace {

constexpr int kMostRounds = 2000;
constexpr double kAccuracy = 1e-6;  // change of ω² in a round, which is slower than the error by the gap of the modes

/// y = M⁻¹ x of the free nodes' mass matrix; a consistent one by conjugate gradients, which takes a few rounds on it.
class InverseMass {
 public:
  explicit InverseMass(const DeformableBody& body) : body_(body) {}

  VecX operator()(const VecX& x) const {
    const VecX start = by_lumped(x);
    if (body_.fem.mass_kind() == MassKind::lumped) return start;
    VecX y = start, r = x - times_mass(y), z = by_lumped(r), p = z;
    double rz = dot(r, z);
    const double enough = 1e-20 * dot(x, start);
    for (int round = 0; round < 100 && rz > enough; ++round) {
      const VecX q = times_mass(p);
      const double step = rz / dot(p, q);
      y += step * p, r -= step * q;
      z = by_lumped(r);
      const double before = rz;
      rz = dot(r, z);
      p = z + rz / before * p;
    }
    return y;
  }

 private:
  VecX by_lumped(VecX x) const {
    for (int i = 0; i < body_.free_nodes(); ++i) x.segment<3>(3 * i) /= body_.fem.node_mass()[body_.free_node()[i]];
    return x;
  }
  VecX times_mass(const VecX& x) const {
    VecX all = VecX::Zero(3 * body_.nodes()), y;
    body_.scatter_free(x, all);
    body_.fem.multiply_mass(all, y);
    return body_.gather_free(y);
  }
  const DeformableBody& body_;
};

}  // namespace

double highest_frequency(const DeformableBody& body) {
  if (body.free_nodes() == 0) return 0.0;
  FemAssembly fem = body.fem;  // its slots are written
  VecX rest(3 * body.nodes()), force;
  for (int i = 0; i < body.nodes(); ++i) rest.segment<3>(3 * i) = body.rest_position(i);
  BlockMatrix k(fem.pattern());
  fem.stiffness(rest, Tangent::exact, force, k);
  const InverseMass inverse_mass(body);
  // the stiffest mode is rough: no two neighbours of this one move alike
  VecX v(body.dofs());
  for (int i = 0; i < v.size(); ++i) v[i] = std::sin(1.0 + 2.399963 * i + 0.1 * i * i);
  double before = 0.0, square = 0.0;
  for (int round = 0; round < kMostRounds; ++round) {
    check_interrupt();
    VecX all = VecX::Zero(3 * body.nodes());
    body.scatter_free(v, all);
    const VecX kv = body.gather_free(k * all);
    square = dot(v, kv);  // Rayleigh's quotient, since vᵀ M v = 1 from the second round on
    v = inverse_mass(kv);
    const double size = dot(v, kv);
    if (!(size > 0.0)) return 0.0;
    v /= std::sqrt(size);
    if (round > 10 && std::abs(square - before) < kAccuracy * square) break;
    before = square;
  }
  return std::sqrt(std::max(square, 0.0));
}

}  // namespace impinge
