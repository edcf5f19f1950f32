// Box against box. Separating axes say how the boxes lie; a pair of faces gives a clipped manifold, a pair of edges its
// crossing, and separated boxes whose nearest features are corners or edges the exact distance between them.
#include <array>
#include <optional>

#include "engine/detection/pairs/face_manifold.hpp"
#include "engine/detection/pairs/ridge_contacts.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

/// Normals within about 14 degrees of a face's get that face's manifold too: a box that lands nearly flat is held by
/// all the points it is about to rest on, not by its lowest one alone.
constexpr double kNearlyFace = 0.97;

/// The same where contacts are not sought again in the sub-step: a box that lands on a corner comes down on the next one.
constexpr double kSideways = 0.5;

/// Of the smaller box's thickness: a box that stands this much below the level of another's face passes over it.
constexpr double kLevel = 1e-5;

struct FaceAxis {
  double separation = -1e300;
  bool of_first = true;
  int axis = 0;
  Vec3 normal = Vec3::UnitY();  ///< from the second towards the first box
};

struct EdgeAxis {
  double separation = -1e300;
  int axis_first = -1, axis_second = -1;
  Vec3 normal = Vec3::UnitY();
};

/// Edges of a crossing that is a contact by itself are numbered from here on; the manifold's crossings, whose points
/// lie above a face instead, have the same two edges from 0 on.
constexpr int kCrossing = 12;

struct Boxes {
  OrientedBox first, second;
  double tie;  ///< metres: separations closer than this are equal (rounding of the axes, not geometry)
};

/// Axis 0 to 2 of the first box, 3 to 5 of the second.
FaceAxis face_axis(const Boxes& boxes, int i) {
  const OrientedBox& owner = i < 3 ? boxes.first : boxes.second;
  const OrientedBox& other = i < 3 ? boxes.second : boxes.first;
  const Vec3 axis = owner.axes.col(i % 3);
  const double along = axis.dot(boxes.first.center - boxes.second.center);
  const double separation = std::abs(along) - owner.half[i % 3] - other.radius_along(axis);
  return {separation, i < 3, i % 3, along < 0.0 ? Vec3(-axis) : axis};
}

FaceAxis best_face(const Boxes& boxes) {
  FaceAxis best;
  for (int i = 0; i < 6; ++i) {
    const FaceAxis face = face_axis(boxes, i);
    // strictly better by more than rounding: equal faces go to the first box and the first axis, in every step
    if (i == 0 || face.separation > best.separation + boxes.tie) best = face;
  }
  return best;
}

EdgeAxis best_edge(const Boxes& boxes) {
  const Vec3 offset = boxes.first.center - boxes.second.center;
  EdgeAxis best;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3 cross = boxes.first.axes.col(i).cross(boxes.second.axes.col(j));
      const double length = cross.norm();
      if (length < 1e-5) continue;  // parallel: the faces say it all, and the direction would be rounding
      const Vec3 axis = cross / length;
      const double along = axis.dot(offset);
      const double separation = std::abs(along) - boxes.first.radius_along(axis) - boxes.second.radius_along(axis);
      if (separation > best.separation + boxes.tie) best = {separation, i, j, along < 0.0 ? Vec3(-axis) : axis};
    }
  return best;
}

/// Corner of the box that lies farthest along `direction`.
int support(const OrientedBox& box, const Vec3& direction) {
  const Vec3 local = box.axes.transpose() * direction;
  return (local.x() > 0.0 ? 1 : 0) | (local.y() > 0.0 ? 2 : 0) | (local.z() > 0.0 ? 4 : 0);
}

/// Metres: points no farther from each other are one.
double same_place(const Boxes& boxes) {
  return 1e-4 * std::min(boxes.first.half.minCoeff(), boxes.second.half.minCoeff());
}

void add_manifold(ContactSink& sink, const Boxes& boxes, const FaceAxis& face, bool overlapping) {
  if (face.of_first)
    add_face_manifold(sink, boxes.first, boxes.second, face.axis, -face.normal, true, overlapping);
  else
    add_face_manifold(sink, boxes.second, boxes.first, face.axis, face.normal, false, overlapping);
}

/// A crossing is where one edge leaves the face beside the other, and the face's normal there is not the way out. Of boxes that
/// lie flat it is, and corners keep their names.
void keep_crossing(ContactSink& sink, const Boxes& boxes, const FaceAxis& face, const Candidate& crossing) {
  if (crossing.normal.dot(face.normal) > kSameWay) return;
  sink.forget_beside(crossing, same_place(boxes) + std::abs(gap_of(crossing)));
}

