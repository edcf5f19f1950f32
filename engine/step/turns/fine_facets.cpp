#include "engine/step/turns/fine_facets.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "engine/geometry/angle.hpp"
#include "engine/shapes/primitives.hpp"

namespace impinge {
namespace {

constexpr double kTouching = 0.02;         // of the activation distance: a corner that it stands on
constexpr double kSweep = 2.0;             // of the turn: what comes down in it or in the next one
constexpr double kAtOnce = 0.05;           // of the turn: what comes down together, as both ends of an edge do
constexpr double kOnTheWay = 0.9;          // of the sweep of a rim: a corner between both ends
constexpr double kAcross = 0.5;            // of the arm of a place: so far from the axis it goes round that
constexpr double kFinest = 0.25;           // radians between corners of what may be round
constexpr double kSameFace = 1.0 - 1e-10;  // cosine

/// The rows of one pair.
class FineFacets {
 public:
  FineFacets(const Bodies& bodies, const AssembledGroup& group, const ContactSettings& settings,
             std::span<const RowEnd> rows, const Vec3& turn, std::span<const char> is_round, EndRows& ends)
      : bodies_(bodies),
        group_(group),
        settings_(settings),
        rows_(rows),
        axis_(turn.normalized()),
        turn_(turn.norm()),
        ends_(ends),
        is_round_(is_round) {}

  void roll(std::size_t first, std::size_t last) {
    const std::vector<double> own(ends_.gaps.begin() + static_cast<std::ptrdiff_t>(first),
                                  ends_.gaps.begin() + static_cast<std::ptrdiff_t>(last));
    find_sweep(first, last, own);
    std::vector<std::size_t> takers, order(last - first);
    std::iota(order.begin(), order.end(), first);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) { return gap_now(l) < gap_now(r); });
    for (const std::size_t e : order) {
      std::optional<std::size_t> nearest;
      for (const std::size_t c : takers) {
        if (!(own[e - first] < own[c - first]) || !hands_over(e, c)) continue;
        if (!nearest || distance(c, e) < distance(*nearest, e)) nearest = c;
      }
      if (!nearest) {
        takers.push_back(e);
        continue;
      }
      ends_.handed_over[e] = 1;
      if (own[e - first] < ends_.gaps[*nearest]) answer_for(e, *nearest, own[e - first]);
    }
  }

 private:
  /// What goes round on its rim, as a coin does, comes down on corners that lie about no axis of its spin: those between where
  /// it stands and the lowest one then tell whether they are finer than that.
  void find_sweep(std::size_t first, std::size_t last, const std::vector<double>& own) {
    const auto end_gap = [&](std::size_t i) { return own[i - first]; };
    std::size_t now = first, then = first;
    for (std::size_t i = first; i < last; ++i) {
      if (gap_now(i) < gap_now(now)) now = i;
      if (end_gap(i) < end_gap(then)) then = i;
    }
    sweep_ = 0.0;
    // what goes round its spin has been told by that, and both ends of an edge come down together
    if (across(rows_[now]).norm() > kAcross * arm(rows_[now]).norm()) return;
    const double sweep = along_rim(now, then);
    if (!(sweep < kFinest)) return;
    for (std::size_t i = first; i < last; ++i) {
      if (is_round_[i] != 0) continue;
      const double part = along_rim(now, i) / sweep;
      if (end_gap(i) < end_gap(now) && part > kAtOnce && part < kOnTheWay) sweep_ = sweep;
    }
  }
  /// From the centre of what rolls.
  double along_rim(std::size_t i, std::size_t k) const { return angle_between(arm(rows_[i]), arm(rows_[k])); }

  void answer_for(std::size_t e, std::size_t c, double gap) {
    ends_.gaps[c] = gap;
    ends_.rolling[c] = group_.system.contacts[c].directions * rows_[c].half_way(bodies_, rows_[e].then());
    ends_.rolling[c].x() = 0.0;
    ends_.is_round[c] = 1;
  }
  double gap_now(std::size_t i) const { return rows_[i].of->gap; }
  double distance(std::size_t c, std::size_t e) const { return (rows_[c].now() - rows_[e].now()).squaredNorm(); }

  /// Whether what comes down at e touches at c now, on the same face and no farther round the body than it turns.
  bool hands_over(std::size_t e, std::size_t c) const {
    if (ends_.is_on_face[c] == 0 || ends_.is_on_face[e] == 0) return false;
    const RowEnd &now = rows_[c], &then = rows_[e];
    if (now.of->normal_owner != then.of->normal_owner) return false;
    const double activation = settings_.activation_distance.at(group_.system.contacts[c].scale.length);
    if (!(now.of->gap < kTouching * activation && now.of->gap < then.of->gap)) return false;
    if (!(now.of->normal.dot(then.of->normal) > kSameFace))
      return is_ball(now.body()) && distance(c, e) < kSweep * kSweep * way(now).squaredNorm();
    if (is_round_[c] != 0 && is_round_[e] != 0) return false;  // both ends of a line, which goes round as a whole
    const double angle = angle_between(across(now), across(then));
    if (angle > kAtOnce * turn_ && angle < std::min(kSweep * turn_, kFinest)) return true;
    if (is_round_[c] != 0 || is_round_[e] != 0) return false;
    const double on_rim = along_rim(c, e);
    return on_rim > kAtOnce * sweep_ && on_rim < kSweep * sweep_;
  }

  bool is_ball(BodyIndex body) const { return bodies_[body].shape->as<Sphere>() != nullptr; }
  Vec3 way(const RowEnd& row) const { return row.end().pose.position - bodies_[row.body()].pose.position; }

  Vec3 arm(const RowEnd& row) const { return row.now() - bodies_[row.body()].pose.position; }
  Vec3 across(const RowEnd& row) const { return arm(row) - axis_ * axis_.dot(arm(row)); }

  const Bodies& bodies_;
  const AssembledGroup& group_;
  const ContactSettings& settings_;
  std::span<const RowEnd> rows_;
  const Vec3 axis_;
  const double turn_;
  EndRows& ends_;
  std::span<const char> is_round_;  // by row: before any answered for others
  double sweep_ = 0.0;              // radians, of a rim that is finer; 0: it is not, or nothing of it
};

}  // namespace

void roll_over_facets(const Bodies& bodies, const AssembledGroup& group, const ContactSettings& settings,
                      double time_step, std::span<const RowEnd> rows, EndRows& ends) {
  const std::vector<char> is_round = ends.is_round;
  for_each_pair(rows, [&](std::size_t first, std::size_t last) {
    const Vec3 turn = time_step * (rows[first].a->spin - rows[first].b->spin);
    if (last - first > 1 && turn.norm() > 0.0)
      FineFacets(bodies, group, settings, rows, turn, is_round, ends).roll(first, last);
  });
}

}  // namespace impinge
