#include "engine/geometry/surface/normal_cones.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.hpp"
#include "engine/geometry/angle.hpp"

namespace impinge {
namespace {

constexpr std::size_t kATask = 4096;
constexpr double kWidest = 0.75;  // radians: from an eighth of a turn on, what a fold sees may lie behind its faces
// what an edge's own directions may leave the fold of its faces by (detection/contacts/edge_cone), as a part of the fold,
// and what floats round
constexpr double kOfFold = 0.27, kRounding = 2e-3;
constexpr double kTolerance = 1e-6;  // of a cosine
constexpr double kOfFloats = 2e-7;   // what a direction loses as three floats

/// Half-angle negative: any direction.
struct Cone {
  Vec3 axis = Vec3::Zero();
  double angle = -1.0;
  double of_faces = 0.0;  ///< the half-angle that holds the faces' normals alone
  bool is_any() const { return angle < 0.0; }
};

/// Round all of the given, about the middle of their axes.
template <class Cones>
Cone round_all(const Cones& cones) {
  Cone all;
  for (const Cone& c : cones) {
    if (c.is_any()) return {};
    all.axis += c.axis;
  }
  const double length = all.axis.norm();
  if (!(length > 1e-6)) return {};
  all.axis /= length;
  for (const Cone& c : cones) {
    const double between = angle_between(all.axis, c.axis);
    all.angle = std::max(all.angle, between + c.angle);
    all.of_faces = std::max(all.of_faces, between + c.of_faces);
  }
  return all.angle <= kWidest ? all : Cone{};
}

float chord_of(const Cone& cone) { return static_cast<float>(2.0 * std::sin(0.5 * cone.of_faces) + kOfFloats); }

/// With what else may be seen from there.
Cone widened(Cone cone) {
  if (!cone.is_any()) cone.angle += kOfFold * std::sin(std::min(2.0 * cone.angle, 0.5 * M_PI)) + kRounding;
  return cone;
}

template <class Work>
void for_each(std::size_t count, Work&& work) {
  parallel_for((count + kATask - 1) / kATask, 1, [&](std::size_t task) {
    for (std::size_t i = task * kATask; i < std::min(count, (task + 1) * kATask); ++i) work(i);
  });
}

/// Of the faces round each vertex.
std::vector<Cone> cones_of_vertices(const SurfaceMesh& surface) {
  const TriangleMesh& mesh = surface.mesh;
  const MeshTopology& topology = surface.topology;
  std::vector<Vec3> normals(mesh.triangles.size());
  for_each(normals.size(), [&](std::size_t t) {
    const Triangle& c = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[c[0]], across = (mesh.vertices[c[1]] - a).cross(mesh.vertices[c[2]] - a);
    const double length = across.norm();
    normals[t] = length > 0.0 ? Vec3(across / length) : Vec3(Vec3::Zero());
  });
  std::vector<Cone> cones(mesh.vertices.size());
  for_each(cones.size(), [&](std::size_t v) {
    const int first = topology.vertex_triangle_begin[v], last = topology.vertex_triangle_begin[v + 1];
    std::vector<Cone> faces;
    for (int i = first; i < last; ++i) {
      const Vec3& n = normals[topology.vertex_triangles[i]];
      if (n.isZero(0.0)) return;
      faces.push_back({n, 0.0});
    }
    cones[v] = round_all(faces);
  });
  // where the surface ends, or more than two faces meet, directions aren't bounded by faces
  const std::vector<int> uses = edge_uses(topology);
  for (std::size_t e = 0; e < uses.size(); ++e)
    if (uses[e] != 2) cones[topology.edges[e].v0] = cones[topology.edges[e].v1] = {};
  return cones;
}

}  // namespace

NormalCones::NormalCones(const DiscTree& discs, const SurfaceMesh& surface) {
  std::vector<Cone> vertices = cones_of_vertices(surface);
  vertices_.resize(vertices.size());
  for_each(vertices.size(), [&](std::size_t v) {
    const Cone& cone = vertices[v];
    OfVertex& own = vertices_[v];
    for (int axis = 0; axis < 3; ++axis) own.axis[axis] = static_cast<float>(cone.axis[axis]);
    own.chord = cone.is_any() ? -1.0f : chord_of(cone);
    vertices[v] = widened(cone);
  });
  begin_ = {0};
  for (int level = 0; level < discs.levels(); ++level) begin_.push_back(begin_.back() + discs.node_count(level));
  nodes_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<Cone> own, below;  // by disc of a level
  for (int level = discs.levels() - 1; level >= 0; --level) {
    const std::size_t count = static_cast<std::size_t>(begin_[level + 1] - begin_[level]);
    own.assign(4 * count, {});
    for_each(count, [&](std::size_t j) {
      Node& node = nodes_[static_cast<std::size_t>(begin_[level]) + j];
      for (int k = 0; k < 4; ++k) {
        Cone& cone = own[4 * j + k];
        if (k < discs.disc_count(level, static_cast<int>(j))) {
          if (level + 1 == discs.levels()) {
            const Triangle& t = surface.mesh.triangles[discs.order()[4 * j + k]];
            cone = round_all(std::array<Cone, 3>{vertices[t[0]], vertices[t[1]], vertices[t[2]]});
          } else {
            const std::size_t first = 4 * (4 * j + k);
            const int parts = discs.disc_count(level + 1, static_cast<int>(4 * j + k));
            cone = round_all(std::span(below).subspan(first, parts));
          }
        }
        for (int axis = 0; axis < 3; ++axis) node.axis[k][axis] = static_cast<float>(cone.axis[axis]);
        node.cosine[k] = cone.is_any() ? -2.0f : static_cast<float>(std::cos(cone.angle));
        node.chord[k] = chord_of(cone);
        node.sine[k] = static_cast<float>(std::sin(std::max(cone.angle, 0.0)));
      }
    });
    below.swap(own);
  }
}

bool NormalCones::may_see(int level, int j, int k, const Vec3& away, double radius, bool or_inside) const {
  const Node& node = this->node(level, j);
  if (node.is_any(k)) return true;
  const double square = away.squaredNorm();
  // what is seen from a place within `radius` lies within an angle round `away`, whose sine is this over the distance
  const double wide = radius * (1.0 + 1e-4);
  if (square <= wide * wide) return true;
  const double distance = std::sqrt(square), sine = wide / distance, cosine = std::sqrt(1.0 - sine * sine);
  const double own = node.cosine[k], own_sine = node.sine[k];
  const double both = cosine * own - sine * own_sine;  // of the sum of both angles
  if (or_inside && both <= 0.0) return true;
  double along = (away.x() * node.axis[k][0] + away.y() * node.axis[k][1] + away.z() * node.axis[k][2]) / distance;
  if (or_inside) along = std::abs(along);
  return along >= both - kTolerance;
}

const NormalCones& normal_cones(const SurfaceMesh& surface) {
  return surface.discs().lazy_cones.get([&] { return NormalCones(surface.discs(), surface); });
}

}  // namespace impinge
