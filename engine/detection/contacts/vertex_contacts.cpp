// Proximity contacts of vertices: the local minima of the distance from a vertex of one body to the surface of the
// other.
#include <algorithm>
#include <cmath>

#include "engine/core/interrupt.hpp"
#include "engine/detection/contacts/proximity_parts.hpp"
#include "engine/geometry/triangle_intersection.hpp"

namespace impinge {
namespace {

// an edge of the vertex that runs more steeply towards the other surface than this (a sine) makes its contact redundant
constexpr double kSteep = 0.5;
// the same at a sharp edge or corner: bounds the tilt of the normal against the surfaces
constexpr double kSteepAtSharp = 1e-3;

// a place on the other surface that may be closest to the vertex
struct Nearest {
  SurfaceFeature feature;
  int triangle = -1;  // a candidate it was found on
  Vec3 point = Vec3::Zero();
  double distance = 0.0;
};

// all contacts of the vertices of `own` against the surface of `other`, as if own were body a
class VertexPass {
 public:
  VertexPass(const ProximityQuery& query, const SurfaceView& own, const SurfaceView& other, bool own_is_a)
      : query_(query), own_(own), other_(other), own_is_a_(own_is_a) {}

  void run(std::vector<Collision>& contacts) {
    std::vector<std::uint64_t> keys;  // vertex of own, triangle of other
    keys.reserve(3 * query_.triangles.size());
    for (const TrianglePair& pair : query_.triangles) {
      const int t_own = own_is_a_ ? pair.triangle_a : pair.triangle_b,
                t_other = own_is_a_ ? pair.triangle_b : pair.triangle_a;
      for (int v : own_.triangle(t_own))
        keys.push_back(static_cast<std::uint64_t>(v) << 32 | static_cast<std::uint32_t>(t_other));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    InterruptPoll poll;
    for (std::size_t i = 0; i < keys.size();) {
      poll();
      triangles_.clear();
      const int v = static_cast<int>(keys[i] >> 32);
      for (; i < keys.size() && static_cast<int>(keys[i] >> 32) == v; ++i)
        triangles_.push_back(static_cast<int>(keys[i] & 0xffffffffu));
      visit(v, contacts);
    }
  }

 private:
  void visit(int v, std::vector<Collision>& contacts) {
    const Vec3& x = own_.vertex(v);
    nearest_.clear();
    for (int t : triangles_) {
      const PointTriangle p = closest_on_triangle(x, other_.corners(t));
      if (!(p.squared_distance <= query_.margin * query_.margin)) continue;
      const SurfaceFeature feature = other_.feature(t, p.feature);
      const auto is_known = [&](const Nearest& n) { return n.feature == feature; };
      if (std::none_of(nearest_.begin(), nearest_.end(), is_known))
        nearest_.push_back({feature, t, p.point, std::sqrt(p.squared_distance)});
    }
    if (nearest_.empty()) return;
    own_.star({Feature::vertex, v}, own_star_);
    kept_.clear();
    // by distance; of equals (a fold seen from its bisector) the one found first, that is on the smaller triangle
    std::stable_sort(nearest_.begin(), nearest_.end(),
                     [](const Nearest& l, const Nearest& r) { return l.distance < r.distance; });
    const Nearest& closest = nearest_.front();
    if (closest.distance <= query_.touch && (add_touching(v) || add_hollow(v))) {
      // decided by the features that touch
    } else if ((x - closest.point).dot(other_.normal(closest.feature)) < 0.0) {
      add_inside(v);
    } else {
      for (const Nearest& n : nearest_)
        if (is_minimum(x, n)) add_outside(v, n);
      // flush with a side that is no way out for it: it may be behind another
      if (kept_.empty() && closest.distance <= query_.touch) add_inside(v);
    }
    if (query_.time_step > 0.0) add_predicted(v);
    for (const Collision& c : kept_) contacts.push_back(own_is_a_ ? c : exchanged(c));
  }

  // a vertex on a sharp edge or corner of the other body, whichever side rounding has put it on; false if it is none
  bool add_touching(int v) {
    SurfaceFeature sharpest{Feature::shape, -1};
    for (const Nearest& n : nearest_) {
      if (n.distance > query_.touch) break;
      const SurfaceFeature f = snapped(n);
      if (f.kind < sharpest.kind || (f.kind == sharpest.kind && f.index < sharpest.index)) sharpest = f;
    }
    if (sharpest.kind == Feature::face || is_flat(sharpest)) return false;
    const auto [n, slope] = separating_direction(own_, {Feature::vertex, v}, other_, sharpest);
    if (slope < -0.1) return false;  // a concave fold, or bodies that overlap
    Vec3 point;
    if (sharpest.kind == Feature::vertex) {
      point = other_.vertex(sharpest.index);
    } else {
      const MeshTopology::Edge& e = other_.edge(sharpest.index);
      point = closest_on_segment(own_.vertex(v), other_.vertex(e.v0), other_.vertex(e.v1)).point;
    }
    keep(v, sharpest, other_.triangle_of(sharpest), point, n, false);
    return true;
  }

  // a vertex in a fold that is hollow, where rounding chooses the face that is nearest, and the mean normal of an edge would
  // hold it off neither: one contact a side; false if it is in none
  bool add_hollow(int v) {
    const Vec3& x = own_.vertex(v);
    touched_.clear(), normals_.clear();
    for (const int t : triangles_) {
      const Vec3 n = other_.face_normal(t);
      if (n.isZero(0.0) || closest_on_triangle(x, other_.corners(t)).squared_distance > query_.touch * query_.touch)
        continue;
      touched_.push_back(t), normals_.push_back(n);
    }
    const auto is_same_side = [&](const Vec3& n) { return n.dot(normals_[0]) > kSameSide; };
    if (std::all_of(normals_.begin(), normals_.end(), is_same_side)) return false;
    for (const Vec3& n : normals_)
      for (const int t : touched_)
        for (const Vec3& corner : other_.corners(t))
          if (n.dot(corner - x) < -2.0 * query_.touch) return false;
    for (std::size_t i = 0; i < touched_.size(); ++i)
      if (!falls_steeply(normals_[i], kSteep) && !goes_on_below(v, normals_[i]))
        keep(v, {Feature::face, touched_[i]}, touched_[i], closest_on_triangle(x, other_.corners(touched_[i])).point,
             normals_[i], true);
    return !kept_.empty();
  }

  // the corner or edge of the triangle that lies within touching distance of the point, if there is one
  SurfaceFeature snapped(const Nearest& n) const {
    const Triangle& corners = other_.triangle(n.triangle);
    for (int v : corners)
      if ((other_.vertex(v) - n.point).norm() <= query_.touch) return {Feature::vertex, v};
    for (int k = 0; k < 3; ++k) {
      const PointSegment s =
          closest_on_segment(n.point, other_.vertex(corners[k]), other_.vertex(corners[(k + 1) % 3]));
      if (s.squared_distance <= query_.touch * query_.touch)
        return {Feature::edge, other_.triangle_edges(n.triangle)[k]};
    }
    return n.feature;
  }

  bool is_flat(const SurfaceFeature& f) {
    other_.adjacent_normals(f, normals_);
    for (const Vec3& n : normals_)
      if (n.dot(normals_[0]) < 1.0 - 1e-9) return false;
    return true;
  }

  // whether no nearby point of the other surface is closer, and the vertex is in front of it
  bool is_minimum(const Vec3& x, const Nearest& n) {
    if (lies_on_joint(n)) return true;
    const Vec3 r = x - n.point;
    if (n.feature.kind != Feature::face) {
      other_.star(n.feature, star_);
      for (const Vec3& e : star_)
        if (r.dot(e) > 1e-9 * n.distance) return false;
    }
    return r.dot(other_.normal(n.feature)) >= 0.0;
  }

  // on an edge or a corner that is no ridge (add_touching), as the diagonal of a face: the way there is rounding, and says
  // neither what is nearer nor which side the vertex is on
  bool lies_on_joint(const Nearest& n) const { return n.distance <= query_.touch && n.feature.kind != Feature::face; }

  void add_outside(int v, const Nearest& n) {
    const Vec3 normal =
        n.distance > query_.touch ? Vec3((own_.vertex(v) - n.point) / n.distance) : other_.normal(n.feature);
    bool is_smooth = true;
    other_.adjacent_normals(n.feature, normals_);
    for (const Vec3& m : normals_) is_smooth = is_smooth && m.dot(normal) > kSameSide;
    if (falls_steeply(normal, is_smooth ? kSteep : kSteepAtSharp) || goes_on_below(v, normal)) return;
    const double approach = closing_speed(v, n.triangle, n.point, normal);
    const double after = n.distance + query_.time_step * approach;
    if (n.distance > query_.activation) return;                                    // left to the prediction
    if (!is_smooth && after < 0.0 && !sweeps_within(v, 0.5 * n.distance)) return;  // it passes the corner by
    keep(v, n.feature, other_.triangle_of(n.feature), n.point, normal, is_smooth);
  }

  // the nearest place where the vertex can leave: where its own edges don't run deeper. (A corner of a box that has
  // sunk into another near its rim leaves through the top, though the side may be nearer.)
  void add_inside(int v) {
    const Vec3& x = own_.vertex(v);
    const Nearest& closest = nearest_.front();
    Vec3 normal = other_.normal(closest.feature);
    if ((x - closest.point).dot(normal) < 0.0) {
      if (closest.distance > query_.touch) normal = (closest.point - x) / closest.distance;
      if (!falls_steeply(normal, kSteep)) {
        keep(v, closest.feature, other_.triangle_of(closest.feature), closest.point, normal,
             closest.feature.kind == Feature::face);
        return;
      }
    }
    double least = query_.margin;
    int best = -1;
    Vec3 point = Vec3::Zero();
    for (int t : triangles_) {
      const TriangleCorners c = other_.corners(t);
      const Vec3 n = other_.face_normal(t);
      const double depth = n.dot(c[0] - x);
      if (!(depth > 0.0 && depth < least) || falls_steeply(n, kSteep)) continue;
      const PointTriangle foot = closest_on_triangle(x + depth * n, c);
      if (foot.squared_distance > query_.touch * query_.touch) continue;
      least = depth;
      best = t;
      point = foot.point;
      normal = n;
    }
    if (best >= 0) keep(v, {Feature::face, best}, best, point, normal, true);
  }

  // a face that the vertex, not yet within the activation distance, would run through in this sub-step
  void add_predicted(int v) {
    const Vec3& x = own_.vertex(v);
    int hit_triangle = -1;
    double first = 1.0;
    Vec3 hit = Vec3::Zero(), hit_normal = Vec3::Zero();
    for (int t : triangles_) {
      const Vec3 n = other_.face_normal(t);
      const double height = n.dot(x - other_.vertex(other_.triangle(t)[0]));
      if (n.isZero(0.0) || !(height > query_.activation)) continue;
      const Vec3 path = query_.time_step * (own_.vertex_velocity(v) - other_.velocity_at(t, x));
      const double falls = -n.dot(path);
      if (!(falls > height) || !(height / falls < first)) continue;
      const Vec3 there = x + (height / falls) * path;
      const PointTriangle p = closest_on_triangle(there, other_.corners(t));
      if (p.squared_distance > query_.activation * query_.activation) continue;  // it passes the triangle by
      first = height / falls;
      hit_triangle = t;
      hit = p.point;
      hit_normal = n;
    }
    if (hit_triangle < 0 || falls_steeply(hit_normal, kSteep) || goes_on_below(v, hit_normal)) return;
    keep(v, {Feature::face, hit_triangle}, hit_triangle, hit, hit_normal, true);
  }

  bool falls_steeply(const Vec3& normal, double limit) const {
    for (const Vec3& e : own_star_)
      if (e.dot(normal) < -limit) return true;
    return false;
  }

  // Whether a face of vertex v goes straight down against the normal, though all edges there may run across it: a floor
  // goes on below whatever slides over it. Folds of one surface keep every contact they have.
  bool goes_on_below(int v, const Vec3& normal) const {
    if (own_.body() == other_.body()) return false;
    for (const int t : own_.triangles_round(v)) {
      const Vec3 n = own_.face_normal(t), down = normal.dot(n) * n - normal;
      if (down.norm() <= kSteep) continue;
      const Triangle& corners = own_.triangle(t);
      const int k = corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
      const Vec3 &x = own_.vertex(v), next = own_.vertex(corners[(k + 1) % 3]) - x,
                 last = own_.vertex(corners[(k + 2) % 3]) - x;
      if (n.dot(next.cross(down)) > 0.0 && n.dot(down.cross(last)) > 0.0) return true;
    }
    return false;
  }

  double closing_speed(int v, int t, const Vec3& point, const Vec3& normal) const {
    return normal.dot(own_.vertex_velocity(v) - other_.velocity_at(t, point));
  }

  // whether the vertex comes within `distance` of the other surface on its way through the sub-step
  bool sweeps_within(int v, double distance) const {
    const Vec3& x = own_.vertex(v);
    for (int t : triangles_) {
      const Vec3 end = x + query_.time_step * (own_.vertex_velocity(v) - other_.velocity_at(t, x));
      const TriangleCorners c = other_.corners(t);
      const std::optional<RayHit> hit = intersect_line(x, end - x, c);
      if (hit && hit->t >= 0.0 && hit->t <= 1.0) return true;
      if (closest_on_triangle(end, c).squared_distance <= distance * distance) return true;
      for (int k = 0; k < 3; ++k)
        if (closest_between_segments(x, end, c[k], c[(k + 1) % 3]).squared_distance <= distance * distance) return true;
    }
    return false;
  }

  // the contact, unless the vertex has one on this side already
  void keep(int v, const SurfaceFeature& feature, int triangle, const Vec3& point, const Vec3& normal, bool is_owned) {
    for (const Collision& c : kept_)
      if (c.normal.dot(normal) > kSameSide) return;
    Collision c;
    c.body_a = BodyIndex(own_.body());
    c.body_b = BodyIndex(other_.body());
    c.triangle_a = TriangleIndex(own_.triangles_round(v)[0]);
    c.triangle_b = TriangleIndex(triangle);
    c.point_a = own_.vertex(v);
    c.point_b = point;
    c.normal = normal;
    c.gap = normal.dot(c.point_a - c.point_b);
    if (is_owned) c.normal_owner = BodyIndex(other_.body());
    c.feature = feature_key(Feature::vertex, v, feature.kind, feature.index);
    kept_.push_back(c);
  }

  const ProximityQuery& query_;
  const SurfaceView &own_, &other_;
  const bool own_is_a_;
  std::vector<int> triangles_;  // of the other body, round the vertex at hand
  std::vector<int> touched_;    // those of them that it touches
  std::vector<Nearest> nearest_;
  std::vector<Vec3> own_star_, star_, normals_;
  std::vector<Collision> kept_;  // contacts of the vertex at hand
};

}  // namespace

void append_vertex_contacts(const ProximityQuery& query, std::vector<Collision>& contacts) {
  VertexPass(query, query.a, query.b, true).run(contacts);
  VertexPass(query, query.b, query.a, false).run(contacts);
}

}  // namespace impinge
