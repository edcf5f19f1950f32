#include "engine/geometry/triangle_intersection.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

// relative width of the bands; rounding in the triple products below is about 1e-15 of the same products. What lies
// flat on a face, a few picometres off, is outside of them
constexpr double kBand = 1e-13;

double l1(const Vec3& v) { return std::abs(v.x()) + std::abs(v.y()) + std::abs(v.z()); }

enum class Verdict { miss, hit, unsure };

// a triangle as Möller and Trumbore use it
struct Face {
  Vec3 origin, e1, e2, normal;
  double l1, l2;  // at least the lengths of e1 and e2
  explicit Face(const TriangleCorners& c)
      : origin(c[0]),
        e1(c[1] - c[0]),
        e2(c[2] - c[0]),
        normal(e1.cross(e2)),
        l1(impinge::l1(e1)),
        l2(impinge::l1(e2)) {}
};

// heights of three corners over a face's plane, times twice its area
struct Heights {
  double value[3];
  double band;
  Heights(const TriangleCorners& corners, const Face& face, double touch) {
    double reach = 0.0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 r = corners[k] - face.origin;
      value[k] = face.normal.dot(r);
      reach = std::max(reach, l1(r));
    }
    band = (kBand * reach + 4.0 * touch) * face.l1 * face.l2;
  }
  bool clearly_above(int k) const { return value[k] > band; }
  bool clearly_below(int k) const { return value[k] < -band; }
  bool all_on_one_side() const {
    return (clearly_above(0) && clearly_above(1) && clearly_above(2)) ||
           (clearly_below(0) && clearly_below(1) && clearly_below(2));
  }
};

// the segment from corner k to the next against the face; u and v first, then the ends' sides
Verdict edge_against(const TriangleCorners& corners, int k, const Heights& heights, const Face& face, double touch) {
  const int next = (k + 1) % 3;
  if ((heights.clearly_above(k) && heights.clearly_above(next)) ||
      (heights.clearly_below(k) && heights.clearly_below(next)))
    return Verdict::miss;
  const Vec3 direction = corners[next] - corners[k], s = corners[k] - face.origin;
  const double det = heights.value[k] - heights.value[next];  // e1·(direction × e2)
  if (std::abs(det) <= 2.0 * heights.band) return Verdict::unsure;
  const double sign = det > 0.0 ? 1.0 : -1.0, length = l1(direction);
  const double width = (kBand * (l1(s) + length) + 4.0 * touch) * length;
  const double u = sign * s.dot(direction.cross(face.e2));
  if (u < -width * face.l2) return Verdict::miss;
  const double v = sign * direction.dot(s.cross(face.e1));
  if (v < -width * face.l1) return Verdict::miss;
  const double w = sign * det - u - v, width_w = width * (face.l1 + face.l2);
  if (w < -width_w) return Verdict::miss;
  const bool crosses = (heights.clearly_above(k) && heights.clearly_below(next)) ||
                       (heights.clearly_below(k) && heights.clearly_above(next));
  return crosses && u > width * face.l2 && v > width * face.l1 && w > width_w ? Verdict::hit : Verdict::unsure;
}

// wide enough that the products below have no rounding that matters against that of the coordinates themselves
#if defined(__SIZEOF_FLOAT128__)
using Wide = __float128;
#else
using Wide = long double;
#endif

