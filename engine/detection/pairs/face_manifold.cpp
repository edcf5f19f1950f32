#include "engine/detection/pairs/face_manifold.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

/// A corner of the clipped polygon. `edge` is where the polygon's side from this corner to the next lies: an edge of
/// the incident box (>= 0) or, below zero, ~p on side plane p of the reference face.
struct CutCorner {
  Vec3 point;
  int vertex = -1;   ///< of the incident box, if the corner is one
  int crossed = -1;  ///< side plane of the reference face that cut the incident edge `cut_edge` here
  int cut_edge = -1;
  int edge = 0;
};

/// A clipped polygon has at most eight corners; a small array of our own keeps a stack of boxes free of allocations.
struct Polygon {
  std::array<CutCorner, 12> corner;
  int count = 0;
  void push(const CutCorner& c) { corner[count++] = c; }
};

/// The part of the polygon with normal·x <= offset (Sutherland-Hodgman), the side plane's number going into the labels.
Polygon clip_side(const Polygon& polygon, const Vec3& normal, double offset, int plane) {
  Polygon result;
  for (int i = 0; i < polygon.count; ++i) {
    const CutCorner& from = polygon.corner[i];
    const CutCorner& to = polygon.corner[(i + 1) % polygon.count];
    const double d0 = normal.dot(from.point) - offset, d1 = normal.dot(to.point) - offset;
    if (d0 <= 0.0) {
      result.push(from);
      if (d1 <= 0.0) continue;
    } else if (d1 > 0.0) {
      continue;
    }
    CutCorner cut;
    cut.point = from.point + (d0 / (d0 - d1)) * (to.point - from.point);
    cut.crossed = plane;
    cut.cut_edge = from.edge;
    // leaving: the new side runs along the plane; entering: along what is left of the old side
    cut.edge = d0 <= 0.0 ? ~plane : from.edge;
    if (result.count < 12) result.push(cut);
  }
  return result;
}

}  // namespace

void add_face_manifold(ContactSink& sink, const OrientedBox& reference, const OrientedBox& incident, int axis,
                       const Vec3& outward, bool reference_is_first, bool overlapping) {
  const int side = reference.axes.col(axis).dot(outward) < 0.0 ? 0 : 1;
  const double face_offset = outward.dot(reference.center) + reference.half[axis];
  const int reference_face = 2 * axis + side;

  int inc_axis = 0;
  double most = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double along = std::abs(incident.axes.col(k).dot(outward));
    if (along > most + 1e-9) {
      most = along;
      inc_axis = k;
    }
  }
  const int inc_side = incident.axes.col(inc_axis).dot(outward) > 0.0 ? 0 : 1;
  const int incident_face = 2 * inc_axis + inc_side;

  // the incident face, its corners in cyclic order
  const int u = (inc_axis + 1) % 3, v = (inc_axis + 2) % 3;
  const int base = inc_side << inc_axis;
  const int cycle[4] = {base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v};
  Polygon polygon;
  for (int i = 0; i < 4; ++i) {
    CutCorner c;
    c.point = incident.corner(cycle[i]);
    c.vertex = cycle[i];
    c.edge = OrientedBox::edge_of(i % 2 == 0 ? u : v, cycle[i]);
    polygon.push(c);
  }

  // side plane 2k + s: the side s of reference axis k
  const int ru = (axis + 1) % 3, rv = (axis + 2) % 3;
  for (int k : {ru, rv})
    for (int s = 0; s < 2 && polygon.count > 0; ++s) {
      const Vec3 normal = s == 0 ? Vec3(-reference.axes.col(k)) : Vec3(reference.axes.col(k));
      polygon = clip_side(polygon, normal, normal.dot(reference.center) + reference.half[k], 2 * k + s);
    }

  // when the boxes overlap beside the clipped face, its deepest corner stands for the overlap
  CutCorner deepest;
  double lowest = 0.0;
  for (int i : cycle) {
    const double height = outward.dot(incident.corner(i)) - face_offset;
    if (deepest.vertex >= 0 && height >= lowest) continue;
    lowest = height;
    deepest.vertex = i;
    deepest.point = incident.corner(i);
  }
  bool covered = false;
  for (int i = 0; i < polygon.count; ++i) covered = covered || outward.dot(polygon.corner[i].point) <= face_offset;
  if (overlapping && !covered) polygon.push(deepest);

  // corners closer than this are one: 1e-4 of the smaller face, far above rounding and far below what a contact's
  // place matters to its torque
  const double merge =
      1e-4 * std::min(std::min(reference.half[ru], reference.half[rv]), std::min(incident.half[u], incident.half[v]));
  struct Found {
    Candidate candidate;
    double height;
  };
  std::array<Found, 12> found;
  int count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const CutCorner& corner = polygon.corner[i];
    const double height = outward.dot(corner.point) - face_offset;
    const Vec3 foot = corner.point - height * outward;
    int inc_vertex = -1, ref_vertex = -1;
    for (int k : cycle)
      if ((incident.corner(k) - corner.point).norm() <= merge) inc_vertex = k;
    if (corner.vertex >= 0) inc_vertex = corner.vertex;
    for (int k = 0; k < 8; ++k)
      if ((k >> axis & 1) == side && (reference.corner(k) - foot).norm() <= merge) ref_vertex = k;

    Feature inc_kind = Feature::face, ref_kind = Feature::face;
    int inc_index = incident_face, ref_index = reference_face;
    if (inc_vertex >= 0) {
      inc_kind = Feature::vertex;
      inc_index = inc_vertex;
    }
    if (ref_vertex >= 0) {
      ref_kind = Feature::vertex;
      ref_index = ref_vertex;
    }
    if (inc_vertex < 0 && ref_vertex < 0) {
      if (corner.cut_edge >= 0) {
        // the reference edge that this side plane and the face share runs along the third axis
        const int plane_axis = corner.crossed / 2, along = 3 - axis - plane_axis;
        inc_kind = ref_kind = Feature::edge;
        inc_index = corner.cut_edge;
        ref_index = OrientedBox::edge_of(along, side << axis | (corner.crossed & 1) << plane_axis);
      } else if (corner.crossed >= 0) {
        // two side planes meet: a corner of the reference face above the incident face
        const int other = ~corner.cut_edge;
        ref_kind = Feature::vertex;
        ref_index = side << axis | (corner.crossed & 1) << (corner.crossed / 2) | (other & 1) << (other / 2);
      }
    }

    Candidate c;
    c.normal = reference_is_first ? Vec3(-outward) : outward;
    c.point_first = reference_is_first ? foot : corner.point;
    c.point_second = reference_is_first ? corner.point : foot;
    c.owner = reference_is_first ? NormalOwner::first : NormalOwner::second;
    c.kind_first = reference_is_first ? ref_kind : inc_kind;
    c.index_first = reference_is_first ? ref_index : inc_index;
    c.kind_second = reference_is_first ? inc_kind : ref_kind;
    c.index_second = reference_is_first ? inc_index : ref_index;

    int same = -1;
    for (int j = 0; j < count && same < 0; ++j) {
      const Candidate& o = found[j].candidate;
      const bool one_key = o.kind_first == c.kind_first && o.index_first == c.index_first &&
                           o.kind_second == c.kind_second && o.index_second == c.index_second;
      if (one_key || (o.point_first - c.point_first).norm() <= merge) same = j;
    }
    if (same < 0)
      found[count++] = {c, height};
    else if (height < found[same].height)
      found[same] = {c, height};
  }
  for (int i = 0; i < count; ++i) sink.add_new(found[i].candidate);
}

}  // namespace impinge
