#include "engine/geometry/tets/embedding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/parallel.hpp"
#include "engine/geometry/aabb.hpp"

namespace impinge {
namespace {

// rounding of weights for a point on a face; such points belong to either side
constexpr double kSlack = 1e-12;

Aabb bounds_of_tet(const TetMesh& mesh, const Tet& tet) {
  Aabb box;
  for (const int v : tet) box.include(mesh.vertices[v]);
  return box;
}

Vec4 weights_in(const TetMesh& mesh, int t, const Vec3& p) {
  const Tet& tet = mesh.tets[t];
  return barycentric(p, mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]], mesh.vertices[tet[3]]);
}

/// Cells that hold the tetrahedra whose boxes reach into them, ascending.
class Grid {
 public:
  explicit Grid(const TetMesh& mesh) {
    for (const Vec3& v : mesh.vertices) box_.include(v);
    // about one tetrahedron a cell
    const Vec3 extent = box_.extent().cwiseMax(1e-300);
    const double cell = std::cbrt(extent.prod() / static_cast<double>(std::max<std::size_t>(mesh.tets.size(), 1)));
    for (int a = 0; a < 3; ++a) size_[a] = std::clamp(static_cast<int>(extent[a] / std::max(cell, 1e-300)), 1, 512);
    scale_ = Vec3(size_[0], size_[1], size_[2]).cwiseQuotient(extent);
    begin_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2] + 1, 0);
    for (const bool count : {true, false}) {
      for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
        const Aabb box = bounds_of_tet(mesh, mesh.tets[t]);
        const auto low = cell_of(box.min), high = cell_of(box.max);
        for (int k = low[2]; k <= high[2]; ++k)
          for (int j = low[1]; j <= high[1]; ++j)
            for (int i = low[0]; i <= high[0]; ++i) {
              const std::size_t c = (static_cast<std::size_t>(k) * size_[1] + j) * size_[0] + i;
              if (count)
                ++begin_[c + 1];
              else
                member_[cursor_[c]++] = static_cast<int>(t);
            }
      }
      if (!count) break;
      for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
      member_.resize(begin_.back());
      cursor_.assign(begin_.begin(), begin_.end() - 1);
    }
  }

  std::array<int, 3> cell_of(const Vec3& p) const {
    std::array<int, 3> c;
    for (int a = 0; a < 3; ++a) c[a] = std::clamp(static_cast<int>((p[a] - box_.min[a]) * scale_[a]), 0, size_[a] - 1);
    return c;
  }
  std::span<const int> at(const std::array<int, 3>& cell) const {
    const std::size_t c = (static_cast<std::size_t>(cell[2]) * size_[1] + cell[1]) * size_[0] + cell[0];
    return {member_.data() + begin_[c], static_cast<std::size_t>(begin_[c + 1] - begin_[c])};
  }
  int largest() const { return std::max({size_[0], size_[1], size_[2]}); }
  bool inside(const std::array<int, 3>& cell) const {
    for (int a = 0; a < 3; ++a)
      if (cell[a] < 0 || cell[a] >= size_[a]) return false;
    return true;
  }

 private:
  Aabb box_;
  Vec3 scale_;
  std::array<int, 3> size_{};
  std::vector<int> begin_, cursor_, member_;
};

struct Best {
  int tet = -1;
  Vec4 weight = Vec4::Zero();
  double smallest = -std::numeric_limits<double>::infinity();

  void consider(const TetMesh& mesh, int t, const Vec3& p) {
    const Vec4 w = weights_in(mesh, t, p);
    const double least = w.minCoeff();
    // the first of equals in index order: the answer must not depend on how the grid is walked
    if (least > smallest || (least == smallest && t < tet)) *this = {t, w, least};
  }
};

}  // namespace

Vec4 barycentric(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double volume = tet_volume(a, b, c, d);
  const double wb = tet_volume(a, p, c, d) / volume, wc = tet_volume(a, b, p, d) / volume,
               wd = tet_volume(a, b, c, p) / volume;
  return {1.0 - wb - wc - wd, wb, wc, wd};
}

Embedding embed(const TetMesh& mesh, std::span<const Vec3> points) {
  Embedding result;
  result.tet.resize(points.size());
  result.weight.resize(points.size());
  std::vector<double> smallest(points.size());
  const Grid grid(mesh);
  parallel_for(points.size(), 256, [&](std::size_t i) {
    const Vec3& p = points[i];
    const auto home = grid.cell_of(p);
    Best best;
    for (const int t : grid.at(home)) best.consider(mesh, t, p);
    // outside: shells of cells round it, until one has tetrahedra, and one more
    int last = best.smallest >= -kSlack ? 0 : grid.largest();
    for (int shell = 1; shell <= last; ++shell) {
      for (int dk = -shell; dk <= shell; ++dk)
        for (int dj = -shell; dj <= shell; ++dj)
          for (int di = -shell; di <= shell; ++di) {
            if (std::max({std::abs(di), std::abs(dj), std::abs(dk)}) != shell) continue;
            const std::array<int, 3> cell = {home[0] + di, home[1] + dj, home[2] + dk};
            if (!grid.inside(cell)) continue;
            for (const int t : grid.at(cell)) best.consider(mesh, t, p);
          }
      if (best.tet >= 0) last = std::min(last, shell + 1);
    }
    result.tet[i] = best.tet;
    result.weight[i] = best.weight;
    smallest[i] = best.smallest;
  });
  for (const double s : smallest) {
    result.outside += s < -kSlack;
    result.farthest = std::max(result.farthest, -s);
  }
  return result;
}

void interpolate(const Embedding& embedding, const TetMesh& mesh, const VecX& x, std::vector<Vec3>& points) {
  points.resize(embedding.tet.size());
  parallel_for(points.size(), 2048, [&](std::size_t i) {
    const Tet& tet = mesh.tets[embedding.tet[i]];
    const Vec4& w = embedding.weight[i];
    points[i] = w[0] * x.segment<3>(3 * tet[0]) + w[1] * x.segment<3>(3 * tet[1]) + w[2] * x.segment<3>(3 * tet[2]) +
                w[3] * x.segment<3>(3 * tet[3]);
  });
}

}  // namespace impinge