void overlapping(ContactSink& sink, const Boxes& boxes, const FaceAxis& face, const EdgeAxis& edge) {
  // 2 %: a face holds a box better than a crossing of nearly the same depth; the depth stays continuous at zero
  if (edge.axis_first < 0 || edge.separation <= face.separation + boxes.tie + 0.02 * std::abs(face.separation)) {
    add_manifold(sink, boxes, face, true);
    return;
  }
  const int edge_first = OrientedBox::edge_of(edge.axis_first, support(boxes.first, -edge.normal));
  const int edge_second = OrientedBox::edge_of(edge.axis_second, support(boxes.second, edge.normal));
  const auto a = OrientedBox::edge_corners(edge_first), b = OrientedBox::edge_corners(edge_second);
  const SegmentSegment closest = closest_between_segments(boxes.first.corner(a[0]), boxes.first.corner(a[1]),
                                                          boxes.second.corner(b[0]), boxes.second.corner(b[1]));
  Candidate c;
  c.normal = edge.normal;
  c.point_first = closest.point0;
  c.point_second = closest.point1;
  c.kind_first = c.kind_second = Feature::edge;
  c.index_first = kCrossing + edge_first;
  c.index_second = kCrossing + edge_second;
  sink.add(c);
  // but not where the face lies much deeper than the crossing: that would push farther than the way out
  if (edge.normal.dot(face.normal) > kNearlyFace && face.separation > 1.05 * edge.separation - sink.reach()) {
    add_manifold(sink, boxes, face, true);
    keep_crossing(sink, boxes, face, c);
  }
}

/// A corner of one box and where the other is nearest to it.
struct CornerDistance {
  NearestOnBox nearest;
  Vec3 corner;
  int index = 0;
  bool of_first = true;
  Vec3 normal() const { return of_first ? nearest.normal : Vec3(-nearest.normal); }
};

Candidate corner_candidate(const CornerDistance& d) {
  Candidate c;
  c.normal = d.normal();
  c.point_first = d.of_first ? d.corner : d.nearest.point;
  c.point_second = d.of_first ? d.nearest.point : d.corner;
  if (d.nearest.beyond == 1) c.owner = d.of_first ? NormalOwner::second : NormalOwner::first;
  Feature kind = Feature::face;
  int index = 0, corner = 0;
  for (int k = 0; k < 3; ++k)
    if (d.nearest.side[k] > 0) corner |= 1 << k;
  for (int k = 0; k < 3; ++k) {
    if (d.nearest.beyond == 1 && d.nearest.side[k] != 0) index = 2 * k + (d.nearest.side[k] > 0 ? 1 : 0);
    if (d.nearest.beyond == 2 && d.nearest.side[k] == 0) {
      kind = Feature::edge;
      index = OrientedBox::edge_of(k, corner);
    }
  }
  if (d.nearest.beyond == 3) {
    kind = Feature::vertex;
    index = corner;
  }
  c.kind_first = d.of_first ? Feature::vertex : kind;
  c.index_first = d.of_first ? d.index : index;
  c.kind_second = d.of_first ? kind : Feature::vertex;
  c.index_second = d.of_first ? index : d.index;
  return c;
}

/// How far edges of two boxes are from each other at least, by planes at right angles to a few directions: most pairs are
/// told apart so.
class EdgeBounds {
 public:
  EdgeBounds(const std::array<Vec3, 8>& first, const std::array<Vec3, 8>& second, const Vec3& origin)
      : first_(first), second_(second), origin_(origin) {}

  /// A direction from the second towards the first, unit.
  void add(const Vec3& direction) {
    std::array<double, 8> of_first, of_second;
    for (int k = 0; k < 8; ++k)
      of_first[k] = direction.dot(first_[k] - origin_), of_second[k] = direction.dot(second_[k] - origin_);
    Heights& heights = heights_[count_++];
    for (int i = 0; i < 12; ++i) {
      const auto ends = OrientedBox::edge_corners(i);
      heights.low_first[i] = std::min(of_first[ends[0]], of_first[ends[1]]);
      heights.high_second[i] = std::max(of_second[ends[0]], of_second[ends[1]]);
    }
  }

  bool are_farther(int edge_first, int edge_second, double distance) const {
    for (int k = 0; k < count_; ++k)
      if (heights_[k].low_first[edge_first] - heights_[k].high_second[edge_second] > distance) return true;
    return false;
  }

 private:
  struct Heights {
    std::array<double, 12> low_first, high_second;
  };
  const std::array<Vec3, 8>&first_, &second_;
  Vec3 origin_;
  std::array<Heights, 2> heights_;
  int count_ = 0;
};

