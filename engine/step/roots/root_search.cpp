#include "engine/step/roots/root_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

using Velocities = RootSearch::Velocities;

constexpr int kWindow = 5;      // iterations that are compared with those before them
constexpr int kRemembered = 5;  // places beside the last
constexpr int kPatience = 3;    // ways that may be longer than the shortest
constexpr double kFirstPart = 0.5;
constexpr double kAlike = 1e-10;  // of ways that hardly tell more than others

double product(const Velocities& x, const Velocities& y) {
  double sum = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += dot(x[k], y[k]);
  return sum;
}

Velocities times(std::span<const BlockMatrix* const> a, const Velocities& x) {
  Velocities y(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) multiply(*a[k], x[k], y[k]);
  return y;
}

Velocities difference(const Velocities& x, const Velocities& y) {
  Velocities d = x;
  for (std::size_t k = 0; k < x.size(); ++k) d[k] -= y[k];
  return d;
}

void add(Velocities& x, double factor, const Velocities& y) {
  for (std::size_t k = 0; k < x.size(); ++k) x[k] += factor * y[k];
}

}  // namespace

/// Whether the residual would be down at the tolerance in time if it went on as it has in the last iterations.
bool RootSearch::gets_on() const {
  const int since = static_cast<int>(residuals_.size()), left = most_ - made_;
  if (since < (is_full_ ? 2 : 4) * kWindow || left < kWindow) return true;
  const auto end = residuals_.end();
  const double now = *std::min_element(end - kWindow, end),
               before = *std::min_element(end - 2 * kWindow, end - kWindow);
  return now * std::pow(now / before, static_cast<double>(left) / kWindow) <= tolerance_;
}

void RootSearch::take_turns(const Velocities& to) {
  if (!is_controlled_) best_residual_ = INFINITY;  // what led here was another T: its rows may have been others
  if (is_full_) left_ = to;
  is_controlled_ = true, is_full_ = !is_full_;
  residuals_.clear();
  part_ = 1.0, shortest_ = INFINITY;
  near_.clear(), near_way_.clear();
}

Velocities RootSearch::start_again(const Velocities& at, const Velocities& way) {
  part_ *= kFirstPart;
  longer_ = 0;
  last_.clear(), last_way_.clear(), from_last_.clear(), way_from_last_.clear();
  Velocities v = at;
  add(v, part_, way);
  return v;
}

void RootSearch::remember(const Velocities& at, const Velocities& way) {
  if (!last_.empty()) {
    from_last_.push_back(difference(at, last_));
    way_from_last_.push_back(difference(way, last_way_));
  }
  if (static_cast<int>(from_last_.size()) > kRemembered) {
    from_last_.erase(from_last_.begin());
    way_from_last_.erase(way_from_last_.begin());
  }
  last_ = at, last_way_ = way;
}

/// Takes from v, at the end of a part of the way, what makes the way shortest.
void RootSearch::combine(Velocities& v, const Velocities& way, std::span<const BlockMatrix* const> a) const {
  const auto count = static_cast<Eigen::Index>(from_last_.size());
  if (count == 0) return;
  MatX gram(count, count);
  VecX share(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Velocities image = times(a, way_from_last_[static_cast<std::size_t>(i)]);
    for (Eigen::Index j = 0; j < count; ++j) gram(i, j) = product(image, way_from_last_[static_cast<std::size_t>(j)]);
    share[i] = product(image, way);
  }
  gram.diagonal() *= 1.0 + kAlike;
  share = gram.ldlt().solve(share).eval();
  if (!share.allFinite()) return;
  for (std::size_t i = 0; i < from_last_.size(); ++i) {
    const double s = share[static_cast<Eigen::Index>(i)];
    add(v, -s, from_last_[i]);
    add(v, -s * part_, way_from_last_[i]);
  }
}

Velocities RootSearch::shorter(const Velocities& at, const Velocities& way, std::span<const BlockMatrix* const> a) {
  const double length = std::sqrt(product(way, times(a, way)));
  if (length < shortest_)
    longer_ = 0, near_ = at, near_way_ = way, shortest_ = length;
  else if (++longer_ >= kPatience && !near_.empty())
    return start_again(near_, near_way_);
  remember(at, way);
  Velocities v = at;
  add(v, part_, way);
  combine(v, way, a);
  return v;
}

Velocities RootSearch::next(const Velocities& at, const Velocities& to, double residual,
                            std::span<const BlockMatrix* const> a) {
  ++made_;
  residuals_.push_back(residual);
  if (is_controlled_ && residual < best_residual_) best_residual_ = residual, best_ = at;
  if (gets_on()) return is_full_ ? to : shorter(at, difference(to, at), a);
  take_turns(to);
  return is_full_ ? left_ : start_again(at, difference(to, at));
}

}  // namespace impinge
