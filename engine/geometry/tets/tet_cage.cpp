#include "engine/geometry/tets/tet_cage.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/geometry/ray_columns.hpp"

namespace impinge {
namespace {

using Cell = std::array<int, 3>;

/// The lattice: cubic cells with a node at each corner and centre. Between two neighbouring cells, four tetrahedra
/// share the edge that joins their centres; each takes one edge of the common face. Cells are counted with one layer
/// round the surface.
class Lattice {
 public:
  Lattice(const Aabb& box, int cells) : cell_(box.extent().maxCoeff() / cells) {
    for (int a = 0; a < 3; ++a) {
      // slack keeps vertices on the bounds inside the first and last cell
      inner_[a] = std::max(1, static_cast<int>(std::ceil(box.extent()[a] / cell_ - 1e-9)));
      origin_[a] = box.center()[a] - 0.5 * inner_[a] * cell_ - cell_;
      size_[a] = inner_[a] + 2;
    }
  }

  double cell() const { return cell_; }
  const Cell& size() const { return size_; }
  std::size_t cell_count() const { return static_cast<std::size_t>(size_[0]) * size_[1] * size_[2]; }
  std::size_t tet_count() const { return 12 * cell_count(); }
  std::size_t cell_index(const Cell& c) const {
    return (static_cast<std::size_t>(c[2]) * size_[1] + c[1]) * size_[0] + c[0];
  }
  Cell cell_at(std::size_t index) const {
    const std::size_t row = index / size_[0];
    return {static_cast<int>(index % size_[0]), static_cast<int>(row % size_[1]), static_cast<int>(row / size_[1])};
  }
  /// Tetrahedron q of the face between a cell and its next neighbour along an axis.
  std::size_t tet_id(const Cell& c, int axis, int q) const { return (cell_index(c) * 3 + axis) * 4 + q; }
  bool exists(std::size_t id) const { return cell_at(id / 12)[id / 4 % 3] + 1 < size_[id / 4 % 3]; }

  // nodes: corners first, then centres
  std::size_t node_count() const { return corner_count() + cell_count(); }
  std::array<std::size_t, 4> nodes(std::size_t id) const {
    const Cell c = cell_at(id / 12);
    const int axis = static_cast<int>(id / 4 % 3), q = static_cast<int>(id % 4);
    Cell next = c;
    ++next[axis];
    return {corner_count() + cell_index(c), corner_count() + cell_index(next), corner(c, axis, q),
            corner(c, axis, (q + 1) % 4)};
  }
  Vec3 position(std::size_t node) const {
    if (node >= corner_count()) {
      const Cell c = cell_at(node - corner_count());
      return origin_ + cell_ * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
    }
    const std::size_t nx = size_[0] + 1, ny = size_[1] + 1, row = node / nx, layer = row / ny;
    return origin_ +
           cell_ * Vec3(static_cast<double>(node % nx), static_cast<double>(row % ny), static_cast<double>(layer));
  }
  std::array<Vec3, 4> corners(std::size_t id) const {
    const auto n = nodes(id);
    return {position(n[0]), position(n[1]), position(n[2]), position(n[3])};
  }

  Cell cell_of(const Vec3& p) const {
    Cell c;
    for (int a = 0; a < 3; ++a)
      c[a] = std::clamp(static_cast<int>(std::floor((p[a] - origin_[a]) / cell_)), 1, size_[a] - 2);
    return c;
  }
  /// The tetrahedron that holds p: the pyramid of the cell's face that p is nearest to, then the edge of that face.
  std::size_t locate(const Vec3& p) const {
    Cell c = cell_of(p);
    const Vec3 d = (p - origin_) / cell_ - Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
    int axis = 0;
    d.cwiseAbs().maxCoeff(&axis);
    const double b = d[(axis + 1) % 3], e = d[(axis + 2) % 3];
    if (d[axis] < 0.0) --c[axis];
    const int q = std::abs(e) >= std::abs(b) ? (e < 0.0 ? 0 : 2) : (b > 0.0 ? 1 : 3);
    return tet_id(c, axis, q);
  }

 private:
  std::size_t corner_count() const { return static_cast<std::size_t>(size_[0] + 1) * (size_[1] + 1) * (size_[2] + 1); }
  /// Corner q of the face at the far side of c along an axis, counter-clockwise round the axis.
  std::size_t corner(const Cell& c, int axis, int q) const {
    Cell p = c;
    ++p[axis];
    p[(axis + 1) % 3] += q == 1 || q == 2;
    p[(axis + 2) % 3] += q >= 2;
    return (static_cast<std::size_t>(p[2]) * (size_[1] + 1) + p[1]) * (size_[0] + 1) + p[0];
  }

