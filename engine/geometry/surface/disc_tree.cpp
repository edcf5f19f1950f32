#include "engine/geometry/surface/disc_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/core/four_floats.hpp"
#include "engine/core/parallel.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace impinge {
namespace {

constexpr std::size_t kNodesATask = 256;
constexpr float kShortest = 1e-15f;     // metres or metres² of a vector that has a direction
constexpr float kWider = 1.0f + 1e-6f;  // for what rounds relatively

/// Puts triangles into the order of a tree.
class Sorter {
 public:
  Sorter(std::span<const Triangle> triangles, std::span<const Vec3> vertices, std::vector<int>& order) : order_(order) {
    centers_.reserve(triangles.size());
    for (const Triangle& t : triangles) centers_.push_back(vertices[t[0]] + vertices[t[1]] + vertices[t[2]]);
  }

  /// `room`: triangles that a full node of this level has below it.
  void sort(int room) {
    std::vector<Part> parts = {{0, static_cast<int>(order_.size()), room}}, next;
    while (!parts.empty() && parts.size() < 64) {
      next.clear();
      for (const Part& part : parts) split(part, next);
      parts.swap(next);
    }
    parallel_for(parts.size(), 1, [&](std::size_t i) { fill(parts[i]); });
  }

 private:
  struct Part {
    int first, last, room;
  };

  void fill(const Part& part) {
    std::vector<Part> below;
    split(part, below);
    for (const Part& p : below) fill(p);
  }

  /// Into quarters, each but the last full.
  void split(const Part& part, std::vector<Part>& out) {
    const int quarter = part.room / 4, count = part.last - part.first;
    if (count <= 1 || quarter == 0) return;
    if (count > 2 * quarter) {
      cut(part.first, part.last, part.first + 2 * quarter);
      if (count > 3 * quarter) cut(part.first + 2 * quarter, part.last, part.first + 3 * quarter);
    }
    if (count > quarter) cut(part.first, std::min(part.last, part.first + 2 * quarter), part.first + quarter);
    for (int first = part.first; first < part.last; first += quarter)
      out.push_back({first, std::min(part.last, first + quarter), quarter});
  }

  void cut(int first, int last, int middle) {
    Aabb box;
    for (int i = first; i < last; ++i) box.include(centers_[order_[i]]);
    int axis = 0;
    box.extent().maxCoeff(&axis);
    const auto begin = order_.begin();
    std::nth_element(begin + first, begin + middle, begin + last, [&](int l, int r) {
      const double x = centers_[l][axis], y = centers_[r][axis];
      return x < y || (x == y && l < r);
    });
  }

