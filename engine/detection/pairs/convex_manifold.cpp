#include "engine/detection/pairs/convex_manifold.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace impinge {
namespace {

constexpr double kNearlyParallel = 0.05;     // sine: lines closer to parallel than this are held at both ends
constexpr double kMerge = 1e-4;              // of the smaller face: corners closer than this are one
constexpr double kSameNormal = 1.0 - 1e-12;  // cosine: the way out is a face's normal
constexpr double kTie = 1e-9;                // of the size: gaps closer than this are equal

/// A corner of a clipped face. `edge` is where the side from it to the next lies: a side of the incident face (>= 0)
/// or, below zero, ~p along side p of the reference face.
struct Corner {
  Vec3 point;
  int vertex = -1;   ///< place in the incident face, if the corner is one of its
  int crossed = -1;  ///< side of the reference face that cut the incident side `cut` here
  int cut = 0;
  int edge = 0;
};

/// The part of a ring, or of the line between two corners, with normal·x <= offset; the side's number goes into the
/// labels. [SutherlandHodgman74]
std::vector<Corner> clip(const std::vector<Corner>& ring, const Vec3& normal, double offset, int side) {
  std::vector<Corner> result;
  const bool is_line = ring.size() == 2;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Corner &from = ring[i], &to = ring[(i + 1) % ring.size()];
    const double d0 = normal.dot(from.point) - offset, d1 = normal.dot(to.point) - offset;
    if (d0 <= 0.0) result.push_back(from);
    if ((d0 <= 0.0) == (d1 <= 0.0) || (is_line && i == 1)) continue;
    Corner cut;
    cut.point = from.point + (d0 / (d0 - d1)) * (to.point - from.point);
    cut.crossed = side;
    cut.cut = from.edge;
    // leaving: the new side runs along the reference's; entering: along what is left of the old one
    cut.edge = d0 <= 0.0 ? ~side : from.edge;
    result.push_back(cut);
  }
  return result;
}

double extent_of(const ContactFace& face) {
  double least = 1e300;
  for (int i = 0; i < face.count; ++i)
    least = std::min(least, (face.point[(i + 1) % face.count] - face.point[i]).norm());
  return least;
}

/// The face of one solid clipped by the sides of the other's, each point with its height above that one.
class FaceManifold {
 public:
  FaceManifold(const ContactFace& reference, const ContactFace& incident, bool reference_is_first)
      : reference_(reference), incident_(incident), reference_is_first_(reference_is_first) {}

  std::vector<Candidate> run() {
    std::vector<Corner> ring;
    for (int i = 0; i < incident_.count; ++i) {
      Corner c;
      c.point = incident_.point[i];
      c.vertex = i;
      c.edge = i;
      ring.push_back(c);
    }
    for (int k = 0; k < reference_.count && !ring.empty(); ++k) {
      const Vec3& from = reference_.point[k];
      const Vec3 out = (reference_.point[(k + 1) % reference_.count] - from).cross(reference_.normal).normalized();
      ring = clip(ring, out, out.dot(from), k);
    }
    merge_ = kMerge * std::min(extent_of(reference_), extent_of(incident_));
    for (const Corner& c : ring) add(c);
    std::vector<Candidate> result;
    for (const auto& [candidate, height] : found_) result.push_back(candidate);
    return result;
  }

 private:
  void add(const Corner& corner) {
    const double height = reference_.normal.dot(corner.point - reference_.point[0]);
    const Vec3 foot = corner.point - height * reference_.normal;
    int incident_vertex = corner.vertex, reference_vertex = -1;
    for (int k = 0; k < incident_.count && incident_vertex < 0; ++k)
      if ((incident_.point[k] - corner.point).norm() <= merge_) incident_vertex = k;
    for (int k = 0; k < reference_.count && reference_vertex < 0; ++k)
      if ((reference_.point[k] - foot).norm() <= merge_) reference_vertex = k;
    Feature incident_kind = Feature::face, reference_kind = Feature::face;
    int incident_index = incident_.face, reference_index = reference_.face;
    if (incident_vertex >= 0) incident_kind = Feature::vertex, incident_index = incident_.vertex[incident_vertex];
    if (reference_vertex < 0 && incident_vertex < 0) {
      if (corner.cut >= 0) {
        incident_kind = reference_kind = Feature::edge;
        incident_index = incident_.edge[corner.cut];
        reference_index = reference_.edge[corner.crossed];
      } else {
        reference_vertex = shared_corner(corner.crossed, ~corner.cut);
      }
    }
    if (reference_vertex >= 0) reference_kind = Feature::vertex, reference_index = reference_.vertex[reference_vertex];

    Candidate c;
    const bool r = reference_is_first_;
    c.normal = r ? Vec3(-reference_.normal) : reference_.normal;
    c.point_first = r ? foot : corner.point;
    c.point_second = r ? corner.point : foot;
    c.owner = r ? NormalOwner::first : NormalOwner::second;
    c.kind_first = r ? reference_kind : incident_kind;
    c.index_first = r ? reference_index : incident_index;
    c.kind_second = r ? incident_kind : reference_kind;
    c.index_second = r ? incident_index : reference_index;
    for (auto& [known, known_height] : found_) {
      const bool one_key = known.kind_first == c.kind_first && known.index_first == c.index_first &&
                           known.kind_second == c.kind_second && known.index_second == c.index_second;
      if (!one_key && (known.point_first - c.point_first).norm() > merge_) continue;
      if (height < known_height) known = c, known_height = height;
      return;
    }
    found_.emplace_back(c, height);
  }

