// The difference of two placed convex sets, a - b, seen through its support function: GJK and EPA look for its point
// nearest to the origin.
#pragma once

#include "engine/geometry/convex/convex_polyhedron.hpp"

namespace impinge {

struct PlacedConvex {
  const ConvexSet* set = nullptr;
  Pose pose;
};

/// A point a - b of the difference and the two points it comes from (of the cores, world axes, origin at b's position).
struct MinkowskiPoint {
  Vec3 w = Vec3::Zero(), a = Vec3::Zero(), b = Vec3::Zero();
  int vertex_a = -1, vertex_b = -1;  ///< corner of a polyhedron, else -1
};

class MinkowskiDifference {
 public:
  MinkowskiDifference(const PlacedConvex& a, const PlacedConvex& b)
      : a_(a),
        b_(b),
        polyhedron_a_(a.set->polyhedron()),
        polyhedron_b_(b.set->polyhedron()),
        // far from the world's origin the difference of two positions is right to its own last digit
        offset_(a.pose.position - b.pose.position) {}

  const PlacedConvex& a() const { return a_; }
  const PlacedConvex& b() const { return b_; }
  const ConvexPolyhedron* polyhedron_a() const { return polyhedron_a_; }
  const ConvexPolyhedron* polyhedron_b() const { return polyhedron_b_; }
  bool is_polyhedral() const { return polyhedron_a_ != nullptr && polyhedron_b_ != nullptr; }
  double rounding() const { return a_.set->rounding() + b_.set->rounding(); }

  /// The point farthest along a direction.
  MinkowskiPoint support(const Vec3& direction) const {
    MinkowskiPoint p;
    const Vec3 to_a = turned_back(a_.pose.rotation, direction), to_b = turned_back(b_.pose.rotation, -direction);
    if (polyhedron_a_ != nullptr) {
      p.vertex_a = polyhedron_a_->support_vertex(to_a);
      p.a = corner_a(p.vertex_a);
    } else {
      p.a = product(a_.pose.rotation, a_.set->support(to_a)) + offset_;
    }
    if (polyhedron_b_ != nullptr) {
      p.vertex_b = polyhedron_b_->support_vertex(to_b);
      p.b = corner_b(p.vertex_b);
    } else {
      p.b = product(b_.pose.rotation, b_.set->support(to_b));
    }
    p.w = p.a - p.b + shift_;
    return p;
  }
  /// How far the cores are apart along a unit direction from b to a: negative where they overlap. Their distance is
  /// the largest value, and where all are negative it is the least overlap.
  double separation(const Vec3& direction) const { return direction.dot(support(-direction).w); }

  Vec3 corner_a(int v) const { return product(a_.pose.rotation, polyhedron_a_->vertices()[v]) + offset_; }
  Vec3 corner_b(int v) const { return product(b_.pose.rotation, polyhedron_b_->vertices()[v]); }
  Vec3 to_world(const Vec3& x) const { return x + b_.pose.position; }
  /// From b's position to a's.
  const Vec3& offset() const { return offset_; }
  /// Moves a by a vector for the time being; the points a and b of what support() returns stay where they are.
  void set_shift(const Vec3& shift) { shift_ = shift; }

 private:
  /// By the transposed matrix, written out as `product` is: Eigen's sums to the bit.
  static Vec3 turned_back(const Mat3& m, const Vec3& x) {
    return {(m(0, 0) * x.x() + m(1, 0) * x.y()) + m(2, 0) * x.z(),
            (m(0, 1) * x.x() + m(1, 1) * x.y()) + m(2, 1) * x.z(),
            (m(0, 2) * x.x() + m(1, 2) * x.y()) + m(2, 2) * x.z()};
  }

  PlacedConvex a_, b_;
  const ConvexPolyhedron *polyhedron_a_, *polyhedron_b_;
  Vec3 offset_, shift_ = Vec3::Zero();
};

}  // namespace impinge
