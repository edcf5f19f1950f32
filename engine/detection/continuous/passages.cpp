#include "engine/detection/continuous/passages.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/core/interrupt.hpp"
#include "engine/detection/continuous/stretch.hpp"
#include "engine/geometry/continuous.hpp"
#include "engine/geometry/distance.hpp"

namespace impinge {
namespace {

/// A point of a surface by what it hangs on, so that it can be asked for at any time.
struct Place {
  std::array<int, 3> vertex{-1, -1, -1};
  Vec3 weight = Vec3::Zero();
};

/// A triangle of a surface at both ends of an interval, metres.
struct MovingTriangle {
  MovingTriangle(const Stretch& of, int t) : index(t), corner(of.path().of->surface->mesh.triangles[t]) {
    for (int k : {0, 1})
      for (int i = 0; i < 3; ++i) at[k][i] = of.vertex(corner[i], k), box[k].include(at[k][i]);
  }
  int index;
  Triangle corner;
  std::array<Vec3, 3> at[2];
  Aabb box[2];
};

/// Depth-first over pairs of nodes, the earlier pair first, so that later ones can be left out. [Larsen00] has such
/// searches for distances; features that triangles share are tested once [Curtis08].
class Search {
 public:
  Search(const SurfacePath& a, const SurfacePath& b, const PassageSettings& settings)
      : path_a_(a), path_b_(b), settings_(settings), is_self_(&a == &b), window_(is_self_ ? 0.1 : 1e-3) {}

  std::vector<Passage> run() {
    const int pieces = std::max(path_a_.pieces(), path_b_.pieces());
    for (int i = 0; i < pieces && found_.empty(); ++i)
      look(static_cast<double>(i) / pieces, static_cast<double>(i + 1) / pieces);
    std::sort(found_.begin(), found_.end(), [](const Passage& l, const Passage& r) { return l.feature < r.feature; });
    return std::move(found_);
  }

 private:
  /// Halves the interval until paths in it are straight enough, first half first.
  void look(double t0, double t1) {
    check_interrupt();
    const double bend = path_a_.bend(t0, t1) + path_b_.bend(t0, t1);
    const Stretch a(path_a_, t0, t1);
    const std::optional<Stretch> b = is_self_ ? std::nullopt : std::optional<Stretch>(std::in_place, path_b_, t0, t1);
    a_ = &a, b_ = b ? &*b : &a;
    t0_ = t0, t1_ = t1;
    margin_ = settings_.depth + bend;
    if (bend > settings_.reach) {
      is_near_ = false;
      sketch_ = true;
      descend();
      sketch_ = false;
      if (!is_near_) return;
      const double middle = 0.5 * (t0 + t1);
      look(t0, middle);
      if (found_.empty()) look(middle, t1);
      return;
    }
    best_ = 1.0;
    descend();
    // those that meet together with the first, as the corners of a face do; a body that is pressed into itself rests on
    // many features at once, and they would be told one by one
    std::erase_if(found_, [&](const Passage& p) { return p.time > t0 + (t1 - t0) * best_ + window_ * (t1 - t0); });
  }

  void descend() { visit(0, 0); }

  std::optional<double> when(int na, int nb) const {
    return meeting(a_->box(na, 0), a_->box(na, 1), b_->box(nb, 0), b_->box(nb, 1), margin_);
  }

  void visit(int na, int nb) {
    const std::optional<double> t = when(na, nb);
    if (t) visit_met(na, nb, *t);
  }

  void visit_met(int na, int nb, double t) {
    if (t > best_ + window_ || (sketch_ && is_near_)) return;
    poll_();
    const BoxTree::Node &a = a_->node(na), &b = b_->node(nb);
    const bool is_one = is_self_ && na == nb;
    if (a.is_leaf() && b.is_leaf()) {
      for (int i = a.first; i < a.first + a.count; ++i) {
        const MovingTriangle of_a(*a_, a_->triangle(i));
        for (int j = is_one ? i + 1 : b.first; j < b.first + b.count; ++j)
          test(of_a, MovingTriangle(*b_, b_->triangle(j)));
      }
      return;
    }
    if (is_one) {
      visit(na + 1, na + 1);
      visit(a.second, a.second);
      visit(na + 1, a.second);
      return;
    }
    const bool split_a = b.is_leaf() || (!a.is_leaf() && a.box.extent().squaredNorm() >= b.box.extent().squaredNorm());
    const std::pair<int, int> first = split_a ? std::pair(na + 1, nb) : std::pair(na, nb + 1);
    const std::pair<int, int> second = split_a ? std::pair(a.second, nb) : std::pair(na, b.second);
    const std::optional<double> t_first = when(first.first, first.second), t_second = when(second.first, second.second);
    if (t_second && (!t_first || *t_second < *t_first)) {  // the earlier first, so that later ones can be left out
      visit_met(second.first, second.second, *t_second);
      if (t_first) visit_met(first.first, first.second, *t_first);
    } else {
      if (t_first) visit_met(first.first, first.second, *t_first);
      if (t_second) visit_met(second.first, second.second, *t_second);
    }
  }