  /// The corner of the reference face where two of its sides meet; two that do not meet share none, and the first of
  /// them names the place.
  int shared_corner(int side, int other) const {
    if ((other + 1) % reference_.count == side) return side;
    return (side + 1) % reference_.count == other ? other : side;
  }

  const ContactFace &reference_, &incident_;
  bool reference_is_first_;
  double merge_ = 0.0;
  std::vector<std::pair<Candidate, double>> found_;
};

/// A straight part of what faces the other solid: its line, or the side of a steep face that runs across `direction`
/// (unit, the way the face faces) and is the lowest.
bool line_of(const ContactFace& face, const Vec3& direction, std::array<int, 2>& ends, int& number) {
  if (face.count < 2) return false;
  if (face.count == 2) {
    ends = {0, 1};
    number = face.edge[0];
    return true;
  }
  double farthest = -1e300;
  for (int i = 0; i < face.count; ++i) {
    const int j = (i + 1) % face.count;
    const Vec3 along = face.point[j] - face.point[i];
    if (std::abs(along.dot(direction)) > kNearlyParallel * along.norm()) continue;
    if (const double far = direction.dot(face.point[i] + face.point[j]); far > farthest) {
      farthest = far;
      ends = {i, j};
      number = face.edge[i];
    }
  }
  return farthest > -1e300;
}

/// Both ends of the common length of two lines that run side by side.
std::vector<Candidate> line_candidates(const ContactFace& first, const ContactFace& second, const Vec3& normal) {
  std::array<int, 2> ends_a{}, ends_b{};
  int line_a = 0, line_b = 0;
  if (!line_of(first, -normal, ends_a, line_a) || !line_of(second, normal, ends_b, line_b)) return {};
  const Vec3 &p = first.point[ends_a[0]], &q = second.point[ends_b[0]];
  const Vec3 u = first.point[ends_a[1]] - p, v = second.point[ends_b[1]] - q;
  if (u.cross(v).norm() > kNearlyParallel * u.norm() * v.norm()) return {};
  std::vector<Candidate> result;
  const double length = std::min(u.norm(), v.norm());
  for (int i = 0; i < 4; ++i) {
    const bool of_first = i < 2;
    const int place = i % 2;
    const Vec3& end = of_first ? first.point[ends_a[place]] : second.point[ends_b[place]];
    const Vec3 &start = of_first ? q : p, &along = of_first ? v : u;
    const double t = along.dot(end - start) / along.squaredNorm();
    if (t < -kMerge || t > 1.0 + kMerge) continue;
    const Vec3 other = start + std::clamp(t, 0.0, 1.0) * along;
    Candidate c;
    c.normal = normal;
    c.point_first = of_first ? end : other;
    c.point_second = of_first ? other : end;
    const int partner = t < kMerge ? 0 : t > 1.0 - kMerge ? 1 : -1;
    c.kind_first = of_first || partner >= 0 ? Feature::vertex : Feature::edge;
    c.index_first = of_first ? first.vertex[ends_a[place]] : partner >= 0 ? first.vertex[ends_a[partner]] : line_a;
    c.kind_second = !of_first || partner >= 0 ? Feature::vertex : Feature::edge;
    c.index_second = !of_first ? second.vertex[ends_b[place]] : partner >= 0 ? second.vertex[ends_b[partner]] : line_b;
    // ends that lie side by side are found from both
    const auto is_same = [&](const Candidate& k) { return (k.point_first - c.point_first).norm() <= kMerge * length; };
    if (std::none_of(result.begin(), result.end(), is_same)) result.push_back(c);
  }
  return result;
}

}  // namespace

ContactFace world_face(const ContactFace& face, const Pose& pose) {
  ContactFace result = face;
  for (int i = 0; i < face.count; ++i) result.point[i] = pose.apply(face.point[i]);
  result.normal = pose.rotation * face.normal;
  return result;
}

