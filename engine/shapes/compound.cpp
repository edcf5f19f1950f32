// Several convex solids that move as one. Where parts overlap, the overlap weighs once for each: parts that only touch
// have the mass of their union.
#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

Pose inside(const Pose& outer, const Pose& inner) {
  return {outer.rotation * inner.rotation, outer.apply(inner.position)};
}

class Compound final : public Shape {
 public:
  explicit Compound(std::vector<ShapePart> parts) : Shape("compound"), parts_(std::move(parts)) {}

  ShapeForm form() const override { return &parts_; }
  Aabb bounds(const Pose& pose) const override {
    Aabb box;
    for (const ShapePart& p : parts_) box.include(p.shape->bounds(inside(pose, p.pose)));
    return box;
  }
  double bounding_radius() const override {
    double reach = 0.0;
    for (const ShapePart& p : parts_) reach = std::max(reach, p.pose.position.norm() + p.shape->bounding_radius());
    return reach;
  }
  MassProperties mass(double density) const override {
    MassProperties sum;
    std::vector<MassProperties> of_parts;
    for (const ShapePart& p : parts_) {
      of_parts.push_back(p.shape->mass(density));
      sum.mass += of_parts.back().mass;
      sum.center += of_parts.back().mass * p.pose.apply(of_parts.back().center);
    }
    sum.center /= sum.mass;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Pose& pose = parts_[i].pose;
      const Vec3 r = pose.apply(of_parts[i].center) - sum.center;
      sum.inertia += pose.rotation * of_parts[i].inertia * pose.rotation.transpose() +
                     of_parts[i].mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    return sum;
  }
  SharedShape recentered(const Vec3& center) const override {
    std::vector<ShapePart> moved = parts_;
    for (ShapePart& p : moved) p.pose.position -= center;
    return Compound(std::move(moved));
  }
  double signed_distance(const Vec3& x) const override {
    double least = 1e300;
    for (const ShapePart& p : parts_) least = std::min(least, p.shape->signed_distance(p.pose.apply_inverse(x)));
    return least;
  }
  TriangleMesh surface(double edge) const override {
    return joined([&](const Shape& part) { return part.surface(edge); });
  }
  TriangleMesh drawn() const override {
    return joined([](const Shape& part) { return part.drawn(); });
  }

 private:
  template <class Triangles>
  TriangleMesh joined(Triangles&& of) const {
    TriangleMesh all;
    for (const ShapePart& p : parts_) {
      const TriangleMesh part = of(*p.shape);
      const int first = static_cast<int>(all.vertices.size());
      for (const Vec3& v : part.vertices) all.vertices.push_back(p.pose.apply(v));
      for (const auto& [a, b, c] : part.triangles) all.triangles.push_back({a + first, b + first, c + first});
    }
    return all;
  }

  std::vector<ShapePart> parts_;
};

/// Compounds among the parts give their own parts, and every part has its frame in its centre of mass.
void take(const ShapePart& part, const Pose& pose, int number, std::vector<ShapePart>& all) {
  struct Take {
    const ShapePart& part;
    const Pose& pose;
    int number;
    std::vector<ShapePart>& all;
    void operator()(const ConvexSet*) const {
      const Vec3 center = part.shape->mass(1.0).center;
      all.push_back({part.shape->recentered(center), {pose.rotation, pose.apply(center)}});
    }
    void operator()(const std::vector<ShapePart>* parts) const {
      for (const ShapePart& inner : *parts) take(inner, inside(pose, inner.pose), number, all);
    }
    void operator()(const Plane*) const { refuse("has no bounds"); }
    void operator()(const SurfaceMesh*) const { refuse("need not be convex"); }
    void refuse(const char* why) const {
      throw ShapeError{
          "parts", "has a " + std::string(part.shape->name()) + " as part " + std::to_string(number) + ", which " + why,
          "convex shapes and compounds of them are parts", "use a box or a convex_hull"};
    }
  };
  std::visit(Take{part, pose, number, all}, part.shape->form());
}

}  // namespace

ShapeEntry compound_shape() {
  return {"compound",
          "Several convex shapes at their places that move as one.",
          {{"parts", ShapeKey::parts, "its solids; where they overlap, the overlap weighs once for each"}},
          [](const ShapeValues& values) -> SharedShape {
            const std::vector<ShapePart> parts = values.parts("parts");
            if (parts.empty()) throw ShapeError{"parts", "has no parts", "one part or more is wanted", "add one"};
            std::vector<ShapePart> all;
            for (std::size_t i = 0; i < parts.size(); ++i) take(parts[i], parts[i].pose, static_cast<int>(i), all);
            if (all.size() > 1000)
              throw ShapeError{"parts", "has " + std::to_string(all.size()) + " parts in all", "at most 1000 are taken",
                               "use fewer"};
            return Compound(std::move(all));
          },
          "is several solids, not one closed surface"};
}

}  // namespace impinge
