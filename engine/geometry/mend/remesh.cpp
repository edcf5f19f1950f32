#include "engine/geometry/mend/remesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "engine/core/interrupt.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/geometry/mend/clean_triangles.hpp"
#include "engine/geometry/mend/winding_tree.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {
namespace {

constexpr int kHalvings = 9;          // of a lattice edge, until its vertex is where the skin passes
constexpr double kLeastShare = 0.02;  // of a lattice edge, at either end: no two vertices of the skin at one node

// the six tetrahedra of a cube round its diagonal from corner 0 to corner 7; corner i stands at (i & 1, i >> 1 & 1,
// i >> 2); alike in all cubes, so that faces fit
constexpr std::array<std::array<int, 4>, 6> kTets = {
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

struct Grid {
  Vec3 origin;
  double cell;
  std::array<int, 3> nodes;

  Grid(const Aabb& box, int cells) : cell(box.extent().maxCoeff() / cells) {
    for (int a = 0; a < 3; ++a) {
      const int inner = std::max(1, static_cast<int>(std::ceil(box.extent()[a] / cell - 1e-9)));
      nodes[a] = inner + 4;
      // not symmetric about the box: faces of a box along the axes would pass through nodes
      origin[a] = box.center()[a] - (0.5 * inner + 1.4142135623730951) * cell;
    }
  }
  std::size_t count() const { return static_cast<std::size_t>(nodes[0]) * nodes[1] * nodes[2]; }
  std::size_t node(int i, int j, int k) const { return (static_cast<std::size_t>(k) * nodes[1] + j) * nodes[0] + i; }
  Vec3 at(std::size_t n) const {
    const std::size_t row = n / nodes[0];
    return origin + cell * Vec3(static_cast<double>(n % nodes[0]), static_cast<double>(row % nodes[1]),
                                static_cast<double>(row / nodes[1]));
  }
};

using Inside = std::function<bool(const Vec3&)>;

class Skin {
 public:
  Skin(const Grid& grid, const Inside& is_inside) : grid_(grid), is_inside_(is_inside), inside_(grid.count(), 0) {
    parallel_for(inside_.size(), 1024, [&](std::size_t n) { inside_[n] = is_inside_(grid_.at(n)) ? 1 : 0; });
  }

  TriangleMesh make() {
    for (int k = 0; k + 1 < grid_.nodes[2]; ++k)
      for (int j = 0; j + 1 < grid_.nodes[1]; ++j) {
        check_interrupt();
        for (int i = 0; i + 1 < grid_.nodes[0]; ++i) cube(i, j, k);
      }
    place_vertices();
    return std::move(skin_);
  }

 private:
  void cube(int i, int j, int k) {
    std::array<std::size_t, 8> corner;
    int within = 0;
    for (int c = 0; c < 8; ++c) {
      corner[c] = grid_.node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
      within += inside_[corner[c]];
    }
    if (within == 0 || within == 8) return;
    for (const auto& tet : kTets) march({corner[tet[0]], corner[tet[1]], corner[tet[2]], corner[tet[3]]});
  }

  void march(const std::array<std::size_t, 4>& tet) {
    std::array<std::size_t, 4> in, out;
    int ins = 0, outs = 0;
    bool is_even = true;  // how in, then out, in their order are a permutation of the corners
    for (int c = 0; c < 4; ++c) {
      if (inside_[tet[c]] != 0) {
        is_even ^= (outs & 1) != 0;
        in[ins++] = tet[c];
      } else {
        out[outs++] = tet[c];
      }
    }
    if (ins == 0 || outs == 0) return;
    if (ins == 1) {
      triangle(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), is_even);
    } else if (outs == 1) {
      triangle(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), is_even);
    } else {
      const int a = crossing(in[0], out[0]), b = crossing(in[0], out[1]), c = crossing(in[1], out[1]),
                d = crossing(in[1], out[0]);
      triangle(a, b, c, is_even);
      triangle(a, c, d, is_even);
    }
  }

  void triangle(int a, int b, int c, bool is_even) {
    if (is_even)
      skin_.triangles.push_back({a, b, c});
    else
      skin_.triangles.push_back({a, c, b});
  }

  /// The vertex on a lattice edge, numbered as they are met.
  int crossing(std::size_t in, std::size_t out) {
    const std::size_t low = std::min(in, out), high = std::max(in, out);
    const auto [place, is_new] = index_.try_emplace(low * 32 + offset(low, high), static_cast<int>(ends_.size()));
    if (is_new) ends_.emplace_back(in, out);
    return place->second;
  }

  /// Which of the seven ways from a node to a later one of its cube.
  std::size_t offset(std::size_t low, std::size_t high) const {
    const std::size_t d = high - low, row = grid_.nodes[0], layer = row * grid_.nodes[1];
    return (d >= layer ? 4 : 0) + (d % layer >= row ? 2 : 0) + (d % layer % row != 0 ? 1 : 0);
  }

  /// By halving, from within: the nearest part of a surface may be one that lies within another.
  void place_vertices() {
    skin_.vertices.resize(ends_.size());
    parallel_for(ends_.size(), 256, [&](std::size_t i) {
      const Vec3 in = grid_.at(ends_[i].first), out = grid_.at(ends_[i].second);
      double low = 0.0, high = 1.0;
      for (int halving = 0; halving < kHalvings; ++halving) {
        const double middle = 0.5 * (low + high);
        (is_inside_(in + middle * (out - in)) ? low : high) = middle;
      }
      skin_.vertices[i] = in + std::clamp(low, kLeastShare, 1.0 - kLeastShare) * (out - in);
    });
  }

  const Grid& grid_;
  const Inside& is_inside_;
  std::vector<char> inside_;  // by node
  TriangleMesh skin_;
  std::unordered_map<std::size_t, int> index_;  // only looked up
  std::vector<std::pair<std::size_t, std::size_t>> ends_;
};

}  // namespace

TriangleMesh remesh(const TriangleMesh& solid, const TriangleMesh& walls, int cells, double* largest_move) {
  TriangleMesh surface = solid;
  append(surface, walls);
  const Aabb box = bounds_of(surface);
  if (!(box.extent().maxCoeff() > 0.0)) return {};
  const Grid grid(box, cells);
  const WindingTree of_solid(solid.triangles, solid.vertices), of_walls(walls.triangles, walls.vertices);
  const Inside is_inside = [&](const Vec3& x) {
    return of_solid.is_inside(x) || (!walls.triangles.empty() && of_walls.winds_round(x));
  };
  TriangleMesh skin = Skin(grid, is_inside).make();
  if (largest_move != nullptr) {
    const BoxTree tree(triangle_boxes(surface.triangles, surface.vertices));
    std::vector<double> sq(skin.vertices.size(), 0.0);
    parallel_for(sq.size(), 256, [&](std::size_t i) {
      sq[i] = nearest_triangle(tree, surface.triangles, surface.vertices, skin.vertices[i]).at.squared_distance;
    });
    for (const double d : sq) *largest_move = std::max(*largest_move, std::sqrt(d));
  }
  return skin;
}

double remesh_memory(const TriangleMesh& surface, int cells) {
  const Grid grid(bounds_of(surface), cells);
  const double n = cells;
  // nodes, trees over the surface, and a skin of some 12 triangles a square of each of the box's sides
  return static_cast<double>(grid.count()) + 300.0 * static_cast<double>(surface.triangles.size()) +
         6.0 * 24.0 * n * n * 120.0;
}

}  // namespace impinge
