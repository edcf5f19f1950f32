#include "engine/geometry/ray_columns.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/aabb.hpp"

namespace impinge {
namespace {

struct Crossing {
  std::size_t ray;
  double at;
  int step;  // +1 where the ray enters, −1 where it leaves
};

}  // namespace

std::pair<int, int> RayColumns::range(int k, double low, double high) const {
  return {static_cast<int>(std::ceil((low - start_[k]) / spacing_)),
          static_cast<int>(std::floor((high - start_[k]) / spacing_)) + 1};
}

RayColumns::RayColumns(const TriangleMesh& surface, int axis, double spacing) : axis_(axis), spacing_(spacing) {
  Aabb box;
  for (const Vec3& p : surface.vertices) box.include(p);
  // an offset that no lattice and no symmetric model has: a ray through a vertex or along an edge would be decided by
  // rounding
  static constexpr std::array<double, 2> kOffset = {0.4142135623730951, 0.7320508075688772};
  for (int k = 0; k < 2; ++k) {
    const int a = (axis + 1 + k) % 3;
    start_[k] = box.min[a] + (kOffset[k] - 1.0) * spacing;
    count_[k] = static_cast<int>(std::ceil((box.max[a] - start_[k]) / spacing)) + 1;
  }

  const int ua = u_axis(), va = v_axis();
  std::vector<Crossing> crossings;
  for (const Triangle& t : surface.triangles) {
    check_interrupt();
    const Vec3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
    const auto [i0, i1] = range(0, std::min({a[ua], b[ua], c[ua]}), std::max({a[ua], b[ua], c[ua]}));
    if (i0 >= i1) continue;
    const auto [j0, j1] = range(1, std::min({a[va], b[va], c[va]}), std::max({a[va], b[va], c[va]}));
    if (j0 >= j1) continue;
    const Vec3 normal = (b - a).cross(c - a);
    for (int j = j0; j < j1; ++j)
      for (int i = i0; i < i1; ++i) {
        const double pu = u(i), pv = v(j);
        if (!exists(i, j)) continue;
        // which side of each edge the ray passes; computed from the lower to the higher vertex index, so that the two
        // triangles of an edge get the same number and exactly one of them is hit
        int left = 0;
        for (int e = 0; e < 3; ++e) {
          int from = t[e], to = t[(e + 1) % 3];
          const bool reversed = from > to;
          if (reversed) std::swap(from, to);
          const Vec3 &p = surface.vertices[from], &q = surface.vertices[to];
          const double side = (q[ua] - p[ua]) * (pv - p[va]) - (q[va] - p[va]) * (pu - p[ua]);
          left += (side >= 0.0) != reversed;
        }
        if (left != 0 && left != 3) continue;
        if (normal[axis] == 0.0) continue;
        const double at = a[axis] - (normal[ua] * (pu - a[ua]) + normal[va] * (pv - a[va])) / normal[axis];
        const double low = std::min({a[axis], b[axis], c[axis]}), high = std::max({a[axis], b[axis], c[axis]});
        // outward normals: counter-clockwise seen from above is where a ray upwards leaves
        crossings.push_back({index(i, j), std::clamp(at, low, high), left == 3 ? -1 : 1});
      }
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& x, const Crossing& y) {
    return std::tie(x.ray, x.at, y.step) < std::tie(y.ray, y.at, x.step);
  });

  const std::size_t rays = static_cast<std::size_t>(count_[0]) * count_[1];
  begin_.assign(rays + 1, 0);
  is_dropped_.assign(rays, 0);
  std::size_t next = 0;
  for (std::size_t ray = 0; ray < rays; ++ray) {
    begin_[ray] = intervals_.size();
    int winding = 0;
    double entered = 0.0;
    for (; next < crossings.size() && crossings[next].ray == ray; ++next) {
      const int before = winding;
      winding += crossings[next].step;
      if (before <= 0 && winding > 0) entered = crossings[next].at;
      if (before > 0 && winding <= 0) intervals_.push_back({entered, crossings[next].at});
    }
    if (winding != 0) {
      intervals_.resize(begin_[ray]);
      is_dropped_[ray] = 1;
      ++dropped_;
    }
  }
  begin_[rays] = intervals_.size();
}

}  // namespace impinge