  double cell_;
  Vec3 origin_;
  Cell inner_{}, size_{};
};

/// Whether a plane through the origin with this normal leaves the two sets strictly apart. `slack` in the normal's
/// units.
bool separated(const Vec3& n, const std::array<Vec3, 4>& tet, const std::array<Vec3, 3>& triangle, double slack) {
  double tet_low = n.dot(tet[0]), tet_high = tet_low, low = n.dot(triangle[0]), high = low;
  for (int k = 1; k < 4; ++k) {
    const double d = n.dot(tet[k]);
    tet_low = std::min(tet_low, d);
    tet_high = std::max(tet_high, d);
  }
  for (int k = 1; k < 3; ++k) {
    const double d = n.dot(triangle[k]);
    low = std::min(low, d);
    high = std::max(high, d);
  }
  return low > tet_high + slack * n.norm() || high < tet_low - slack * n.norm();
}

/// Separating axes of a triangle and a tetrahedron. Errs on the side of touching.
bool touch(const std::array<Vec3, 4>& tet, const std::array<Vec3, 3>& triangle, double slack) {
  for (const auto& f : kTetFaces)
    if (separated((tet[f[1]] - tet[f[0]]).cross(tet[f[2]] - tet[f[0]]), tet, triangle, slack)) return false;
  if (separated((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]), tet, triangle, slack)) return false;
  for (const auto& [a, b] : kTetEdges)
    for (int k = 0; k < 3; ++k)
      if (separated((tet[b] - tet[a]).cross(triangle[(k + 1) % 3] - triangle[k]), tet, triangle, slack)) return false;
  return true;
}

/// Marks every tetrahedron that the surface passes through.
std::vector<char> touched_tets(const Lattice& lattice, const TriangleMesh& surface, std::span<const std::size_t> home) {
  std::vector<char> touched(lattice.tet_count(), 0);
  for (const std::size_t id : home) touched[id] = 1;
  const double slack = 1e-12 * lattice.cell();
  for (const Triangle& t : surface.triangles) {
    check_interrupt();
    // tetrahedra are convex: a triangle whose corners share one lies in it
    if (home[t[0]] == home[t[1]] && home[t[0]] == home[t[2]]) continue;
    const std::array<Vec3, 3> triangle = {surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]};
    const Aabb box = bounds_of(triangle[0], triangle[1], triangle[2]);
    const Cell low = lattice.cell_of(box.min), high = lattice.cell_of(box.max);
    for (int k = low[2] - 1; k <= high[2]; ++k)
      for (int j = low[1] - 1; j <= high[1]; ++j)
        for (int i = low[0] - 1; i <= high[0]; ++i)
          for (int axis = 0; axis < 3; ++axis)
            for (int q = 0; q < 4; ++q) {
              const std::size_t id = lattice.tet_id({i, j, k}, axis, q);
              if (touched[id] || !lattice.exists(id)) continue;
              if (touch(lattice.corners(id), triangle, slack)) touched[id] = 1;
            }
  }
  return touched;
}

/// Which part of the tetrahedron is inside the surface, as lengths along the rays that meet it; 0 if none does. One the
/// surface doesn't touch is all inside or all outside, which one good ray tells.
double filled_fraction(const std::array<Vec3, 4>& corner, bool touched, const RayColumns& columns) {
  const int w = columns.axis(), ua = columns.u_axis(), va = columns.v_axis();
  Aabb box;
  for (const Vec3& p : corner) box.include(p);
  // barycentric weights along a ray: base + slope · w >= 0
  const double volume = tet_volume(corner[0], corner[1], corner[2], corner[3]);
  std::array<Vec3, 4> gradient;
  for (int k = 0; k < 4; ++k) {
    const auto& f = kTetFaces[k];
    gradient[k] = -(corner[f[1]] - corner[f[0]]).cross(corner[f[2]] - corner[f[0]]) / (6.0 * volume);
  }
  const auto [i0, i1] = columns.u_range(box.min[ua], box.max[ua]);
  const auto [j0, j1] = columns.v_range(box.min[va], box.max[va]);
  double inside = 0.0, total = 0.0;
  for (int j = j0; j < j1; ++j)
    for (int i = i0; i < i1; ++i) {
      if (columns.is_dropped(i, j)) continue;
      double low = box.min[w], high = box.max[w];
      for (int k = 0; k < 4 && low < high; ++k) {
        const Vec3& g = gradient[k];
        // the opposite face passes through the next corner
        const Vec3& on = corner[(k + 1) % 4];
        const double base = g[ua] * (columns.u(i) - on[ua]) + g[va] * (columns.v(j) - on[va]) - g[w] * on[w];
        if (std::abs(g[w]) < 1e-12 * g.norm()) {
          if (base < 0.0) high = low;
        } else if (g[w] > 0.0) {
          low = std::max(low, -base / g[w]);
        } else {
          high = std::min(high, -base / g[w]);
        }
      }
      if (!(low < high)) continue;
      total += high - low;
      for (const RayColumns::Interval& interval : columns.inside(i, j))
        inside += std::max(0.0, std::min(high, interval.high) - std::max(low, interval.low));
      if (!touched && high - low > 0.1 * (box.max[w] - box.min[w])) return inside > 0.5 * total ? 1.0 : 0.0;
    }
  return total > 0.0 ? std::clamp(inside / total, 0.0, 1.0) : 0.0;
}