void separated(ContactSink& sink, const Boxes& boxes, const FaceAxis& face) {
  std::array<Vec3, 8> of_first, of_second;
  for (int k = 0; k < 8; ++k) of_first[k] = boxes.first.corner(k), of_second[k] = boxes.second.corner(k);
  std::array<CornerDistance, 16> corners;
  int nearest = 0;
  for (int i = 0; i < 16; ++i) {
    CornerDistance& d = corners[i];
    d.of_first = i < 8;
    d.index = i % 8;
    d.corner = (d.of_first ? of_first : of_second)[d.index];
    d.nearest = nearest_on_box(d.of_first ? boxes.second : boxes.first, d.corner);
    if (d.nearest.distance < corners[nearest].nearest.distance) nearest = i;
  }
  double distance = corners[nearest].nearest.distance;
  // a separation is a lower bound of the distance: if a corner reaches that of a face, nothing is nearer
  if (distance <= face.separation + boxes.tie) {
    add_manifold(sink, boxes, face, false);
    return;
  }

  Vec3 normal = corners[nearest].normal();
  Candidate crossing;
  bool edges_nearest = false;
  EdgeBounds bounds(of_first, of_second, boxes.second.center);
  bounds.add(face.normal);
  bounds.add(normal);
  for (int i = 0; i < 12; ++i) {
    const auto a = OrientedBox::edge_corners(i);
    for (int j = 0; j < 12; ++j) {
      if (bounds.are_farther(i, j, distance)) continue;
      const auto b = OrientedBox::edge_corners(j);
      const SegmentSegment closest =
          closest_between_segments(of_first[a[0]], of_first[a[1]], of_second[b[0]], of_second[b[1]]);
      const Vec3 offset = closest.point0 - closest.point1;
      const double length = offset.norm();
      if (!(length < distance - boxes.tie)) continue;
      distance = length;
      normal = offset / length;
      edges_nearest = true;
      crossing.normal = normal;
      crossing.point_first = closest.point0;
      crossing.point_second = closest.point1;
      crossing.kind_first = crossing.kind_second = Feature::edge;
      crossing.index_first = kCrossing + i;
      crossing.index_second = kCrossing + j;
    }
  }

  if (normal.dot(face.normal) > (sink.query().either_may_stop ? kSideways : kNearlyFace))
    add_manifold(sink, boxes, face, false);
  // corners seen from both boxes, or held by the manifold already, count once
  const auto add = [&](const Candidate& c) {
    if (!sink.covers(c, same_place(boxes), 100.0 * boxes.tie)) sink.add_new(c);
  };
  if (edges_nearest) keep_crossing(sink, boxes, face, crossing);
  add(edges_nearest ? crossing : corner_candidate(corners[nearest]));
  // further corners that face the same way: the other end of two parallel edges
  for (const CornerDistance& d : corners)
    if (d.normal().dot(normal) > kNearlyFace) add(corner_candidate(d));
}

Vec3 approach(const ContactSink& sink, const Boxes& boxes) {
  return sink.first().velocity_at(boxes.first.center) - sink.second().velocity_at(boxes.first.center);
}

/// The face whose plane the boxes are level with beside the one that keeps them apart: what slides over a floor of boxes is
/// level with the next one's top. None if there is none.
std::optional<FaceAxis> level_face(const Boxes& boxes, const FaceAxis& face) {
  const double level = kLevel * std::min(boxes.first.half.minCoeff(), boxes.second.half.minCoeff());
  for (int i = 0; i < 6; ++i) {
    const FaceAxis other = face_axis(boxes, i);
    if (std::abs(other.normal.dot(face.normal)) < 0.5 && std::abs(other.separation) <= level) return other;
  }
  return std::nullopt;
}

/// Edge along edge, if that is all that touches.
std::vector<Candidate> ridge_of(const ContactSink& sink, const Boxes& boxes, const FaceAxis& face,
                                const EdgeAxis& edge) {
  const double separation = std::max(face.separation, edge.separation);
  if (std::abs(separation) > ridge_tolerance(2.0 * boxes.first.half.norm(), 2.0 * boxes.second.half.norm())) return {};
  // one axis of each runs the same way; all three do where faces lie on faces, mostly
  if (((boxes.first.axes.transpose() * boxes.second.axes).cwiseAbs().array() > 0.9998).count() == 0) return {};
  return ridge_contacts(sink, {*shape_of<Box>(sink.first()).polyhedron(), sink.first().pose},
                        {*shape_of<Box>(sink.second()).polyhedron(), sink.second().pose}, face.normal);
}

}  // namespace

void box_box(ContactSink& sink) {
  Boxes boxes{world_box(sink.first()), world_box(sink.second()), 0.0};
  boxes.tie = 1e-10 * (boxes.first.half.sum() + boxes.second.half.sum());
  FaceAxis face = best_face(boxes);
  if (face.separation > sink.reach()) return;
  const EdgeAxis edge = best_edge(boxes);
  if (edge.separation > sink.reach()) return;
  if (const std::vector<Candidate> ridge = ridge_of(sink, boxes, face, edge); !ridge.empty()) {
    for (const Candidate& c : ridge) sink.add_new(c);
    return;
  }
  // A rounding below the level of the next box's top does not make its side a wall: what moves along that level passes,
  // and where both faces are as near, the one that the motion runs along decides.
  if (const std::optional<FaceAxis> level = level_face(boxes, face)) {
    const Vec3 v = approach(sink, boxes);
    const double along = std::abs(v.dot(face.normal)), across = std::abs(v.dot(level->normal));
    if (face.separation > boxes.tie && across * sink.query().time_step <= sink.query().activation) return;
    if (across < along) face = *level;
  }
  // within rounding of touching the crossing's own axis is a direction, and the points' difference is none
  if (std::max(face.separation, edge.separation) > boxes.tie)
    separated(sink, boxes, face);
  else
    overlapping(sink, boxes, face, edge);
}

}  // namespace impinge
