#include "engine/elements/unwinding.hpp"

#include <algorithm>

#include "engine/core/parallel.hpp"
#include "engine/geometry/disjoint_sets.hpp"
#include "engine/geometry/svd3.hpp"

namespace impinge {
namespace {

constexpr std::size_t kPerTask = 256;

Mat3 gradient_of(const TetRest& rest, const Tet& tet, const VecX& x) {
  Corners corners;
  for (int k = 0; k < 4; ++k) corners.col(k) = x.segment<3>(3 * tet[k]);
  return deformation_gradient(rest, corners);
}

}  // namespace

std::vector<char> Unwinding::tangled_nodes(const TetMesh& rest, const std::vector<TetRest>& elements, const VecX& x) {
  if (winding_.inner_edges() == 0) winding_ = TetWinding(rest);
  std::vector<char> wound(winding_.inner_edges()), inverted(rest.tets.size());
  parallel_for(wound.size(), kPerTask,
               [&](std::size_t i) { wound[i] = winding_.winding(x, static_cast<int>(i)) != 1; });
  parallel_for(inverted.size(), kPerTask,
               [&](std::size_t e) { inverted[e] = gradient_of(elements[e], rest.tets[e], x).determinant() <= 0.0; });
  std::vector<char> tangled;
  const auto mark = [&](int node) {
    tangled.resize(rest.vertices.size(), 0);
    tangled[node] = 1;
  };
  for (std::size_t i = 0; i < wound.size(); ++i)
    if (wound[i])
      for (const int node : winding_.edge(static_cast<int>(i))) mark(node);
  for (std::size_t e = 0; e < inverted.size(); ++e)
    if (inverted[e])
      for (const int node : rest.tets[e]) mark(node);
  return tangled;
}

int Unwinding::find(const TetMesh& rest, const std::vector<TetRest>& elements, const std::vector<char>& may,
                    const VecX& x, int parts) {
  patch_.clear();
  const std::vector<char> tangled = tangled_nodes(rest, elements, x);
  if (tangled.empty()) return 0;
  std::vector<char> let_go(elements.size());
  DisjointSets together(rest.vertices.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const Tet& tet = rest.tets[e];
    if (may[e] && std::any_of(tet.begin(), tet.end(), [&](int node) { return tangled[node] != 0; }))
      std::fill_n(let_go.begin() + static_cast<std::ptrdiff_t>(e - e % parts), parts, 1);
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!let_go[e]) continue;
    const Tet& tet = rest.tets[e];
    for (int k = 1; k < 4; ++k) together.join(tet[0], tet[k]);
  }

  std::vector<int> number(rest.vertices.size(), -1);
  std::vector<Mat3> mean;
  patch_.assign(elements.size(), -1);
  int count = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!let_go[e]) continue;
    int& patch = number[together.root(rest.tets[e][0])];
    if (patch < 0) {
      patch = static_cast<int>(mean.size());
      mean.push_back(Mat3::Zero());
    }
    patch_[e] = patch;
    mean[patch] += elements[e].volume * gradient_of(elements[e], rest.tets[e], x);
    ++count;
  }
  frame_.clear();
  for (const Mat3& f : mean) frame_.push_back(nearest_rotation(f));
  if (count == 0) patch_.clear();
  return count;
}

double Unwinding::energy(const TetRest& rest, const Corners& x, std::size_t element, double mu) const {
  return rest.volume * mu * (deformation_gradient(rest, x) - frame_[patch_[element]]).squaredNorm();
}

void Unwinding::force(const TetRest& rest, const Corners& x, std::size_t element, double mu,
                      ElementResponse& out) const {
  const Mat3 difference = deformation_gradient(rest, x) - frame_[patch_[element]];
  out.energy = rest.volume * mu * difference.squaredNorm();
  out.force.noalias() = -2.0 * mu * rest.volume * (difference * rest.gradient);
}

void Unwinding::response(const TetRest& rest, const Corners& x, std::size_t element, double mu,
                         ElementResponse& out) const {
  force(rest, x, element, mu, out);
  for (int block = 0; block < 10; ++block) {
    const double product = rest.gradient.col(kBlockRow[block]).dot(rest.gradient.col(kBlockColumn[block]));
    out.stiffness[block] = 2.0 * mu * rest.volume * product * Mat3::Identity();
  }
}

}  // namespace impinge
