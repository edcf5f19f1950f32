#include "engine/elements/quadratic_elements.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/elements/discrete_gradient.hpp"

namespace impinge {
namespace {

using Nodes = Eigen::Matrix<double, 3, 10>;

/// Corners of the linear tetrahedron that has the gradient which ten nodes have at one point: y = x B.
using PointMap = Eigen::Matrix<double, 10, 4>;

/// Shape functions w_a (2 w_a − 1) of corners, 4 w_a w_b of midpoints; B is their derivative by the weights.
PointMap map_at(const Vec4& w) {
  PointMap b = PointMap::Zero();
  for (int k = 0; k < 4; ++k) b(k, k) = 4.0 * w[k] - 1.0;
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = kTetEdges[e];
    b(4 + e, i) = 4.0 * w[j];
    b(4 + e, j) = 4.0 * w[i];
  }
  return b;
}

struct Point {
  PointMap map;
  double share;  ///< of the volume
  double shear, bulk;
};

/// The four points that integrate a quadratic exactly carry μ, the centre λ.
const std::array<Point, 5>& points() {
  static const std::array<Point, 5> all = [] {
    const double near = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, far = (5.0 - std::sqrt(5.0)) / 20.0;
    std::array<Point, 5> p;
    for (int k = 0; k < 4; ++k) p[k] = {map_at(Vec4::Constant(far) + (near - far) * Vec4::Unit(k)), 0.25, 1.0, 0.0};
    p[4] = {map_at(Vec4::Constant(0.25)), 1.0, 0.0, 1.0};
    return p;
  }();
  return all;
}

TetRest rest_at(const TetRest& element, const Point& p) {
  TetRest rest = element;
  rest.volume *= p.share;
  rest.shear = p.shear, rest.bulk = p.bulk;
  return rest;
}

/// From the first one: gradients are the same, with less rounding.
Nodes nodes_at(const QuadraticTet& nodes, const VecX& x) {
  const Vec3 first = x.segment<3>(3 * nodes[0]);
  Nodes n;
  for (int a = 0; a < 10; ++a) n.col(a) = x.segment<3>(3 * nodes[a]) - first;
  return n;
}

/// The columns of B that node a has, one of a corner, two of a midpoint.
struct NodeColumns {
  std::array<int, 2> column;
  int count;
};
constexpr NodeColumns columns_of(int a) {
  return a < 4 ? NodeColumns{{a, a}, 1} : NodeColumns{{kTetEdges[a - 4][0], kTetEdges[a - 4][1]}, 2};
}

/// Position of block (i, j) of a tetrahedron, i <= j, in the order of kBlockRow and kBlockColumn.
constexpr int block_of(int i, int j) { return 4 * i - i * (i - 1) / 2 + j - i; }

/// K of the ten nodes += B K Bᵀ of the four corners.
void add_stiffness(const PointMap& b, const ElementResponse& point, QuadraticAnswer& out) {
  int block = 0;
  for (int m = 0; m < 10; ++m) {
    const NodeColumns of_m = columns_of(m);
    for (int n = m; n < 10; ++n, ++block) {
      const NodeColumns of_n = columns_of(n);
      Mat3& sum = out.stiffness[block];
      for (int s = 0; s < of_m.count; ++s)
        for (int t = 0; t < of_n.count; ++t) {
          const int i = of_m.column[s], j = of_n.column[t];
          const double weight = b(m, i) * b(n, j);
          if (i <= j)
            sum += weight * point.stiffness[block_of(i, j)];
          else
            sum += weight * point.stiffness[block_of(j, i)].transpose();
        }
    }
  }
}

/// Calls use(point, its rest data, its corners, whether it is let go) of each point of an element. What is let go has
/// one law for shear and volume, at the points of shear.
template <class Use>
void at_points(const QuadraticTet& nodes, const TetRest& element, const VecX& x, bool let_go, Use&& use) {
  const Nodes n = nodes_at(nodes, x);
  for (const Point& p : points())
    if (!let_go || p.shear != 0.0) use(p, rest_at(element, p), Corners(n * p.map));
}

}  // namespace

QuadraticElements::QuadraticElements(const TetMesh& cut, std::span<const double> fraction) {
  IMPINGE_ASSERT(cut.tets.size() % kTetParts == 0 && fraction.size() == cut.tets.size());
  const int count = static_cast<int>(cut.tets.size()) / kTetParts;
  nodes_.reserve(count);
  rest_.reserve(count);
  for (int e = 0; e < count; ++e) {
    nodes_.push_back(quadratic_tet(cut, e));
    const auto at = [&](int k) { return cut.vertices[nodes_.back()[k]]; };
    rest_.push_back(make_tet_rest(at(0), at(1), at(2), at(3), fraction[static_cast<std::size_t>(e) * kTetParts]));
    IMPINGE_ASSERT(rest_.back().volume > 0.0);
  }
}