  std::vector<int>& order_;
  std::vector<Vec3> centers_;  // times three
};

using Three = std::array<FourFloats, 3>;

Three operator-(const Three& a, const Three& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
FourFloats dot(const Three& a, const Three& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Three cross(const Three& a, const Three& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

using FloatVector = Eigen::Vector3f;

FloatVector column(const float (&rows)[3][4], int k) { return {rows[0][k], rows[1][k], rows[2][k]}; }

/// The direction, or 0 where it would be noise.
FloatVector unit_or_zero(const FloatVector& x) {
  const float length = x.norm();
  return length > kShortest ? FloatVector(x / length) : FloatVector::Zero();
}

/// The same for normals that were divided already.
void forget_short(FourFloats length, DiscTree::Node& node, Three& normal) {
  const unsigned long_ones = is_larger(length, FourFloats(kShortest));
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 4; ++k)
      if ((long_ones >> k & 1u) == 0) node.normal[axis][k] = 0.0f;
    normal[axis] = FourFloats::at(node.normal[axis]);
  }
}

}  // namespace

DiscTree::DiscTree(std::span<const Triangle> triangles, std::span<const Vec3> vertices) : order_(triangles.size()) {
  if (triangles.empty()) return;
  std::vector<int> counts;
  int room = 4;
  for (std::size_t count = (order_.size() + 3) / 4;; count = (count + 3) / 4, room *= 4) {
    counts.push_back(static_cast<int>(count));
    if (count == 1) break;
  }
  begin_ = {0};
  for (std::size_t level = counts.size(); level-- > 0;) begin_.push_back(begin_.back() + counts[level]);
  nodes_.resize(static_cast<std::size_t>(begin_.back()));
  std::iota(order_.begin(), order_.end(), 0);
  Sorter(triangles, vertices, order_).sort(room);
  fit(triangles, vertices);
}

void DiscTree::fit(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  Aabb box;
  for (const Vec3& x : vertices) box.include(x);
  origin_ = box.center();
  reach_ = 0.5 * box.extent().maxCoeff();
  rounding_ = 1e-6f * static_cast<float>(reach_);
  for (int level = levels() - 1; level >= 0; --level) {
    const std::size_t count = static_cast<std::size_t>(begin_[level + 1] - begin_[level]);
    parallel_for((count + kNodesATask - 1) / kNodesATask, 1, [&](std::size_t task) {
      for (std::size_t j = task * kNodesATask; j < std::min(count, (task + 1) * kNodesATask); ++j) {
        const int node = static_cast<int>(j);
        if (level == levels() - 1)
          fit_triangles(node, triangles, vertices);
        else
          for (int k = 0; k < disc_count(level, node); ++k) fit_disc(level, node, k);
      }
    });
  }
}

void DiscTree::fit_triangles(int j, std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
  Node& node = nodes_[static_cast<std::size_t>(begin_[levels() - 1] + j)];
  alignas(16) float corner[3][3][4];
  for (int k = 0; k < 4; ++k) {
    const Triangle& t = triangles[order_[static_cast<std::size_t>(std::min(4 * j + k, triangle_count() - 1))]];
    for (int c = 0; c < 3; ++c) {
      const Vec3 x = vertices[t[c]] - origin_;
      for (int axis = 0; axis < 3; ++axis) corner[c][axis][k] = static_cast<float>(x[axis]);
    }
  }
  std::array<Three, 3> p;
  for (int c = 0; c < 3; ++c)
    for (int axis = 0; axis < 3; ++axis) p[c][axis] = FourFloats::at(corner[c][axis]);
  const Three across = cross(p[1] - p[0], p[2] - p[0]);
  const FourFloats length = square_root(dot(across, across)), third(1.0f / 3.0f), rounding(rounding_);
  Three center, normal;
  for (int axis = 0; axis < 3; ++axis) {
    center[axis] = (p[0][axis] + p[1][axis] + p[2][axis]) * third;
    normal[axis] = across[axis] / length;
    center[axis].store(node.center[axis]), normal[axis].store(node.normal[axis]);
  }
  if (is_larger(length, FourFloats(kShortest)) != 0b1111) forget_short(length, node, normal);
  FourFloats thickness(0.0f), square(0.0f);
  Three half = {thickness, thickness, thickness};
  for (int c = 0; c < 3; ++c) {
    const Three arm = p[c] - center;
    thickness = larger(thickness, magnitude(dot(normal, arm)));
    square = larger(square, dot(arm, arm));
    for (int axis = 0; axis < 3; ++axis) half[axis] = larger(half[axis], magnitude(arm[axis]));
  }
  for (int axis = 0; axis < 3; ++axis) (half[axis] + rounding).store(node.half[axis]);
  const FourFloats radius = square_root(square) * FourFloats(kWider) + rounding;
  (thickness + radius * FourFloats(1e-6f) + rounding).store(node.thickness);
  radius.store(node.radius);
}

void DiscTree::fit_disc(int level, int j, int k) {
  Node& node = nodes_[static_cast<std::size_t>(begin_[level] + j)];
  const int below = 4 * j + k, count = disc_count(level + 1, below);
  const Node& own = this->node(level + 1, below);
  FloatVector low = column(own.center, 0), high = low, sum = FloatVector::Zero();
  for (int i = 0; i < count; ++i) {
    const FloatVector c = column(own.center, i), h = column(own.half, i);
    low = low.cwiseMin(c - h), high = high.cwiseMax(c + h);
    sum += own.radius[i] * own.radius[i] * column(own.normal, i);
  }
  const FloatVector normal = unit_or_zero(sum), middle = 0.5f * (low + high);
  float bottom = INFINITY, top = -INFINITY;
  for (int i = 0; i < count; ++i) {
    const float height = normal.dot(column(own.center, i) - middle), cosine = normal.dot(column(own.normal, i)),
                sine = std::sqrt(std::max(0.0f, 1.0f + 2e-6f - cosine * cosine)),
                half = std::min(own.radius[i], std::abs(cosine) * own.thickness[i] + sine * own.radius[i]);
    bottom = std::min(bottom, height - half), top = std::max(top, height + half);
  }
  const FloatVector center = middle + 0.5f * (bottom + top) * normal;
  float radius = 0.0f;
  for (int i = 0; i < count; ++i) radius = std::max(radius, (column(own.center, i) - center).norm() + own.radius[i]);
  const FloatVector half = (high - center).cwiseMax(center - low) * kWider + FloatVector::Constant(rounding_);
  radius = std::min(radius * kWider + rounding_, half.norm() * kWider);
  for (int axis = 0; axis < 3; ++axis)
    node.center[axis][k] = center[axis], node.normal[axis][k] = normal[axis], node.half[axis][k] = half[axis];
  node.thickness[k] = 0.5f * (top - bottom) * kWider + radius * 1e-6f + rounding_;
  node.radius[k] = radius;
}

double DiscTree::size() const {
  double sum = 0.0;
  for (int level = 0; level + 1 < levels(); ++level)
    for (int j = 0; j < begin_[level + 1] - begin_[level]; ++j)
      for (int k = 0; k < disc_count(level, j); ++k) sum += node(level, j).radius[k];
  return sum;
}

const DiscTree& SurfaceMesh::discs() const {
  return lazy_discs.get([&] { return DiscTree(mesh.triangles, mesh.vertices); });
}

}  // namespace impinge
