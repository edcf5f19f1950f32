// What a body is made of for contact: an immutable solid, shared by all bodies of equal shape. A shape is one file of
// this folder and one line of all.cpp; engine/README.md has the recipe. Everything is in the body's frame, metres.
#pragma once

#include <concepts>
#include <memory>
#include <string_view>
#include <variant>

#include "engine/geometry/aabb.hpp"
#include "engine/geometry/convex/convex_set.hpp"
#include "engine/geometry/mass_properties.hpp"

namespace impinge {

class Plane;
class SharedShape;
struct ShapePart;

/// The four forms of solids. Whoever handles shapes one form at a time visits all four; a shape is of exactly one.
using ShapeForm = std::variant<const Plane*,                    // a half-space, the only solid without bounds
                               const ConvexSet*,                // closed, bounded, convex
                               const SurfaceMesh*,              // what a closed triangle surface encloses
                               const std::vector<ShapePart>*>;  // several convex solids

class Shape : public std::enable_shared_from_this<Shape> {
 public:
  virtual ~Shape() = default;

  /// The word for it in scene files and messages, and the number of its line in all.cpp.
  std::string_view name() const;
  int type() const { return type_; }

  virtual ShapeForm form() const = 0;
  /// World bounds at a pose: a box that holds the shape, as small as there is. A plane bounds its half-space where it
  /// is axis-aligned, else nothing. Of a body that is a mesh the world vertices say it instead.
  virtual Aabb bounds(const Pose& pose) const = 0;
  /// Distance of the farthest point from the frame's origin, metres; 0 of a plane, which has none.
  virtual double bounding_radius() const = 0;
  /// Of the solid of a density in kg/m³. A plane, which never moves, has none: all zero.
  virtual MassProperties mass(double density) const = 0;
  /// The shape in a frame whose origin is `center`, its centre of mass. A shape that has it in its origin (exactly) has
  /// nothing to override.
  virtual SharedShape recentered(const Vec3& center) const;
  /// Distance of a point from the surface, metres, negative inside; of a compound inside, that of one of its parts.
  virtual double signed_distance(const Vec3& x) const = 0;
  /// Unit: the way in which that distance grows at x (inside, about so). By default from differences.
  virtual Vec3 outward(const Vec3& x) const;
  /// Closed, outward, inscribed triangles with edges about `edge` metres long: what a deformable body of this shape
  /// collides with. Throws InternalError for a plane.
  virtual TriangleMesh surface(double edge) const = 0;
  /// The same for pictures and exported files, always the same triangles for the same shape.
  virtual TriangleMesh drawn() const;
  /// The numbers that tell it from others of its type; none if there are too many: then it equals nothing but itself.
  virtual std::vector<double> dimensions() const { return {}; }

  /// How large it is where it matters for contact, metres: size_of (shape_size.hpp), found when it is first asked for.
  double size() const;
  /// Smallest side of the box round it at rest, metres: what an overlap or a motion is held against; likewise. A plane's is
  /// infinite.
  double thickness() const;

  /// The triangles if it is a mesh, else null; quicker than form().
  const SurfaceMesh* mesh() const { return mesh_; }
  /// The parts if it is a compound, else null.
  const std::vector<ShapePart>* parts() const {
    const ShapeForm f = form();
    const auto* parts = std::get_if<const std::vector<ShapePart>*>(&f);
    return parts == nullptr ? nullptr : *parts;
  }
  /// This shape if it is a T, else null: for whoever has a formula for T and something right for all others.
  template <std::derived_from<Shape> T>
  const T* as() const {
    return typeid(*this) == typeid(T) ? static_cast<const T*>(this) : nullptr;
  }

 protected:
  /// `name` stands in all.cpp, or an InternalError says that it does not.
  explicit Shape(std::string_view name, const SurfaceMesh* mesh = nullptr);
  Shape(const Shape&) = default;
  Shape(Shape&&) = default;

 private:
  int type_;
  const SurfaceMesh* mesh_;
  Lazily<double> size_, thickness_;
};

/// A shape that many share; made from any concrete one, or from the triangles of a mesh.
class SharedShape {
 public:
  SharedShape() = default;
  template <std::derived_from<Shape> T>
  SharedShape(T shape) : shape_(std::make_shared<const T>(std::move(shape))) {}
  SharedShape(MeshPointer surface);
  explicit SharedShape(std::shared_ptr<const Shape> shape) : shape_(std::move(shape)) {}

  const Shape* get() const { return shape_.get(); }
  const Shape* operator->() const { return shape_.get(); }
  const Shape& operator*() const { return *shape_; }
  explicit operator bool() const { return shape_ != nullptr; }

 private:
  std::shared_ptr<const Shape> shape_;
};

/// A convex solid as a part of a compound, at its place in the compound's frame.
struct ShapePart {
  SharedShape shape;
  Pose pose;
};

/// A closed bounded convex solid. `support` is enough to collide with everything; the rest has defaults made of it.
class ConvexShape : public Shape, public ConvexSet {
 public:
  ShapeForm form() const final { return static_cast<const ConvexSet*>(this); }
  Aabb bounds(const Pose& pose) const override;
  /// By default that of the box round it: too large by up to a factor of √3.
  double bounding_radius() const override;
  /// By default by the same search that finds contacts.
  double signed_distance(const Vec3& x) const override;

 protected:
  using Shape::Shape;
};

}  // namespace impinge
