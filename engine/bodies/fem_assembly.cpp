#include "engine/bodies/fem_assembly.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

// an element takes about a microsecond, a node's sum a tenth of one
constexpr std::size_t kElementsPerTask = 64;
constexpr std::size_t kNodesPerTask = 256;

/// Half the modulus of confined compression: what is let go yields to no load that its own material would stand.
double unwinding_modulus(const Material& material) {
  return material.settings().mu() + 0.5 * material.settings().lambda();
}

}  // namespace

FemAssembly::FemAssembly(TetMesh rest, std::vector<FemMaterial> materials, MassKind mass,
                         std::vector<int> element_material, std::vector<double> fraction)
    : rest_(std::move(rest)),
      materials_(std::move(materials)),
      element_material_(std::move(element_material)),
      mass_kind_(mass) {
  const std::size_t count = rest_.tets.size();
  if (element_material_.empty()) element_material_.assign(count, 0);
  if (fraction.empty()) fraction.assign(count, 1.0);
  IMPINGE_ASSERT(element_material_.size() == count && fraction.size() == count && !materials_.empty());
  IMPINGE_ASSERT(count < std::numeric_limits<int>::max() / 32);
  elements_.reserve(count);
  for (std::size_t e = 0; e < count; ++e) {
    const Tet& t = rest_.tets[e];
    elements_.push_back(make_tet_rest(rest_.vertices[t[0]], rest_.vertices[t[1]], rest_.vertices[t[2]],
                                      rest_.vertices[t[3]], fraction[e]));
    IMPINGE_ASSERT(elements_.back().volume > 0.0);
  }
  pattern_ = std::make_shared<BlockPattern>(make_block_pattern(nodes(), rest_.tets));

  // counting sort by node and by block keeps the order of elements
  node_begin_.assign(nodes() + 1, 0);
  block_begin_.assign(pattern_->blocks() + 1, 0);
  std::vector<int> block_of(10 * count);
  for (std::size_t e = 0; e < count; ++e) {
    for (const int v : rest_.tets[e]) ++node_begin_[v + 1];
    for (int k = 0; k < 10; ++k) {
      const int i = rest_.tets[e][kBlockRow[k]], j = rest_.tets[e][kBlockColumn[k]];
      block_of[10 * e + k] = pattern_->find(std::min(i, j), std::max(i, j));
      ++block_begin_[block_of[10 * e + k] + 1];
    }
  }
  std::partial_sum(node_begin_.begin(), node_begin_.end(), node_begin_.begin());
  std::partial_sum(block_begin_.begin(), block_begin_.end(), block_begin_.begin());
  node_code_.resize(4 * count);
  block_code_.resize(10 * count);
  std::vector<int> node_cursor(node_begin_.begin(), node_begin_.end() - 1),
      block_cursor(block_begin_.begin(), block_begin_.end() - 1);
  for (std::size_t e = 0; e < count; ++e) {
    const int element = static_cast<int>(e);
    for (int k = 0; k < 4; ++k) node_code_[node_cursor[rest_.tets[e][k]]++] = 4 * element + k;
    for (int k = 0; k < 10; ++k) {
      const bool transposed = rest_.tets[e][kBlockRow[k]] > rest_.tets[e][kBlockColumn[k]];
      block_code_[block_cursor[block_of[10 * e + k]]++] = 32 * element + 2 * k + (transposed ? 1 : 0);
    }
  }
  slot_.resize(count);
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

double FemAssembly::total_mass() const { return std::accumulate(node_mass_.begin(), node_mass_.end(), 0.0); }

void FemAssembly::multiply_mass(const VecX& x, VecX& y) const {
  y.setZero(x.size());
  if (mass_kind_ == MassKind::lumped) {
    for (int i = 0; i < nodes(); ++i) y.segment<3>(3 * i) = node_mass_[i] * x.segment<3>(3 * i);
    return;
  }
  parallel_for(nodes(), kNodesPerTask, [&](std::size_t i) {
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
  return unwinding_.find(rest_, elements_, may, x);
}

double FemAssembly::total_energy() const {
  double sum = 0.0;
  for (const ElementResponse& slot : slot_) sum += slot.energy;
  return sum;
}

double FemAssembly::energy(const VecX& x) {
  parallel_for(elements_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    slot_[e].energy =
        unwinding_.lets_go(e) ? unwinding_.energy(elements_[e], c, e, unwinding_modulus(m)) : m.energy(elements_[e], c);
  });
  return total_energy();
}

void FemAssembly::gather_forces(VecX& f) const {
  f.resize(3 * nodes());
  parallel_for(nodes(), kNodesPerTask, [&](std::size_t i) {
    Vec3 sum = Vec3::Zero();
    for (int k = node_begin_[i]; k < node_begin_[i + 1]; ++k)
      sum += slot_[node_code_[k] / 4].force.col(node_code_[k] % 4);
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) = sum;
  });
}

double FemAssembly::forces(const VecX& x, VecX& f) {
  parallel_for(elements_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    if (unwinding_.lets_go(e))
      unwinding_.force(elements_[e], c, e, unwinding_modulus(m), slot_[e]);
    else
      m.force(elements_[e], c, slot_[e]);
  });
  gather_forces(f);
  return total_energy();
}

double FemAssembly::stiffness(const VecX& x, Tangent tangent, VecX& f, BlockMatrix& k) {
  IMPINGE_ASSERT(k.pattern == pattern_);
  parallel_for(elements_.size(), kElementsPerTask, [&](std::size_t e) {
    const Material& m = material(static_cast<int>(e));
    const Corners c = corners(x, static_cast<int>(e));
    if (unwinding_.lets_go(e))
      unwinding_.response(elements_[e], c, e, unwinding_modulus(m), slot_[e]);
    else
      m.response(elements_[e], c, tangent, slot_[e]);
  });
  gather_forces(f);
  parallel_for(nodes(), kNodesPerTask, [&](std::size_t i) {
    for (int block = pattern_->diagonal[i]; block < pattern_->begin[i + 1]; ++block) {
      Mat3 sum = Mat3::Zero();
      for (int c = block_begin_[block]; c < block_begin_[block + 1]; ++c) {
        const int code = block_code_[c];
        const Mat3& part = slot_[code / 32].stiffness[(code % 32) / 2];
        if (code % 2 == 0)
          sum += part;
        else
          sum += part.transpose();
      }
      k.values[block] = sum;
      k.values[pattern_->mirror[block]] = sum.transpose();
    }
  });
  return total_energy();
}

}  // namespace impinge