struct WideVector {
  Wide x, y, z;
};
WideVector difference(const Vec3& a, const Vec3& b) {
  return {static_cast<Wide>(a.x()) - b.x(), static_cast<Wide>(a.y()) - b.y(), static_cast<Wide>(a.z()) - b.z()};
}
Wide triple(const WideVector& a, const WideVector& b, const WideVector& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

// -1, 0, 1: the sign where rounding cannot have changed it, else 0
int sure_sign(double value, double rounding) { return value > rounding ? 1 : value < -rounding ? -1 : 0; }

// in wide numbers
bool pierces_exactly(const Vec3& p, const Vec3& q, const TriangleCorners& c) {
  const WideVector e1 = difference(c[1], c[0]), e2 = difference(c[2], c[0]), direction = difference(q, p),
                   s = difference(p, c[0]);
  const Wide at_p = triple(s, e1, e2), at_q = triple(difference(q, c[0]), e1, e2);
  if (!((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))) return false;
  const Wide sign = at_p > 0 ? 1 : -1, u = sign * triple(s, direction, e2), v = sign * triple(direction, s, e1);
  return u >= 0 && v >= 0 && sign * (at_p - at_q) - u - v >= 0;
}

// the same without bands. `distance` is that of the triangles' features: a segment that pierces the face has one of its
// ends, or a crossing with the border, no farther off than the higher of its ends stands over the plane
bool pierces(const Vec3& p, const Vec3& q, const TriangleCorners& c, double distance) {
  const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], direction = q - p, s = p - c[0], normal = e1.cross(e2);
  const double at_p = normal.dot(s), at_q = normal.dot(q - c[0]);
  const double height = std::max(std::abs(at_p), std::abs(at_q));
  constexpr double kRounding = 64.0 * 0x1.0p-53;  // of three factors' product, each a difference of coordinates
  const double rounding = kRounding * (l1(s) + l1(q - c[0])) * l1(e1) * l1(e2);
  if (distance * normal.norm() > height + rounding) return false;
  // in doubles wherever they decide, which is nearly everywhere
  const int side_p = sure_sign(at_p, rounding), side_q = sure_sign(at_q, rounding);
  if (side_p != 0 && side_p == side_q) return false;
  if (side_p != 0 && side_q != 0) {
    const double u = side_p * s.dot(direction.cross(e2)), v = side_p * direction.dot(s.cross(e1));
    const double rounding_u = kRounding * l1(s) * l1(direction) * l1(e2),
                 rounding_v = kRounding * l1(s) * l1(direction) * l1(e1);
    const double w = side_p * (at_p - at_q) - u - v;
    const double rounding_w = 2.0 * (rounding + rounding_u + rounding_v);
    const int side_u = sure_sign(u, rounding_u), side_v = sure_sign(v, rounding_v), side_w = sure_sign(w, rounding_w);
    if (side_u < 0 || side_v < 0 || side_w < 0) return false;
    if (side_u > 0 && side_v > 0 && side_w > 0) return true;
  }
  return pierces_exactly(p, q, c);
}

bool is_before(const Vec3& l, const Vec3& r) {
  return std::lexicographical_compare(l.data(), l.data() + 3, r.data(), r.data() + 3);
}

TriangleCorners sorted(TriangleCorners c) {
  std::sort(c.begin(), c.end(), is_before);
  return c;
}

bool decide_by_distance(const TriangleCorners& first, const TriangleCorners& second, double touch) {
  TriangleCorners a = sorted(first), b = sorted(second);
  if (std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end(), is_before)) std::swap(a, b);
  const double distance = std::sqrt(closest_features(a, b).squared_distance);
  if (distance <= touch) return true;
  for (int k = 0; k < 3; ++k)
    if (pierces(a[k], a[(k + 1) % 3], b, distance) || pierces(b[k], b[(k + 1) % 3], a, distance)) return true;
  return false;
}

}  // namespace

double touch_distance(const TriangleCorners& a) {
  return kTouchTolerance * a[0].cwiseAbs().cwiseMax(a[1].cwiseAbs()).cwiseMax(a[2].cwiseAbs()).maxCoeff();
}

bool triangles_intersect(const TriangleCorners& a, const TriangleCorners& b) {
  const double touch = std::max(touch_distance(a), touch_distance(b));
  const Face face_a(a);
  const Heights b_over_a(b, face_a, touch);
  if (b_over_a.all_on_one_side()) return false;
  const Face face_b(b);
  const Heights a_over_b(a, face_b, touch);
  if (a_over_b.all_on_one_side()) return false;
  bool is_unsure = false;
  for (int k = 0; k < 3; ++k) {
    Verdict verdict = edge_against(a, k, a_over_b, face_b, touch);
    if (verdict == Verdict::hit) return true;
    is_unsure |= verdict == Verdict::unsure;
    verdict = edge_against(b, k, b_over_a, face_a, touch);
    if (verdict == Verdict::hit) return true;
    is_unsure |= verdict == Verdict::unsure;
  }
  return is_unsure && decide_by_distance(a, b, touch);
}

std::optional<RayHit> intersect_line(const Vec3& origin, const Vec3& direction, const TriangleCorners& c,
                                     double slack) {
  const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], h = direction.cross(e2), s = origin - c[0];
  const double det = e1.dot(h);
  const double size = e1.norm() * e2.norm() * direction.norm();
  if (!(std::abs(det) > 1e-14 * size)) return std::nullopt;
  const double u = s.dot(h) / det;
  if (u < -slack || u > 1.0 + slack) return std::nullopt;
  const Vec3 q = s.cross(e1);
  const double v = direction.dot(q) / det;
  if (v < -slack || u + v > 1.0 + slack) return std::nullopt;
  return RayHit{e2.dot(q) / det, u, v};
}

}  // namespace impinge
