#include "engine/elements/fem_assembly.hpp"

#include <algorithm>
#include <numeric>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/elements/discrete_gradient.hpp"
#include "engine/elements/quadratic_elements.hpp"
#include "engine/elements/rigid_motions.hpp"

namespace impinge {
namespace {

// an element takes about a microsecond, a quadratic one some seven, a node's product with the mass a tenth of one
constexpr std::size_t kElementsPerTask = 64;
constexpr std::size_t kQuadraticPerTask = 8;
constexpr std::size_t kForcesPerTask = 256;

/// Half the modulus of confined compression: what is let go yields to no load that its own material would stand.
double unwinding_modulus(const Material& material) {
  return material.settings().mu() + 0.5 * material.settings().lambda();
}

}  // namespace

FemAssembly::FemAssembly(TetMesh rest, std::vector<FemMaterial> materials, MassKind mass,
                         std::vector<int> element_material, std::vector<double> fraction, ElementKind kind)
    : rest_(std::move(rest)),
      materials_(std::move(materials)),
      element_material_(std::move(element_material)),
      mass_kind_(mass) {
  const std::size_t count = rest_.tets.size();
  if (element_material_.empty()) element_material_.assign(count, 0);
  if (fraction.empty()) fraction.assign(count, 1.0);
  IMPINGE_ASSERT(element_material_.size() == count && fraction.size() == count && !materials_.empty());
  elements_.reserve(count);
  for (std::size_t e = 0; e < count; ++e) {
    const Tet& t = rest_.tets[e];
    elements_.push_back(make_tet_rest(rest_.vertices[t[0]], rest_.vertices[t[1]], rest_.vertices[t[2]],
                                      rest_.vertices[t[3]], fraction[e]));
    IMPINGE_ASSERT(elements_.back().volume > 0.0);
  }
  if (kind == ElementKind::quadratic) {
    quadratic_ = std::make_shared<QuadraticElements>(rest_, fraction);
    pattern_ = std::make_shared<BlockPattern>(quadratic_->pattern(nodes()));
    quadratic_sums_ = ElementSums<10>(*pattern_, quadratic_->all_nodes());
    quadratic_slot_.resize(quadratic_->count());
  } else {
    pattern_ = std::make_shared<BlockPattern>(make_block_pattern(nodes(), rest_.tets));
    sums_ = ElementSums<4>(*pattern_, rest_.tets);
    slot_.resize(count);
  }
  make_mass();
}

void FemAssembly::set_material(int index, FemMaterial material) {
  const bool heavier = materials_.at(index).density != material.density;
  materials_[index] = std::move(material);
  if (heavier) make_mass();
}

void FemAssembly::make_mass() {
  node_mass_.assign(nodes(), 0.0);
  block_mass_.assign(pattern_->blocks(), 0.0);
  if (quadratic_)
    make_quadratic_mass();
  else
    make_linear_mass();
}

void FemAssembly::make_linear_mass() {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const double mass = materials_[element_material_[e]].density * elements_[e].volume;
    const Tet& tet = rest_.tets[e];
    for (int a = 0; a < 4; ++a) {
      node_mass_[tet[a]] += 0.25 * mass;
      // ∫ N_a N_b = V/20, V/10 for a = b
      if (mass_kind_ == MassKind::consistent)
        for (int b = 0; b < 4; ++b) block_mass_[pattern_->find(tet[a], tet[b])] += mass * (a == b ? 0.1 : 0.05);
    }
  }
  if (mass_kind_ == MassKind::lumped)
    for (int i = 0; i < nodes(); ++i) block_mass_[pattern_->diagonal[i]] = node_mass_[i];
}

void FemAssembly::make_quadratic_mass() {
  const bool lumped = mass_kind_ == MassKind::lumped;
  for (int e = 0; e < quadratic_->count(); ++e) {
    const double mass = materials_[element_material_[kTetParts * e]].density * quadratic_->volume(e);
    const QuadraticTet& node = quadratic_->nodes(e);
    for (int a = 0; a < 10; ++a)
      for (int b = 0; b < 10; ++b) {
        const double part = mass * QuadraticElements::mass(a, b, lumped);
        if (part == 0.0) continue;
        node_mass_[node[a]] += part;
        block_mass_[pattern_->find(node[a], node[b])] += part;
      }
  }
}

double FemAssembly::total_mass() const { return std::accumulate(node_mass_.begin(), node_mass_.end(), 0.0); }

void FemAssembly::multiply_mass(const VecX& x, VecX& y) const {
  y.setZero(x.size());
  if (mass_kind_ == MassKind::lumped) {
    for (int i = 0; i < nodes(); ++i) y.segment<3>(3 * i) = node_mass_[i] * x.segment<3>(3 * i);
    return;
  }
  parallel_for(nodes(), kForcesPerTask, [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for (int k = pattern_->begin[i]; k < pattern_->begin[i + 1]; ++k)
      sum += block_mass_[k] * x.segment<3>(3 * pattern_->column[k]);
    y.segment<3>(3 * static_cast<Eigen::Index>(i)) = sum;
  });
}

Corners FemAssembly::corners(const VecX& x, int element) const {
  const Tet& tet = rest_.tets[element];
  Corners c;
  for (int k = 0; k < 4; ++k) c.col(k) = x.segment<3>(3 * tet[k]);
  return c;
}