  const TriangleMesh& mesh(const Stretch& s) const { return s.path().of->surface->mesh; }
  const MeshTopology& topology(const Stretch& s) const { return s.path().of->surface->topology; }

  void test(const MovingTriangle& a, const MovingTriangle& b) {
    const std::optional<double> t = meeting(a.box[0], a.box[1], b.box[0], b.box[1], margin_);
    if (!t || *t > best_ + window_) return;
    const std::uint8_t own_a = path_a_.of->owned[a.index], own_b = path_b_.of->owned[b.index];
    for (int k = 0; k < 3; ++k) {
      if ((own_a >> k & 1) != 0) vertex_face(*a_, a, k, *b_, b, false);
      if ((own_b >> k & 1) != 0) vertex_face(*b_, b, k, *a_, a, true);
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if ((own_a >> (3 + i) & 1) != 0 && (own_b >> (3 + j) & 1) != 0) edge_edge(a, i, b, j);
  }

  bool apart(const MovingCorners& c, int first_group) const {
    for (int k = 0; k < 3; ++k) {
      double low0 = INFINITY, high0 = -INFINITY, low1 = INFINITY, high1 = -INFINITY;
      double low0e = INFINITY, high0e = -INFINITY, low1e = INFINITY, high1e = -INFINITY;
      for (int i = 0; i < 4; ++i) {
        const double s = c.start[i][k], e = c.end[i][k];
        if (i < first_group)
          low0 = std::min(low0, s), high0 = std::max(high0, s), low0e = std::min(low0e, e),
          high0e = std::max(high0e, e);
        else
          low1 = std::min(low1, s), high1 = std::max(high1, s), low1e = std::min(low1e, e),
          high1e = std::max(high1e, e);
      }
      if ((low0 - high1 > margin_ && low0e - high1e > margin_) || (low1 - high0 > margin_ && low1e - high0e > margin_))
        return true;
    }
    return false;
  }

  ContinuousSettings continuous() const { return {margin_, 0.1 * margin_, 100'000}; }

  void vertex_face(const Stretch& of_vertex, const MovingTriangle& with, int corner, const Stretch& of_face,
                   const MovingTriangle& face, bool exchanged) {
    const int v = with.corner[corner], t_vertex = with.index, t = face.index;
    const Triangle& f = face.corner;
    if (is_self_ && (f[0] == v || f[1] == v || f[2] == v)) return;
    MovingCorners c;
    for (int k : {0, 1}) {
      auto& x = k == 0 ? c.start : c.end;
      x = {with.at[k][corner], face.at[k][0], face.at[k][1], face.at[k][2]};
    }
    if (apart(c, 1)) return;
    if (is_self_ && path_a_.exempt != nullptr && path_a_.exempt->has_vertex(topology(of_face), v, t)) return;
    const std::optional<Impact> impact = vertex_face_advancement(c, continuous());
    if (!impact) return;
    if (sketch_) {
      is_near_ = true;
      return;
    }
    Meeting m;
    m.time = impact->time;
    const double u = impact->place.x(), w = impact->place.y();
    m.first = {{v, v, v}, Vec3(1.0, 0.0, 0.0)};
    m.second = {{f[0], f[1], f[2]}, Vec3(1.0 - u - w, u, w)};
    m.normal_at = [&, f](double time) {
      const std::array<Vec3, 3> x = corners(of_face, f, time);
      return Vec3((x[1] - x[0]).cross(x[2] - x[0]));
    };
    m.is_over = [&, f, v, t](double time) {
      const std::array<Vec3, 3> x = corners(of_face, f, time);
      const Vec3 e0 = x[1] - x[0], e1 = x[2] - x[0], n = e0.cross(e1), d = position(of_vertex, v, time) - x[0];
      const double nn = n.squaredNorm(), b = d.cross(e1).dot(n) / nn, g = e0.cross(d).dot(n) / nn;
      return b >= -1e-9 && g >= -1e-9 && b + g <= 1.0 + 1e-9 &&
             (is_self_ || is_below_neighbours(of_face, t, position(of_vertex, v, time), n, time));
    };
    const std::uint64_t key = exchanged ? feature_key(Feature::face, t, Feature::vertex, v)
                                        : feature_key(Feature::vertex, v, Feature::face, t);
    judge(of_vertex, of_face, m, exchanged, exchanged ? t : t_vertex, exchanged ? t_vertex : t, key);
  }

  void edge_edge(const MovingTriangle& a, int i, const MovingTriangle& b, int j) {
    const int ta = a.index, tb = b.index, i1 = (i + 1) % 3, j1 = (j + 1) % 3;
    const int a0 = a.corner[i], a1 = a.corner[i1], b0 = b.corner[j], b1 = b.corner[j1];
    if (is_self_ && (a0 == b0 || a0 == b1 || a1 == b0 || a1 == b1)) return;
    MovingCorners c;
    for (int k : {0, 1}) {
      auto& x = k == 0 ? c.start : c.end;
      x = {a.at[k][i], a.at[k][i1], b.at[k][j], b.at[k][j1]};
    }
    if (apart(c, 2)) return;
    if (is_self_ && path_a_.exempt != nullptr &&
        path_a_.exempt->has_edges(topology(*a_), topology(*a_).triangle_edges[ta][i],
                                  topology(*b_).triangle_edges[tb][j]))
      return;
    const std::optional<Impact> impact = edge_edge_advancement(c, continuous());
    if (!impact) return;
    if (sketch_) {
      is_near_ = true;
      return;
    }
    const int ea = topology(*a_).triangle_edges[ta][i], eb = topology(*b_).triangle_edges[tb][j];
    Meeting m;
    m.time = impact->time;
    const double u = impact->place.x(), w = impact->place.y();
    m.first = {{a0, a1, a1}, Vec3(1.0 - u, u, 0.0)};
    m.second = {{b0, b1, b1}, Vec3(1.0 - w, w, 0.0)};
    m.normal_at = [=, this](double time) {
      const Vec3 da = position(*a_, a1, time) - position(*a_, a0, time),
                 db = position(*b_, b1, time) - position(*b_, b0, time);
      const Vec3 n = da.cross(db);
      if (n.squaredNorm() <= 1e-12 * da.squaredNorm() * db.squaredNorm()) return Vec3(Vec3::Zero());
      const double outward = n.dot(edge_normal(*b_, eb, time)) - n.dot(edge_normal(*a_, ea, time));
      return outward >= 0.0 ? n : Vec3(-n);
    };
    m.is_over = [&m, a0, a1, b0, b1, ea, eb, this](double time) {
      const Vec3 x[4] = {position(*a_, a0, time), position(*a_, a1, time), position(*b_, b0, time),
                         position(*b_, b1, time)};
      const SegmentSegment near = closest_between_segments(x[0], x[1], x[2], x[3]);
      if (is_self_) return near.interior;
      if (runs_above(*a_, a0, a1, *b_, eb, time) || runs_above(*b_, b0, b1, *a_, ea, time)) return false;
      return near.interior && is_inside(*a_, a0, a1, near.s, time) && is_inside(*b_, b0, b1, near.t, time) &&
             (is_supporting(ea, eb, m.normal_at(t0_ + m.time * (t1_ - t0_)), t0_ + m.time * (t1_ - t0_)) ||
              is_supporting(ea, eb, m.normal_at(time), time));
    };
    judge(*a_, *b_, m, false, ta, tb, feature_key(Feature::edge, ea, Feature::edge, eb));
  }

  /// Two features that come together; what is asked of them later is asked on the real path.
  struct Meeting {
    double time = 0.0;  ///< of the interval
    Place first, second;
    std::function<Vec3(double)> normal_at;  ///< from the second towards the first, of any length; zero: none
    std::function<bool(double)> is_over;    ///< whether the one still covers the other
  };

  static Vec3 position(const Stretch& s, int v, double time) { return s.position(v, time); }
  static Vec3 position(const Stretch& s, const Place& p, double time) {
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
      if (p.weight[k] != 0.0) x += p.weight[k] * position(s, p.vertex[k], time);
    return x;
  }
  static std::array<Vec3, 3> corners(const Stretch& s, const Triangle& t, double time) {
    return {position(s, t[0], time), position(s, t[1], time), position(s, t[2], time)};
  }
  Vec3 edge_normal(const Stretch& s, int e, double time) const {
    const MeshTopology::Edge& edge = topology(s).edges[e];
    Vec3 sum = Vec3::Zero();
    for (int t : {edge.triangle0, edge.triangle1}) {
      if (t < 0) continue;
      const std::array<Vec3, 3> x = corners(s, mesh(s).triangles[t], time);
      sum += (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    }
    return sum;
  }

  /// Whether the faces of both edges lie behind the edges as the normal sees them: only then do the edges themselves carry,
  /// and not a corner or a face beside them (the diagonal of a cube's side that slides over a plate's squares).
  bool is_supporting(int ea, int eb, const Vec3& normal, double time) const {
    return is_in_front(*a_, ea, -normal, time) && is_in_front(*b_, eb, normal, time);
  }
  bool is_in_front(const Stretch& s, int e, const Vec3& normal, double time) const {
    constexpr double kSlant = 0.01;  // radians a face may rise above the edge
    const MeshTopology::Edge& edge = topology(s).edges[e];
    const Vec3 x = position(s, edge.v0, time), along = (position(s, edge.v1, time) - x).normalized();
    for (const int t : {edge.triangle0, edge.triangle1}) {
      if (t < 0) continue;
      for (const int v : mesh(s).triangles[t]) {
        if (v == edge.v0 || v == edge.v1) continue;
        Vec3 into = position(s, v, time) - x;
        into -= into.dot(along) * along;
        if (normal.dot(into) > kSlant * normal.norm() * into.norm()) return false;
      }
    }
    return true;
  }

  /// Whether an edge from its one end to the other lies no deeper than is allowed under a face beside an edge of the other
  /// surface: it goes past that edge on the outside.
  bool runs_above(const Stretch& own, int v0, int v1, const Stretch& s, int e, double time) const {
    const MeshTopology::Edge& edge = topology(s).edges[e];
    for (const int t : {edge.triangle0, edge.triangle1}) {
      if (t < 0) continue;
      const std::array<Vec3, 3> x = corners(s, mesh(s).triangles[t], time);
      const Vec3 n = (x[1] - x[0]).cross(x[2] - x[0]);
      const double least = -settings_.depth * n.norm();
      if (n.isZero(0.0)) continue;
      if (n.dot(position(own, v0, time) - x[0]) >= least && n.dot(position(own, v1, time) - x[0]) >= least) return true;
    }
    return false;
  }

  /// What slips under a face past one of its sharp edges, or past one of its corners, is no deeper than it is below the
  /// face round that: a body that rests on triangles and slides over them passes none.
  bool is_below_neighbours(const Stretch& s, int t, const Vec3& x, const Vec3& normal, double time) const {
    const MeshTopology& of = topology(s);
    const std::array<Vec3, 3> own = corners(s, mesh(s).triangles[t], time);
    for (int k = 0; k < 3; ++k) {
      const int v = mesh(s).triangles[t][k];
      for (int i = of.vertex_triangle_begin[v]; i < of.vertex_triangle_begin[v + 1]; ++i) {
        const int other = of.vertex_triangles[i];
        if (other == t) continue;
        const std::array<Vec3, 3> c = corners(s, mesh(s).triangles[other], time);
        const Vec3 across = (c[1] - c[0]).cross(c[2] - c[0]);
        const double size = across.norm(), rounding = 1e-9 * std::sqrt(size);
        if (!(size > 0.0)) continue;
        // each of the two lies behind the other, and not in the same plane: flat or hollow there they hide nothing
        double own_rises = -INFINITY, other_rises = -INFINITY, falls = 0.0;
        for (int corner = 0; corner < 3; ++corner) {
          own_rises = std::max(own_rises, across.dot(own[corner] - own[k]) / size);
          other_rises = std::max(other_rises, normal.dot(c[corner] - own[k]) / normal.norm());
          falls += normal.dot(c[corner] - own[k]) / normal.norm();
        }
        if (falls >= -rounding || own_rises > rounding || other_rises > rounding) continue;
        if (across.dot(x - c[0]) > -settings_.depth * size) return false;
      }
    }
    return true;
  }

  /// Whether the place at `share` of an edge is farther from its ends than what may overlap (a few times that, seen along
  /// a slanting edge), or the edge goes on there.
  bool is_inside(const Stretch& s, int v0, int v1, double share, double time) const {
    const Vec3 x0 = position(s, v0, time), x1 = position(s, v1, time);
    const double length = (x1 - x0).norm();
    if (share * length <= 4.0 * settings_.depth) return goes_on(s, v0, (x0 - x1) / length, time);
    if ((1.0 - share) * length <= 4.0 * settings_.depth) return goes_on(s, v1, (x1 - x0) / length, time);
    return true;
  }

  bool goes_on(const Stretch& s, int v, const Vec3& direction, double time) const {
    const MeshTopology& of = topology(s);
    const Vec3 x = position(s, v, time);
    for (int i = of.vertex_triangle_begin[v]; i < of.vertex_triangle_begin[v + 1]; ++i)
      for (const int w : mesh(s).triangles[of.vertex_triangles[i]])
        if (w != v && (position(s, w, time) - x).normalized().dot(direction) > 0.9) return true;
    return false;
  }

  /// Whether the features go on to overlap: how far below the surface the one is when it should have come through, and
  /// at the interval's end.
  void judge(const Stretch& first, const Stretch& second, const Meeting& m, bool exchanged, int ta, int tb,
             std::uint64_t key) {
    const double span = t1_ - t0_, time = t0_ + m.time * span;
    const Vec3 n = m.normal_at(time);
    const double length = n.norm();
    if (!(length > 0.0)) return;
    const auto gap = [&](double t, const Vec3& unit) {
      return unit.dot(position(first, m.first, t) - position(second, m.second, t));
    };
    const Vec3 unit = n / length;
    const double now = gap(time, unit), later = std::min(1.0, time + 1e-3 * span);
    if (later <= time) return;
    double approach = (now - gap(later, unit)) / (later - time);
    // what is deeper may creep a little: the push-out brings it back
    const double creep = settings_.creep < 0.0 ? settings_.depth : settings_.creep;
    const double limit = std::min(-settings_.depth, now - creep), most = std::max(t1_, later);
    const auto is_deep = [&](double t) {
      const Vec3 at = m.normal_at(t);
      const double size = at.norm();
      return size > 0.0 && gap(t, at / size) < limit;
    };
    // the moment at which it is that deep decides whether it came through, or round an end
    double before = time,
           after = approach > 0.0 ? time + (std::max(now, 0.0) + 2.0 * settings_.depth) / approach : later;
    after = std::min(after, most);
    while (!is_deep(after) && after < most) before = after, after = std::min(most, time + 2.0 * (after - time));
    if (!is_deep(after)) return;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (before + after);
      (is_deep(middle) ? after : before) = middle;
    }
    const bool passes = m.is_over(after);
    if (!passes) return;
    if (!(approach > 0.0)) approach = std::max((now - gap(most, unit)) / (most - time), 1e-300);
    Passage p;
    p.time = time;
    p.approach = approach;
    p.triangle_a = TriangleIndex(ta), p.triangle_b = TriangleIndex(tb);
    p.point_a = position(first, m.first, 0.0), p.point_b = position(second, m.second, 0.0);
    p.normal = unit;
    if (exchanged) std::swap(p.point_a, p.point_b), p.normal = -unit;
    p.feature = key;
    best_ = std::min(best_, m.time);
    found_.push_back(p);
  }

  const SurfacePath &path_a_, &path_b_;
  PassageSettings settings_;
  bool is_self_;
  double window_;  // of the interval: what follows the first so soon is told with it
  const Stretch *a_ = nullptr, *b_ = nullptr;
  double t0_ = 0.0, t1_ = 1.0, margin_ = 0.0, best_ = 1.0;
  bool sketch_ = false, is_near_ = false;
  InterruptPoll poll_;
  std::vector<Passage> found_;
};

}  // namespace

std::vector<Passage> first_passages(const SurfacePath& a, const SurfacePath& b, const PassageSettings& settings) {
  return Search(a, b, settings).run();
}

std::vector<Passage> first_self_passages(const SurfacePath& path, const PassageSettings& settings) {
  return Search(path, path, settings).run();
}

}  // namespace impinge