BlockPattern QuadraticElements::pattern(int nodes) const {
  std::vector<std::vector<int>> neighbours(nodes);
  for (const QuadraticTet& q : nodes_)
    for (const int i : q) neighbours[i].insert(neighbours[i].end(), q.begin(), q.end());
  std::vector<int> begin = {0}, column;
  for (std::vector<int>& row : neighbours) {
    std::sort(row.begin(), row.end());
    column.insert(column.end(), row.begin(), std::unique(row.begin(), row.end()));
    begin.push_back(static_cast<int>(column.size()));
    row = {};
  }
  return block_pattern_of_rows(std::move(begin), std::move(column));
}

double QuadraticElements::mass(int a, int b, bool lumped) {
  if (lumped) return a != b ? 0.0 : a < 4 ? 1.0 / 36.0 : 4.0 / 27.0;
  // ∫ N_a N_b over the tetrahedron
  if (a > b) std::swap(a, b);
  if (b < 4) return (a == b ? 6.0 : 1.0) / 420.0;
  const auto has = [](int edge, int corner) {
    return kTetEdges[edge - 4][0] == corner || kTetEdges[edge - 4][1] == corner;
  };
  if (a < 4) return (has(b, a) ? -4.0 : -6.0) / 420.0;
  if (a == b) return 32.0 / 420.0;
  return (has(b, kTetEdges[a - 4][0]) || has(b, kTetEdges[a - 4][1]) ? 16.0 : 8.0) / 420.0;
}

double QuadraticElements::energy(int e, const Material& material, const VecX& x, const Unwinding& unwinding,
                                 double mu) const {
  const std::size_t part = static_cast<std::size_t>(e) * kTetParts;
  const bool let_go = unwinding.lets_go(part);
  double sum = 0.0;
  at_points(nodes_[e], rest_[e], x, let_go, [&](const Point&, const TetRest& rest, const Corners& y) {
    sum += let_go ? unwinding.energy(rest, y, part, mu) : material.energy(rest, y);
  });
  return sum;
}

void QuadraticElements::force(int e, const Material& material, const VecX& x, const Unwinding& unwinding, double mu,
                              QuadraticAnswer& out) const {
  const std::size_t part = static_cast<std::size_t>(e) * kTetParts;
  const bool let_go = unwinding.lets_go(part);
  out.energy = 0.0;
  out.force.setZero();
  at_points(nodes_[e], rest_[e], x, let_go, [&](const Point& p, const TetRest& rest, const Corners& y) {
    ElementResponse point;
    if (let_go)
      unwinding.force(rest, y, part, mu, point);
    else
      material.force(rest, y, point);
    out.energy += point.energy;
    out.force.noalias() += point.force * p.map.transpose();
  });
}

void QuadraticElements::mean_force(int e, const Material& material, const VecX& x0, const VecX& x1,
                                   const Unwinding& unwinding, double mu, QuadraticAnswer& out) const {
  const std::size_t part = static_cast<std::size_t>(e) * kTetParts;
  const bool let_go = unwinding.lets_go(part);
  const Nodes before = nodes_at(nodes_[e], x0);
  out.energy = 0.0;
  out.force.setZero();
  at_points(nodes_[e], rest_[e], x1, let_go, [&](const Point& p, const TetRest& rest, const Corners& y1) {
    const Corners y0 = before * p.map;
    ElementResponse point;
    if (let_go)
      unwinding.force(rest, 0.5 * (y0 + y1), part, mu, point);
    else
      discrete_gradient(material, rest, y0, y1, point);
    out.energy += point.energy;
    out.force.noalias() += point.force * p.map.transpose();
  });
}

void QuadraticElements::response(int e, const Material& material, const VecX& x, Tangent tangent,
                                 const Unwinding& unwinding, double mu, QuadraticAnswer& out) const {
  const std::size_t part = static_cast<std::size_t>(e) * kTetParts;
  const bool let_go = unwinding.lets_go(part);
  out.energy = 0.0;
  out.force.setZero();
  for (Mat3& block : out.stiffness) block.setZero();
  at_points(nodes_[e], rest_[e], x, let_go, [&](const Point& p, const TetRest& rest, const Corners& y) {
    ElementResponse point;
    if (let_go)
      unwinding.response(rest, y, part, mu, point);
    else
      material.response(rest, y, tangent, point);
    out.energy += point.energy;
    out.force.noalias() += point.force * p.map.transpose();
    add_stiffness(p.map, point, out);
  });
}

std::array<ElementPoint, 2> QuadraticElements::stress_points(const TetMesh& cut, int part, const VecX& x) const {
  const int e = part / kTetParts;
  const QuadraticTet& nodes = nodes_[e];
  Vec4 middle = Vec4::Zero();
  for (const int v : cut.tets[part])
    middle += 0.25 * quadratic_node_weights(static_cast<int>(std::find(nodes.begin(), nodes.end(), v) - nodes.begin()));
  const Nodes n = nodes_at(nodes, x);
  const Point shear{map_at(middle), 1.0 / kTetParts, 1.0, 0.0},
      bulk{map_at(Vec4::Constant(0.25)), 1.0 / kTetParts, 0.0, 1.0};
  return {ElementPoint{rest_at(rest_[e], shear), n * shear.map}, ElementPoint{rest_at(rest_[e], bulk), n * bulk.map}};
}

}  // namespace impinge
