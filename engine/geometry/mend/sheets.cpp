#include "engine/geometry/mend/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/interrupt.hpp"
#include "engine/geometry/disjoint_sets.hpp"

namespace impinge {
namespace {

constexpr int kMostPasses = 8;

/// Side k of triangle t, from its corner k to the next, is number 3 t + k.
struct Side {
  int v0, v1;  // v0 < v1
  int number;
};

std::vector<Side> sorted_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), 3 * t + k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
    return std::tie(l.v0, l.v1, l.number) < std::tie(r.v0, r.v1, r.number);
  });
  return sides;
}

/// Calls group(first, last) for the sides of each edge.
template <class Group>
void for_each_edge(const std::vector<Side>& sides, Group&& group) {
  for (std::size_t i = 0, end; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].v0 == sides[i].v0 && sides[end].v1 == sides[i].v1;) ++end;
    group(i, end);
  }
}

double area_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

class SheetMaker {
 public:
  explicit SheetMaker(TriangleMesh& mesh) : mesh_(mesh), sides_(sorted_sides(mesh)) {
    partner_.assign(3 * mesh.triangles.size(), -1);
    for_each_edge(sides_, [&](std::size_t i, std::size_t end) {
      if (end - i != 2) return;
      partner_[sides_[i].number] = sides_[i + 1].number;
      partner_[sides_[i + 1].number] = sides_[i].number;
    });
  }

  int orient() {
    const std::size_t count = mesh_.triangles.size();
    std::vector<signed char> turn(count, -1);  // -1: not reached yet
    std::vector<int> part;
    int turned = 0;
    for (std::size_t first = 0; first < count; ++first) {
      if (turn[first] >= 0) continue;
      check_interrupt();
      turn[first] = 0;
      part.assign(1, static_cast<int>(first));
      for (std::size_t i = 0; i < part.size(); ++i)
        for (int k = 0; k < 3; ++k) {
          const int side = 3 * part[i] + k, other = partner_[side];
          if (other < 0) continue;
          const bool alike = runs_up(side) != runs_up(other);
          const auto wanted = static_cast<signed char>(alike ? turn[part[i]] : 1 - turn[part[i]]);
          signed char& its = turn[other / 3];
          if (its < 0) its = wanted, part.push_back(other / 3);
          if (its != wanted) partner_[side] = partner_[other] = -1;  // a Möbius strip's
        }
      double kept = 0.0, changed = 0.0;
      for (const int t : part) (turn[t] != 0 ? changed : kept) += area_of(mesh_, mesh_.triangles[t]);
      if (changed > kept)
        for (const int t : part) turn[t] = static_cast<signed char>(1 - turn[t]);
      for (const int t : part) turned += turn[t];
    }
    if (turned > 0) apply(turn);
    return turned;
  }

  /// Joins what meets in edges with more than two triangles. How many those are, and those that orient() cut.
  int pair_up() {
    int cut = 0;
    for_each_edge(sides_, [&](std::size_t i, std::size_t end) {
      if (end - i == 2 && partner_[sides_[i].number] < 0) ++cut;
      if (end - i > 2) ++cut, pair_round(i, end);
    });
    return cut;
  }

