// Closest points between points, segments and triangles, and on which feature they lie. [Ericson04 §5.1]
// Degenerate input (a triangle that is a segment or a point, a segment that is a point) gives the right answer, never
// NaN.
#pragma once

#include "engine/core/types.hpp"

namespace impinge {

/// The three corners of a triangle in space, metres.
using TriangleCorners = std::array<Vec3, 3>;
/// Across the triangle, twice its area long.
inline Vec3 normal_of(const TriangleCorners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

/// Where on a triangle a point lies. edge_k joins corners k and (k+1)%3.
enum class TriangleFeature : std::uint8_t { corner0, corner1, corner2, edge0, edge1, edge2, face };

inline bool is_corner(TriangleFeature f) { return f <= TriangleFeature::corner2; }
inline bool is_edge(TriangleFeature f) { return f >= TriangleFeature::edge0 && f <= TriangleFeature::edge2; }
/// Which corner or edge (0..2); 0 for the face.
inline int feature_number(TriangleFeature f) { return f == TriangleFeature::face ? 0 : static_cast<int>(f) % 3; }

struct PointSegment {
  double t = 0.0;  ///< the point is p + t (q - p), 0 <= t <= 1
  Vec3 point = Vec3::Zero();
  double squared_distance = 0.0;
};
PointSegment closest_on_segment(const Vec3& x, const Vec3& p, const Vec3& q);

struct PointTriangle {
  Vec3 point = Vec3::Zero();  ///< the point of the closed triangle that is closest to x
  TriangleFeature feature = TriangleFeature::face;
  double squared_distance = 0.0;
};
PointTriangle closest_on_triangle(const Vec3& x, const TriangleCorners& triangle);
/// Weights of the corners that give the point of the triangle nearest to x.
Vec3 nearest_weights(const Vec3& x, const TriangleCorners& triangle);

struct SegmentSegment {
  double s = 0.0, t = 0.0;  ///< parameters of the closest points on the first and the second segment, in [0, 1]
  Vec3 point0 = Vec3::Zero(), point1 = Vec3::Zero();
  double squared_distance = 0.0;
  /// Both points lie strictly inside their segments, which are not parallel: the line through them is their common
  /// normal.
  bool interior = false;
};
/// For parallel segments one of the closest pairs that contain an end point. Exactly symmetric: exchanging the segments
/// exchanges the points, bit for bit.
SegmentSegment closest_between_segments(const Vec3& p0, const Vec3& q0, const Vec3& p1, const Vec3& q1);

struct TriangleTriangle {
  Vec3 point0 = Vec3::Zero(), point1 = Vec3::Zero();
  double squared_distance = 0.0;
};
/// The smallest of the 6 corner-face and 9 edge-edge distances. This is the distance of the triangles unless an edge of
/// one pierces the face of the other; triangles_intersect tells that.
TriangleTriangle closest_features(const TriangleCorners& a, const TriangleCorners& b);

/// Distance of the two closed triangles, metres: 0 if they intersect (see triangles_intersect for its tolerance).
double triangle_distance(const TriangleCorners& a, const TriangleCorners& b);

/// Whether closest_features(a, b) <= limit, found without looking at more features than needed. The same answer, bit
/// for bit, as comparing squared_distance with limit².
bool features_within(const TriangleCorners& a, const TriangleCorners& b, double limit);

}  // namespace impinge
