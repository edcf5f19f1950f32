// The convex hull of points, or of the vertices of a surface file.
#include "engine/geometry/convex/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

class Hull final : public ConvexShape {
 public:
  explicit Hull(TriangleMesh surface)
      : ConvexShape("convex_hull"),
        solid_(std::make_shared<ConvexPolyhedron>(std::move(surface))),
        centered_(std::make_shared<Centered>()) {
    for (const Vec3& v : solid_->vertices()) bounding_radius_ = std::max(bounding_radius_, v.norm());
  }

  double bounding_radius() const override { return bounding_radius_; }
  MassProperties mass(double density) const override { return mesh_mass(solid_->surface()->mesh, density); }
  SharedShape recentered(const Vec3& center) const override {
    // all bodies of one hull share the moved one too
    const std::lock_guard lock(centered_->mutex);
    if (!centered_->shape || centered_->center != center) {
      TriangleMesh moved = solid_->surface()->mesh;
      for (Vec3& v : moved.vertices) v -= center;
      centered_->shape = Hull(std::move(moved));
      centered_->center = center;
    }
    return centered_->shape;
  }
  double signed_distance(const Vec3& x) const override {
    double most = -1e300;
    for (const ConvexPolyhedron::Face& f : solid_->faces()) most = std::max(most, f.normal.dot(x) - f.offset);
    return most <= 0.0 ? most : ConvexShape::signed_distance(x);
  }
  Vec3 support(const Vec3& d) const override { return solid_->vertices()[solid_->support_vertex(d)]; }
  ContactFace facing(const Vec3& d) const override { return solid_->facing(d); }
  const ConvexPolyhedron* polyhedron() const override { return solid_.get(); }
  TriangleMesh surface(double edge) const override;
  TriangleMesh drawn() const override { return solid_->surface()->mesh; }

 private:
  struct Centered {
    std::mutex mutex;
    Vec3 center = Vec3::Zero();
    SharedShape shape;
  };
  std::shared_ptr<const ConvexPolyhedron> solid_;
  std::shared_ptr<Centered> centered_;
  double bounding_radius_ = 0.0;
};

/// Each triangle cut into n² of its own form, n the same for all, so that they fit together.
TriangleMesh Hull::surface(double edge) const {
  const TriangleMesh& coarse = solid_->surface()->mesh;
  double longest = 0.0;
  for (const Triangle& t : coarse.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (coarse.vertices[t[(k + 1) % 3]] - coarse.vertices[t[k]]).norm());
  const int n = std::clamp(static_cast<int>(std::ceil(longest / edge)), 1, 256);
  TriangleMesh fine;
  fine.vertices = coarse.vertices;
  std::map<std::array<int, 3>, int> on_edge;  // its lower end, its upper end, how far from the lower
  const auto between = [&](int a, int b, int step) {
    if (step == 0) return a;
    if (step == n) return b;
    const bool ascending = a < b;
    const std::array<int, 3> key{std::min(a, b), std::max(a, b), ascending ? step : n - step};
    const auto [at, is_new] = on_edge.try_emplace(key, static_cast<int>(fine.vertices.size()));
    if (is_new)
      fine.vertices.push_back(coarse.vertices[key[0]] +
                              (static_cast<double>(key[2]) / n) * (coarse.vertices[key[1]] - coarse.vertices[key[0]]));
    return at->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    // row i runs from the side ab to the side ac, i steps from a
    std::vector<std::vector<int>> row(n + 1);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= i; ++j) {
        if (i == n) {
          row[i].push_back(between(b, c, j));
        } else if (j == 0) {
          row[i].push_back(between(a, b, i));
        } else if (j == i) {
          row[i].push_back(between(a, c, i));
        } else {
          const Vec3 u = (coarse.vertices[b] - coarse.vertices[a]) / n,
                     v = (coarse.vertices[c] - coarse.vertices[a]) / n;
          row[i].push_back(static_cast<int>(fine.vertices.size()));
          fine.vertices.push_back(coarse.vertices[a] + (i - j) * u + j * v);
        }
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        fine.triangles.push_back({row[i][j], row[i + 1][j], row[i + 1][j + 1]});
        if (j < i) fine.triangles.push_back({row[i][j], row[i + 1][j + 1], row[i][j + 1]});
      }
  }
  return fine;
}

}  // namespace

ShapeEntry convex_hull_shape() {
  return {"convex_hull",
          "The smallest convex solid round points, or round the vertices of a surface file.",
          {{"points", ShapeKey::points, "at least four, not in one plane", false},
           {"surface", ShapeKey::surface, "a mesh file, open or closed: only its vertices count", false}},
          [](const ShapeValues& values) -> SharedShape {
            if (values.has("points") == values.has("surface"))
              throw ShapeError{"",
                               values.has("points") ? "has points and a surface" : "has neither points nor a surface",
                               "one of points, surface is wanted", values.has("points") ? "remove one" : "add one"};
            const std::string key = values.has("points") ? "points" : "surface";
            ConvexHull hull = convex_hull(values.points(key));
            if (!hull.problem.empty())
              throw ShapeError{key, hull.problem, "a hull is that of four points or more that are not in one plane",
                               "add points off the plane, or use a box"};
            return Hull(std::move(hull.mesh));
          }};
}

}  // namespace impinge