  /// One vertex for each fan. How many are more than before.
  int split(int& unused) {
    const int corner_count = static_cast<int>(partner_.size());
    DisjointSets corners(partner_.size());
    for (int side = 0; side < corner_count; ++side)
      if (const int other = partner_[side]; other > side) {
        const bool alike = vertex(side) == vertex(other);  // both run the same way
        corners.join(side, alike ? other : next(other));
        corners.join(next(side), alike ? next(other) : other);
      }
    std::vector<int> order(partner_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int l, int r) { return vertex(l) < vertex(r); });
    std::vector<int> index(partner_.size(), -1);  // by root
    std::vector<Vec3> vertices;
    int used = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (i == 0 || vertex(order[i]) != vertex(order[i - 1])) ++used;
      int& mine = index[corners.root(order[i])];
      if (mine >= 0) continue;
      mine = static_cast<int>(vertices.size());
      vertices.push_back(mesh_.vertices[vertex(order[i])]);
    }
    unused += static_cast<int>(mesh_.vertices.size()) - used;
    std::vector<Triangle> triangles(mesh_.triangles.size());
    for (int c = 0; c < corner_count; ++c) triangles[c / 3][c % 3] = index[corners.root(c)];
    mesh_.vertices = std::move(vertices);
    mesh_.triangles = std::move(triangles);
    return static_cast<int>(mesh_.vertices.size()) - used;
  }

  /// Edges that still have the same two vertices as another one get a vertex of their own in the middle. How many.
  int separate() {
    const std::vector<Side> sides = sorted_sides(mesh_);
    std::vector<char> touched(mesh_.triangles.size(), 0);
    std::vector<std::pair<int, int>> middles;  // side and vertex
    int added = 0;
    for_each_edge(sides, [&](std::size_t i, std::size_t end) {
      int kept = -1;  // the edge that stays as it is
      for (std::size_t k = i; k < end && end - i > 1; ++k) {
        const int side = sides[k].number, other = partner_[side];
        if (other >= 0 && other < side) continue;
        if (kept < 0) {
          kept = side;
          continue;
        }
        if (touched[side / 3] != 0 || (other >= 0 && touched[other / 3] != 0)) continue;  // the next pass
        touched[side / 3] = 1;
        middles.emplace_back(side, static_cast<int>(mesh_.vertices.size()));
        if (other >= 0) touched[other / 3] = 1, middles.emplace_back(other, static_cast<int>(mesh_.vertices.size()));
        mesh_.vertices.push_back(0.5 * (mesh_.vertices[sides[k].v0] + mesh_.vertices[sides[k].v1]));
        ++added;
      }
    });
    for (const auto& [side, middle] : middles) {
      Triangle& t = mesh_.triangles[side / 3];
      const int k = side % 3, b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      t[(k + 1) % 3] = middle;
      mesh_.triangles.push_back({middle, b, c});
    }
    return added;
  }

 private:
  static int next(int side) { return side % 3 == 2 ? side - 2 : side + 1; }
  int vertex(int corner) const { return mesh_.triangles[corner / 3][corner % 3]; }
  bool runs_up(int side) const { return vertex(side) < vertex(next(side)); }

  void apply(const std::vector<signed char>& turn) {
    // sides 0, 1, 2 of a triangle whose corners 1 and 2 change places are 2, 1, 0
    const auto moved = [&](int side) { return turn[side / 3] != 0 ? 3 * (side / 3) + 2 - side % 3 : side; };
    std::vector<int> partner(partner_.size(), -1);
    for (int side = 0; side < static_cast<int>(partner_.size()); ++side)
      if (partner_[side] >= 0) partner[moved(side)] = moved(partner_[side]);
    partner_ = std::move(partner);
    for (Side& side : sides_) side.number = moved(side.number);
    for (std::size_t t = 0; t < turn.size(); ++t)
      if (turn[t] != 0) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
  }

  /// By the angle about the edge, a triangle that runs up it has its solid at smaller angles, one that runs down at
  /// larger ones. So each down is joined with the next up, like brackets.
  void pair_round(std::size_t i, std::size_t end) {
    struct Spoke {
      double angle;
      int side;
      bool up;
    };
    const Vec3 &a = mesh_.vertices[sides_[i].v0], axis = mesh_.vertices[sides_[i].v1] - a;
    int least = 0;
    axis.cwiseAbs().minCoeff(&least);
    const Vec3 e1 = Vec3::Unit(least).cross(axis), e2 = axis.cross(e1) / std::max(axis.norm(), 1e-300);
    std::vector<Spoke> spokes;
    for (; i < end; ++i) {
      const int side = sides_[i].number;
      const Vec3 to = mesh_.vertices[vertex(next(next(side)))] - a;
      spokes.push_back({std::atan2(to.dot(e2), to.dot(e1)), side, runs_up(side)});
    }
    std::sort(spokes.begin(), spokes.end(),
              [](const Spoke& l, const Spoke& r) { return std::tie(l.angle, l.side) < std::tie(r.angle, r.side); });
    std::vector<int> open;
    for (int round = 0; round < 2; ++round)  // twice: brackets may close beyond where the count began
      for (const Spoke& spoke : spokes) {
        if (partner_[spoke.side] >= 0) continue;
        if (!spoke.up) {
          if (round == 0) open.push_back(spoke.side);
        } else if (!open.empty()) {
          partner_[spoke.side] = open.back();
          partner_[open.back()] = spoke.side;
          open.pop_back();
        }
      }
  }

  TriangleMesh& mesh_;
  std::vector<Side> sides_;
  std::vector<int> partner_;  // by side: the one it is joined with, −1 for a border
};

}  // namespace

SheetCounts make_sheets(TriangleMesh& mesh, bool orient) {
  SheetCounts counts;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    check_interrupt();
    SheetMaker maker(mesh);
    if (orient && pass == 0) counts.turned = maker.orient();
    const int cut = maker.pair_up();
    if (pass == 0) counts.cut_edges = cut;
    counts.added_vertices += maker.split(counts.unused);
    const int middles = maker.separate();
    counts.added_vertices += middles;
    if (middles == 0) break;
  }
  return counts;
}

std::vector<int> label_parts(const TriangleMesh& mesh, const MeshTopology& topology, int& count) {
  DisjointSets parts(mesh.triangles.size());
  std::vector<int> first(topology.edges.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int e : topology.triangle_edges[t]) {
      if (first[e] < 0) first[e] = static_cast<int>(t);
      parts.join(first[e], static_cast<int>(t));
    }
  std::vector<int> label(mesh.triangles.size(), -1);
  count = 0;
  for (int t = 0; t < static_cast<int>(label.size()); ++t) {
    const int root = parts.root(t);
    if (root == t) label[t] = count++;
    label[t] = label[root];
  }
  return label;
}

}  // namespace impinge