/// The same by points, evenly spread.
double sampled_fraction(const std::array<Vec3, 4>& corner, bool touched,
                        const std::function<bool(const Vec3&)>& is_inside) {
  if (!touched) return is_inside(0.25 * (corner[0] + corner[1] + corner[2] + corner[3])) ? 1.0 : 0.0;
  constexpr int kSteps = 5;
  int inside = 0, all = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      for (int k = 0; i + j + k <= kSteps; ++k, ++all) {
        // moved off the faces, to the middles of as many equal pieces
        const double n = kSteps + 1.0, a = (i + 0.25) / n, b = (j + 0.25) / n, c = (k + 0.25) / n;
        inside += is_inside(corner[0] + a * (corner[1] - corner[0]) + b * (corner[2] - corner[0]) +
                            c * (corner[3] - corner[0]))
                      ? 1
                      : 0;
      }
  return static_cast<double>(inside) / all;
}

/// Of each tetrahedron, by rays along the shortest side: more rays than along the others, but thin parts are thin along
/// them, where they are exact.
std::vector<double> fractions_by_rays(const TriangleMesh& surface, const Aabb& box, const Lattice& lattice,
                                      const std::vector<char>& touched, const TetCageSettings& settings, int& dropped) {
  int axis = 0;
  box.extent().minCoeff(&axis);
  const double faces = static_cast<double>(lattice.size()[(axis + 1) % 3]) * lattice.size()[(axis + 2) % 3];
  constexpr double kMostRays = 4e6;
  const int rays = std::clamp(static_cast<int>(std::sqrt(kMostRays / faces)), 4, settings.rays_per_cell);
  const RayColumns columns(surface, axis, lattice.cell() / rays);
  std::vector<double> fraction(lattice.tet_count(), 0.0);
  parallel_for(lattice.tet_count(), 256, [&](std::size_t id) {
    if (lattice.exists(id)) fraction[id] = filled_fraction(lattice.corners(id), touched[id] != 0, columns);
  });
  dropped = columns.dropped_rays();
  return fraction;
}

std::vector<double> fractions_by_points(const Lattice& lattice, const std::vector<char>& touched,
                                        const std::function<bool(const Vec3&)>& is_inside) {
  std::vector<double> fraction(lattice.tet_count(), 0.0);
  parallel_for(lattice.tet_count(), 16, [&](std::size_t id) {
    if (lattice.exists(id)) fraction[id] = sampled_fraction(lattice.corners(id), touched[id] != 0, is_inside);
  });
  return fraction;
}

}  // namespace

TetCage make_tet_cage(const TriangleMesh& surface, const TetCageSettings& settings) {
  IMPINGE_ASSERT(settings.cells >= 1 && settings.rays_per_cell >= 1 && !surface.triangles.empty());
  Aabb box;
  for (const Vec3& p : surface.vertices) box.include(p);
  const Lattice lattice(box, settings.cells);

  std::vector<std::size_t> home(surface.vertices.size());
  parallel_for(home.size(), 4096, [&](std::size_t i) { home[i] = lattice.locate(surface.vertices[i]); });
  const std::vector<char> touched = touched_tets(lattice, surface, home);

  TetCage cage;
  const std::vector<double> fraction =
      settings.is_inside ? fractions_by_points(lattice, touched, settings.is_inside)
                         : fractions_by_rays(surface, box, lattice, touched, settings, cage.dropped_rays);

  cage.cell_size = lattice.cell();
  std::vector<int> node_index(lattice.node_count(), -1), tet_index(lattice.tet_count(), -1);
  InterruptPoll poll;
  for (std::size_t id = 0; id < lattice.tet_count(); ++id) {
    poll();
    if (!lattice.exists(id) || (!touched[id] && !(fraction[id] > 0.0))) continue;
    tet_index[id] = static_cast<int>(cage.mesh.tets.size());
    Tet tet;
    const auto nodes = lattice.nodes(id);
    for (int k = 0; k < 4; ++k) {
      int& index = node_index[nodes[k]];
      if (index < 0) {
        index = static_cast<int>(cage.mesh.vertices.size());
        cage.mesh.vertices.push_back(lattice.position(nodes[k]));
      }
      tet[k] = index;
    }
    cage.mesh.tets.push_back(tet);
    cage.fraction.push_back(std::max(fraction[id], settings.smallest_fraction));
    cage.filled_volume += fraction[id] * tet_volume(cage.mesh, tet);
  }

  cage.embedding.tet.resize(surface.vertices.size());
  cage.embedding.weight.resize(surface.vertices.size());
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    cage.embedding.tet[i] = tet_index[home[i]];
    const auto c = lattice.corners(home[i]);
    cage.embedding.weight[i] = barycentric(surface.vertices[i], c[0], c[1], c[2], c[3]);
    const double least = cage.embedding.weight[i].minCoeff();
    cage.embedding.outside += least < -1e-12;
    cage.embedding.farthest = std::max(cage.embedding.farthest, -least);
  }
  return cage;
}

}  // namespace impinge