int FemAssembly::release_tangles(const VecX& x) {
  std::vector<char> may(elements_.size());
  for (std::size_t e = 0; e < may.size(); ++e) may[e] = material(static_cast<int>(e)).unwinds();
  if (std::find(may.begin(), may.end(), 1) == may.end()) {
    unwinding_.clear();
    return 0;
  }
  return unwinding_.find(rest_, elements_, may, x, quadratic_ ? kTetParts : 1);
}

std::vector<ElementPoint> FemAssembly::stress_points(int tet, const VecX& x) const {
  if (!quadratic_) return {{elements_[tet], corners(x, tet)}};
  const std::array<ElementPoint, 2> both = quadratic_->stress_points(rest_, tet, x);
  return {both.begin(), both.end()};
}

double FemAssembly::total_energy() const {
  double sum = 0.0;
  for (const ElementResponse& slot : slot_) sum += slot.energy;
  for (const QuadraticAnswer& slot : quadratic_slot_) sum += slot.energy;
  return sum;
}

double FemAssembly::energy(const VecX& x) {
  parallel_for(slot_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    slot_[e].energy =
        unwinding_.lets_go(e) ? unwinding_.energy(elements_[e], c, e, unwinding_modulus(m)) : m.energy(elements_[e], c);
  });
  parallel_for(quadratic_slot_.size(), kQuadraticPerTask, [&](std::size_t i) {
    const int e = static_cast<int>(i);
    const Material& m = material(kTetParts * e);
    quadratic_slot_[i].energy = quadratic_->energy(e, m, x, unwinding_, unwinding_modulus(m));
  });
  return total_energy();
}

double FemAssembly::forces(const VecX& x, VecX& f) {
  parallel_for(slot_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    if (unwinding_.lets_go(e))
      unwinding_.force(elements_[e], c, e, unwinding_modulus(m), slot_[e]);
    else
      m.force(elements_[e], c, slot_[e]);
  });
  parallel_for(quadratic_slot_.size(), kQuadraticPerTask, [&](std::size_t i) {
    const int e = static_cast<int>(i);
    const Material& m = material(kTetParts * e);
    quadratic_->force(e, m, x, unwinding_, unwinding_modulus(m), quadratic_slot_[i]);
  });
  gather_forces(f);
  return total_energy();
}

void FemAssembly::gather_forces(VecX& f) const {
  if (quadratic_)
    quadratic_sums_.gather_forces(quadratic_slot_, f);
  else
    sums_.gather_forces(slot_, f);
}

double FemAssembly::mean_forces(const VecX& x0, const VecX& x1, VecX& f) {
  parallel_for(slot_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c0 = corners(x0, static_cast<int>(e)), c1 = corners(x1, static_cast<int>(e));
    if (unwinding_.lets_go(e))
      unwinding_.force(elements_[e], 0.5 * (c0 + c1), e, unwinding_modulus(m), slot_[e]);  // of a quadratic energy
    else
      discrete_gradient(m, elements_[e], c0, c1, slot_[e]);
  });
  parallel_for(quadratic_slot_.size(), kQuadraticPerTask, [&](std::size_t i) {
    const int e = static_cast<int>(i);
    const Material& m = material(kTetParts * e);
    quadratic_->mean_force(e, m, x0, x1, unwinding_, unwinding_modulus(m), quadratic_slot_[i]);
  });
  gather_forces(f);
  return total_energy();
}

double FemAssembly::stiffness(const VecX& x, Tangent tangent, VecX& f, BlockMatrix& k) {
  IMPINGE_ASSERT(k.pattern == pattern_);
  parallel_for(slot_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    if (unwinding_.lets_go(e))
      unwinding_.response(elements_[e], c, e, unwinding_modulus(m), slot_[e]);
    else
      m.response(elements_[e], c, tangent, slot_[e]);
  });
  parallel_for(quadratic_slot_.size(), kQuadraticPerTask, [&](std::size_t i) {
    const int e = static_cast<int>(i);
    const Material& m = material(kTetParts * e);
    quadratic_->response(e, m, x, tangent, unwinding_, unwinding_modulus(m), quadratic_slot_[i]);
  });
  if (quadratic_) {
    quadratic_sums_.gather_forces(quadratic_slot_, f);
    quadratic_sums_.gather_stiffness(quadratic_slot_, k);
  } else {
    sums_.gather_forces(slot_, f);
    sums_.gather_stiffness(slot_, k);
  }
  return total_energy();
}

void FemAssembly::damping_stiffness(const VecX& x, BlockMatrix& k) {
  IMPINGE_ASSERT(k.pattern == pattern_);
  parallel_for(slot_.size(), kElementsPerTask, [&](std::size_t e) {
    const int element = static_cast<int>(e);
    if (material(element).is_objective()) leave_rigid_motions<4>(corners(x, element), slot_[e]);
  });
  parallel_for(quadratic_slot_.size(), kQuadraticPerTask, [&](std::size_t i) {
    const int e = static_cast<int>(i);
    if (!material(kTetParts * e).is_objective()) return;
    const QuadraticTet& node = quadratic_->nodes(e);
    Eigen::Matrix<double, 3, 10> at;
    for (int a = 0; a < 10; ++a) at.col(a) = x.segment<3>(3 * node[a]);
    leave_rigid_motions<10>(at, quadratic_slot_[i]);
  });
  if (quadratic_)
    quadratic_sums_.gather_stiffness(quadratic_slot_, k);
  else
    sums_.gather_stiffness(slot_, k);
}

}  // namespace impinge
