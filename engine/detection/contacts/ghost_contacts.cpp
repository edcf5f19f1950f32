#include "engine/detection/contacts/ghost_contacts.hpp"

#include <algorithm>
#include <optional>

#include "engine/detection/contacts/surface_view.hpp"
#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

/// Of the smaller body's size: what is this far below a face is level with it.
constexpr double kLevel = 1e-5;
constexpr double kLittle = 0.1;    // of that: what closes by more than a gap, or than by weight, within it is rounding
constexpr double kRoughly = 0.1;   // of the activation distance: the same where answers are rough
constexpr int kFaces = 1 << 22;    // numbers of the faces of polyhedra that contacts are turned to
constexpr double kTurns = 0.9999;  // cosine: a face that looks the same way as the contact is no other plane

constexpr double kSameNormal = 1.0 - 1e-9;  // cosine
constexpr int kNoBody = -1;                 // a surface is asked for places only

/// A face of one body, in the world.
struct FacePlane {
  Vec3 normal, point;
  int number = 0;     // unique on the body
  int triangle = -1;  // of a mesh
  double height(const Vec3& x) const { return normal.dot(x - point); }
};

/// The triangles round those that meet a triangle's corners, of a mesh.
std::vector<int> triangles_beside(const SurfaceView& view, int triangle) {
  std::vector<int> all;
  for (const int v : view.triangle(triangle))
    for (const int t : view.triangles_round(v)) all.push_back(t);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Of the material at x; `triangle` holds it on a mesh.
Vec3 velocity_of(const Collider& c, const Vec3& x, int triangle) {
  return c.vertex_velocities.empty() || triangle < 0 ? c.velocity_at(x)
                                                     : SurfaceView(c, kNoBody).velocity_at(triangle, x);
}

/// One body of the pair, round one contact.
class Side {
 public:
  Side(const Collider& collider, int triangle, double level) : collider_(collider), level_(level) {
    const ConvexSet* const* set = std::get_if<const ConvexSet*>(&form_);
    if (set != nullptr) set_ = *set, solid_ = set_->polyhedron();
    is_mesh_ = set == nullptr && triangle >= 0;
    if (is_mesh_) beside_ = triangles_beside(SurfaceView(collider, kNoBody), triangle);
  }

  /// Faces that look away from `normal`'s and have the body behind them, with the place above or level.
  std::vector<FacePlane> faces_below(const Vec3& x, const Vec3& normal, const Vec3& sunk) const {
    std::vector<FacePlane> found;
    const auto look = [&](const FacePlane& face) {
      if (face.normal.dot(normal) <= kTurns && face.height(x) >= -level_ - std::abs(face.normal.dot(sunk)))
        found.push_back(face);
    };
    if (solid_ != nullptr) {
      const Pose& pose = collider_.pose;
      for (std::size_t k = 0; k < solid_->faces().size(); ++k) {
        const ConvexPolyhedron::Face& face = solid_->faces()[k];
        const Vec3 n = pose.rotation * face.normal;
        look({n, pose.position + face.offset * n, kFaces + static_cast<int>(k)});
      }
    } else if (set_ != nullptr && set_->is_round_about_y()) {
      const Pose& pose = collider_.pose;
      for (const double side : {-1.0, 1.0}) {
        const ContactFace end = set_->facing(side * Vec3::UnitY());
        if (end.count > 2) look({pose.rotation * end.normal, pose.apply(end.point[0]), kFaces + end.face});
      }
    } else if (is_mesh_) {
      const SurfaceView view(collider_, kNoBody);
      for (const int t : beside_)
        if (const Vec3 n = view.face_normal(t); !n.isZero(0.0)) look({n, view.corners(t)[0], t, t});
      std::erase_if(found, [&](const FacePlane& face) { return !is_behind(face); });
    }
    return found;
  }

  /// The least height over a face of the other body, now and after the time step.
  struct Heights {
    double now = INFINITY, end = INFINITY;
  };
  Heights over(const FacePlane& face, const Side& owner, double time_step) const {
    Heights least;
    const auto look = [&](const Vec3& x, const Vec3& velocity) {
      const double now = face.height(x);
      const double closing = face.normal.dot(velocity - velocity_of(owner.collider_, x, face.triangle));
      least.now = std::min(least.now, now), least.end = std::min(least.end, now + time_step * closing);
    };
    const auto look_rigid = [&](const Vec3& x) { look(x, collider_.velocity_at(x)); };
    const Pose& pose = collider_.pose;
    if (solid_ != nullptr) {
      for (const Vec3& v : solid_->vertices()) look_rigid(pose.apply(v));
    } else if (set_ != nullptr) {
      look_rigid(pose.apply(set_->support(pose.rotation.transpose() * -face.normal)) - set_->rounding() * face.normal);
    } else if (is_mesh_) {
      const SurfaceView view(collider_, kNoBody);
      for (const int t : beside_)
        for (const int v : view.triangle(t)) look(view.vertex(v), view.vertex_velocity(v));
    }
    return least;
  }

 private:
  bool is_behind(const FacePlane& face) const {
    const SurfaceView view(collider_, kNoBody);
    return std::all_of(beside_.begin(), beside_.end(), [&](int t) {
      const TriangleCorners c = view.corners(t);
      return std::all_of(c.begin(), c.end(), [&](const Vec3& x) { return face.height(x) <= level_; });
    });
  }

  const Collider& collider_;
  const double level_;
  const ShapeForm form_ = collider_.shape->form();
  const ConvexSet* set_ = nullptr;
  const ConvexPolyhedron* solid_ = nullptr;
  bool is_mesh_ = false;
  std::vector<int> beside_;
};

class GhostPass {
 public:
  GhostPass(std::span<const Collider> colliders, const BodyPair& pair, const GhostQuery& query)
      : a_(colliders[pair.a]), b_(colliders[pair.b]), pair_(pair), query_(query) {
    level_ = kLevel * std::min(a_.size, b_.size);
    rounding_ = kLittle * level_;
    if (query.is_rough) level_ = std::max(level_, kRoughly * query.activation);
    const bool deforms = !a_.vertex_velocities.empty() || !b_.vertex_velocities.empty();
    give_ = deforms ? query.activation : level_;
  }

  void run(std::size_t begin, std::vector<Collision>& contacts) {
    std::size_t end = begin;
    turned_.clear();
    for (std::size_t i = begin; i < contacts.size(); ++i) {
      const Collision& c = contacts[i];
      if (!turns(c)) contacts[end++] = c;
    }
    contacts.resize(end);
    for (const Collision& c : turned_) {
      const auto is_known = [&](const Collision& k) {
        return k.feature == c.feature ||
               (k.normal.dot(c.normal) > kSameNormal && (k.point_a - c.point_a).norm() <= level_ &&
                (k.point_b - c.point_b).norm() <= level_);
      };
      if (std::none_of(contacts.begin() + static_cast<std::ptrdiff_t>(begin), contacts.end(), is_known))
        contacts.push_back(c);
    }
  }

 private:
  struct Way {
    FacePlane face;
    double end = -INFINITY;
    bool of_a = false;
  };

  /// Whether the contact is none; what takes its place is in turned_.
  bool turns(const Collision& c) {
    const bool overlaps = c.gap < -level_;
    if (overlaps && !features_of_key(c.feature).is(Feature::edge, Feature::edge)) return false;
    const Vec3 relative = velocity_of(a_, c.point_a, c.triangle_a) - velocity_of(b_, c.point_b, c.triangle_b);
    const double closing = -query_.time_step * c.normal.dot(relative);
    const double closes_within = query_.is_rough ? 0.0 : c.gap;
    if (!overlaps && !(closing > closes_within + rounding_)) return false;
    if (!overlaps && std::abs(closing - by_weight(c.normal)) <= rounding_) return false;
    const Side a(a_, c.triangle_a, level_), b(b_, c.triangle_b, level_);
    std::optional<Way> best;
    const auto look = [&](const Side& owner, const Side& other, const Vec3& place, const Vec3& normal, bool of_a) {
      for (const FacePlane& face : owner.faces_below(place, normal, query_.sunk)) {
        const Side::Heights h = other.over(face, owner, query_.time_step);
        if (h.now < -level_ - std::abs(face.normal.dot(query_.sunk)) || (best && h.end <= best->end)) continue;
        if (!overlaps && (h.end < -give_ - by_weight(face.normal) || h.now - h.end >= closing)) continue;
        best = Way{face, h.end, of_a};
      }
    };
    look(b, a, c.point_a, c.normal, false);
    look(a, b, c.point_b, -c.normal, true);
    if (best) add(c, *best);
    return best.has_value();
  }

  /// How far weight alone may have been what closes along a direction, metres.
  double by_weight(const Vec3& normal) const { return std::abs(normal.dot(query_.fall)); }

  void add(const Collision& c, const Way& way) {
    Collision turned = c;
    const FacePlane& face = way.face;
    const Vec3& place = way.of_a ? c.point_b : c.point_a;
    const double gap = face.height(place);
    const TriangleIndex t = way.of_a ? c.triangle_b : c.triangle_a;
    const Collider &owner = way.of_a ? a_ : b_, &other = way.of_a ? b_ : a_;
    const double closing = face.normal.dot(velocity_of(other, place, t) - velocity_of(owner, place, face.triangle));
    if (gap > query_.activation && gap + query_.time_step * closing > 0.0) return;
    turned.gap = gap;
    turned.normal = way.of_a ? Vec3(-face.normal) : face.normal;
    const Vec3 foot = place - gap * face.normal;
    const FeaturePair f = features_of_key(c.feature);
    if (way.of_a) {
      turned.point_a = foot;
      turned.normal_owner = pair_.a;
      if (face.triangle >= 0) turned.triangle_a = TriangleIndex(face.triangle);
      turned.feature = feature_key(Feature::face, face.number, f.kind_b, f.index_b);
    } else {
      turned.point_b = foot;
      turned.normal_owner = pair_.b;
      if (face.triangle >= 0) turned.triangle_b = TriangleIndex(face.triangle);
      turned.feature = feature_key(f.kind_a, f.index_a, Feature::face, face.number);
    }
    turned_.push_back(turned);
  }

  const Collider &a_, &b_;
  const BodyPair pair_;
  const GhostQuery query_;
  double level_ = 0.0, rounding_ = 0.0;  // metres
  double give_ = 0.0;  ///< metres; how far below a face what keeps above it may come: what deforms swings a little
  std::vector<Collision> turned_;
};

}  // namespace

void turn_ghost_contacts(std::span<const Collider> colliders, const BodyPair& pair, const GhostQuery& query,
                         std::size_t begin, std::vector<Collision>& contacts) {
  if (pair.a == pair.b || begin == contacts.size()) return;
  for (const BodyIndex b : {pair.a, pair.b})
    if (colliders[b].shape->as<Plane>() != nullptr) return;
  GhostPass(colliders, pair, query).run(begin, contacts);
}

}  // namespace impinge