void reduce_candidates(std::vector<Candidate>& candidates, const Pose& pose, double tie) {
  if (candidates.size() <= kMostManifold) return;
  double lowest = 1e300;
  for (const Candidate& c : candidates) lowest = std::min(lowest, gap_of(c));
  const Vec3 u = pose.rotation * (pose.rotation.transpose() * candidates[0].normal).unitOrthogonal();
  const Vec3 v = candidates[0].normal.cross(u);
  std::vector<char> kept(candidates.size(), 0);
  int count = 0;
  for (int pass = 0; pass < 2; ++pass)
    for (int k = 0; k < kMostManifold && count < kMostManifold; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kMostManifold;
      const Vec3 direction = std::cos(angle) * u + std::sin(angle) * v;
      int best = -1;
      double farthest = -1e300;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const bool is_low = gap_of(candidates[i]) <= lowest + tie;
        if (is_low != (pass == 0)) continue;
        // strictly farther by more than rounding: of equals the first, in every step
        if (const double far = direction.dot(candidates[i].point_first); far > farthest + 0.1 * tie)
          farthest = far, best = static_cast<int>(i);
      }
      if (best < 0 || kept[best] != 0) continue;
      kept[best] = 1;
      ++count;
    }
  std::size_t end = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (kept[i] != 0) candidates[end++] = candidates[i];
  candidates.resize(end);
}

std::vector<Candidate> convex_candidates(const PlacedConvex& first, const PlacedConvex& second, double reach) {
  const ConvexGap gap = convex_gap(first, second, reach);
  if (!gap.is_within_reach) return {};
  const ContactFace face_a = world_face(first.set->facing(first.pose.rotation.transpose() * -gap.normal), first.pose);
  const ContactFace face_b = world_face(second.set->facing(second.pose.rotation.transpose() * gap.normal), second.pose);
  double size = (first.pose.position - second.pose.position).norm();
  for (const ContactFace* f : {&face_a, &face_b})
    for (int i = 1; i < f->count; ++i) size = std::max(size, (f->point[i] - f->point[0]).norm());

  const double facing_a = face_a.count > 2 ? -face_a.normal.dot(gap.normal) : -1.0;
  const double facing_b = face_b.count > 2 ? face_b.normal.dot(gap.normal) : -1.0;
  std::vector<Candidate> points;
  const bool is_face = std::max(facing_a, facing_b) > kNearlyFacing;
  if (is_face) {
    // equal within rounding: the first's, in every step
    const bool of_first = facing_a > facing_b - 1e-6;
    const ContactFace &reference = of_first ? face_a : face_b, &incident = of_first ? face_b : face_a;
    if (incident.count > 1) points = FaceManifold(reference, incident, of_first).run();
    // where edges cross, a face far below the crossing would push farther than the way out
    const double limit = 1.05 * gap.gap - std::min(reach, 0.01 * size) - kTie * size;
    if (gap.gap < 0.0) std::erase_if(points, [&](const Candidate& c) { return gap_of(c) < limit; });
    reduce_candidates(points, of_first ? first.pose : second.pose, 1e-6 * size);
  } else {
    points = line_candidates(face_a, face_b, gap.normal);
  }
  double lowest = 1e300;
  for (const Candidate& c : points)
    if (c.normal.dot(gap.normal) > 1.0 - 1e-9) lowest = std::min(lowest, gap_of(c));
  if (lowest <= gap.gap + kTie * size) return points;
  // what lies along an edge touches it with both ends of its line, though a face is near
  const std::vector<Candidate> line = is_face ? line_candidates(face_a, face_b, gap.normal) : std::vector<Candidate>();
  if (line.size() > 1 && std::all_of(line.begin(), line.end(), [&](const Candidate& c) {
        return std::abs(gap_of(c) - gap.gap) <= kTie * size;
      })) {
    points.insert(points.end(), line.begin(), line.end());
    return points;
  }
  Candidate own;
  own.normal = gap.normal;
  own.point_first = gap.point_a;
  own.point_second = gap.point_b;
  if (std::max(facing_a, facing_b) > kSameNormal)
    own.owner = facing_a >= facing_b ? NormalOwner::first : NormalOwner::second;
  // where two edges cross that touch there, the face beside one of them says nothing of the way out
  const double near = std::abs(gap.gap) + kMerge * size;
  std::erase_if(points, [&](const Candidate& c) {
    return c.normal.dot(gap.normal) < kSameWay && c.kind_first == Feature::edge && c.kind_second == Feature::edge &&
           ((c.point_first - own.point_first).norm() <= near || (c.point_second - own.point_second).norm() <= near);
  });
  points.push_back(own);
  return points;
}

}  // namespace impinge
