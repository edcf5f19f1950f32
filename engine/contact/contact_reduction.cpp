#include "engine/contact/contact_reduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/contact/pair_scale.hpp"
#include "engine/detection/contacts/contact_points.hpp"

namespace impinge {
namespace {

// no more are not worth a look: of a pair (two boxes have eight), of a patch
constexpr std::size_t kFewOfPair = 8, kFewOfPatch = 4;
// of the patch's size: how far a corner must stand out to be one
constexpr double kFlat = 1e-3;
// of the activation distance: how much deeper a contact must be to take the place of one that carries
constexpr double kPreference = 0.01;
// of the same, and cosine: what is as deep as another, and faces the same way
constexpr double kAsDeep = 1e-4, kOneNormal = 1.0 - 1e-9;
// of the patch's size: how far from the sides of the polygon a contact is that they can carry for
constexpr double kWithin = 0.05;
// the tilts, radians, for which the contacts that would be deepest stay
constexpr std::array<double, 2> kTilts = {0.01, 0.1};
constexpr int kTiltDirections = 8;

/// What is a patch, and what stays of it.
struct Fineness {
  double cosine;        ///< of the angle between its normals and its first one: 8, 16, 32, 45 degrees
  std::size_t corners;  ///< of its support polygon: a disc stands on sixteen as on its rim, but for 2.5 % of its radius
  std::size_t tilts;    ///< how many of kTilts
};
// the next where one leaves a pair with too many contacts, as a pin all round in its hole
constexpr std::array<Fineness, 4> kFineness = {{{0.990, 16, 2}, {0.961, 8, 2}, {0.848, 4, 1}, {0.707, 4, 0}}};

struct Place {
  double x = 0.0, y = 0.0;  ///< in the patch's plane, metres from its middle
  double gap = 0.0;
  std::size_t contact = 0;
};

double cross(const Place& o, const Place& a, const Place& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

double distance(const Place& a, const Place& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Corners of the convex hull that stand out by more than `flat` metres, counter-clockwise (monotone chain [Andrew79]).
std::vector<Place> hull(std::vector<Place> places, double flat) {
  std::sort(places.begin(), places.end(),
            [](const Place& l, const Place& r) { return std::tie(l.x, l.y, l.gap) < std::tie(r.x, r.y, r.gap); });
  const auto chain = [&](auto first, auto last) {
    std::vector<Place> corners;
    for (auto p = first; p != last; ++p) {
      if (!corners.empty() && distance(corners.back(), *p) <= flat) {  // in one place: the deeper
        if (p->gap < corners.back().gap) corners.back() = *p;
        continue;
      }
      while (corners.size() >= 2 &&
             cross(corners[corners.size() - 2], corners.back(), *p) <= flat * distance(corners[corners.size() - 2], *p))
        corners.pop_back();
      corners.push_back(*p);
    }
    return corners;
  };
  std::vector<Place> corners = chain(places.begin(), places.end());
  std::vector<Place> back = chain(places.rbegin(), places.rend());
  if (back.size() > 2) corners.insert(corners.end(), back.begin() + 1, back.end() - 1);
  return corners;
}

/// The corners without which the polygon would lose most: the next is always the one farthest outside of those taken.
std::vector<Place> most_of(const std::vector<Place>& corners, std::size_t most) {
  const std::size_t n = corners.size();
  if (n <= most) return corners;
  std::size_t opposite = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (distance(corners[0], corners[i]) > distance(corners[0], corners[opposite])) opposite = i;
  std::vector<std::size_t> taken = {0, opposite};  // ascending
  while (taken.size() < most) {
    double farthest = -1.0;
    std::size_t best = 0, after = 0;
    for (std::size_t k = 0; k < taken.size(); ++k) {
      const Place &from = corners[taken[k]], &to = corners[taken[(k + 1) % taken.size()]];
      const std::size_t end = k + 1 < taken.size() ? taken[k + 1] : n;
      for (std::size_t i = taken[k] + 1; i < end; ++i) {
        const double outside = std::abs(cross(from, corners[i], to)) / distance(from, to);
        if (outside > farthest) farthest = outside, best = i, after = k;
      }
    }
    taken.insert(taken.begin() + static_cast<std::ptrdiff_t>(after) + 1, best);
  }
  std::vector<Place> kept;
  kept.reserve(taken.size());
  for (const std::size_t i : taken) kept.push_back(corners[i]);
  return kept;
}

/// Whether all of them are of one face that lies on another.
bool lie_flat(std::span<const Collision> contacts, double as_deep) {
  return std::abs(contacts.front().gap) <= as_deep &&
         std::all_of(contacts.begin(), contacts.end(), [&](const Collision& c) {
           return std::abs(c.gap - contacts.front().gap) <= as_deep &&
                  c.normal.dot(contacts.front().normal) > kOneNormal;
         });
}

/// Whether a place is inside of all sides of a polygon by so much.
bool lies_within(const Place& place, const std::vector<Place>& corners, double by) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Place &from = corners[i], &to = corners[(i + 1) % corners.size()];
    if (!(cross(from, to, place) > by * distance(from, to))) return false;
  }
  return true;
}

class PairReduction {
 public:
  PairReduction(std::span<const Collision> contacts, const std::vector<char>& is_preferred,
                const ReductionSettings& how)
      : contacts_(contacts), most_(how.most), as_deep_(kAsDeep * how.activation) {
    for (std::size_t i = 0; i < contacts.size(); ++i)
      gaps_.push_back(contacts[i].gap - (is_preferred[i] != 0 ? kPreference * how.activation : 0.0));
    by_gap_.resize(contacts.size());
    std::iota(by_gap_.begin(), by_gap_.end(), std::size_t{0});
    std::stable_sort(by_gap_.begin(), by_gap_.end(), [&](std::size_t l, std::size_t r) { return gaps_[l] < gaps_[r]; });
  }

  std::vector<char> run() {
    for (const Fineness& how : kFineness) {
      is_kept_.assign(contacts_.size(), 0);
      reduce_patches(how);
      if (std::count(is_kept_.begin(), is_kept_.end(), 1) <= most_) return is_kept_;
    }
    keep_nearest();
    return is_kept_;
  }

 private:
  /// Too many patches: what has farthest to go waits.
  void keep_nearest() {
    std::ptrdiff_t left = most_;
    for (const std::size_t i : by_gap_)
      if (is_kept_[i] != 0 && --left < 0) is_kept_[i] = 0;
  }

  void reduce_patches(const Fineness& how) {
    std::vector<std::size_t> left = by_gap_, patch, others;
    while (!left.empty()) {
      const Vec3 normal = contacts_[left.front()].normal;
      patch.clear(), others.clear();
      for (const std::size_t i : left) (contacts_[i].normal.dot(normal) >= how.cosine ? patch : others).push_back(i);
      keep_of(patch, normal, how);
      left.swap(others);
    }
  }

  void keep_of(const std::vector<std::size_t>& patch, const Vec3& normal, const Fineness& how) {
    if (patch.size() <= kFewOfPatch) {
      for (const std::size_t i : patch) is_kept_[i] = 1;
      return;
    }
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const auto point = [&](std::size_t i) { return contacts_[i].common_point(); };
    Vec3 middle = Vec3::Zero();
    for (const std::size_t i : patch) middle += point(i) / static_cast<double>(patch.size());
    std::vector<Place> places;
    double size = 0.0;
    for (const std::size_t i : patch) {
      const Vec3 r = point(i) - middle;
      places.push_back({r.dot(u), r.dot(v), gaps_[i], i});
      size = std::max(size, std::hypot(places.back().x, places.back().y));
    }
    const std::vector<Place> corners = most_of(hull(places, kFlat * size), how.corners);
    for (const Place& corner : corners) is_kept_[corner.contact] = 1;
    if (patch.size() == contacts_.size() && lie_flat(contacts_, as_deep_)) {
      // what is within the corners could carry all for them, and turn as on a needle
      for (const Place& p : places)
        if (places.size() <= kFewOfPair && !lies_within(p, corners, kWithin * size)) is_kept_[p.contact] = 1;
      return;
    }
    keep_deepest(places, 0.0, 0.0);
    for (std::size_t i = 0; i < how.tilts; ++i)
      for (int k = 0; k < kTiltDirections; ++k) {
        const double angle = 2.0 * M_PI * k / kTiltDirections;
        keep_deepest(places, kTilts[i] * std::cos(angle), kTilts[i] * std::sin(angle));
      }
  }

  /// Of the gaps after a small turn of the one body.
  void keep_deepest(const std::vector<Place>& places, double slope_x, double slope_y) {
    const Place* deepest = nullptr;
    double least = INFINITY;
    for (const Place& p : places) {
      const double gap = p.gap + slope_x * p.x + slope_y * p.y;
      if (gap < least) least = gap, deepest = &p;
    }
    if (deepest != nullptr) is_kept_[deepest->contact] = 1;
  }

  std::span<const Collision> contacts_;
  std::ptrdiff_t most_;
  double as_deep_;            // metres
  std::vector<double> gaps_;  // less the preference
  std::vector<std::size_t> by_gap_;
  std::vector<char> is_kept_;
};

bool deforms(const Bodies& bodies, BodyIndex b) { return bodies[b].kind() == BodyKind::deformable; }

}  // namespace

std::vector<char> contacts_that_stay(std::span<const Collision> contacts, const std::vector<char>& is_preferred,
                                     const ReductionSettings& how) {
  return PairReduction(contacts, is_preferred, how).run();
}

std::vector<Collision> reduce_contacts(const Bodies& bodies, const ContactCache& carried,
                                       std::span<const Collider> colliders, std::span<const Collision> asked,
                                       const ContactSettings& contact, std::vector<Collision>& collisions) {
  const auto is_asked = [&](const Collision& c) {
    return std::any_of(asked.begin(), asked.end(), [&](const Collision& a) {
      return a.body_a == c.body_a && a.body_b == c.body_b && a.feature == c.feature;
    });
  };
  const auto is_mesh = [&](BodyIndex b) { return bodies[b].shape->mesh() != nullptr; };
  const auto which_stay = [&](BodyIndex a, BodyIndex b, std::span<const Collision> of_pair) -> std::vector<char> {
    if (of_pair.size() <= kFewOfPatch || a == b) return {};
    const bool are_few = of_pair.size() <= kFewOfPair;
    if (deforms(bodies, a) || deforms(bodies, b)) {
      if (are_few || !is_mesh(a) || !is_mesh(b)) return {};
      return without_flat_crossings(colliders, {a, b}, of_pair);
    }
    const double activation = contact.activation(pair_size(bodies[a], bodies[b]));
    if (are_few && !lie_flat(of_pair, kAsDeep * activation)) return {};
    std::vector<char> is_preferred;
    for (const Collision& c : of_pair) is_preferred.push_back(carried.find({a, b, c.feature}).isZero(0.0) ? 0 : 1);
    const auto sure = static_cast<int>(std::count_if(of_pair.begin(), of_pair.end(), is_asked));
    const int most = std::max(contact.most_contacts - sure, static_cast<int>(kFewOfPair));
    return contacts_that_stay(of_pair, is_preferred, {activation, most});
  };
  std::vector<Collision> kept, dropped;
  for (std::size_t first = 0, last = 0; first < collisions.size(); first = last) {
    const BodyIndex a = collisions[first].body_a, b = collisions[first].body_b;
    while (last < collisions.size() && collisions[last].body_a == a && collisions[last].body_b == b) ++last;
    const std::span<const Collision> of_pair(collisions.data() + first, last - first);
    const std::vector<char> stays = which_stay(a, b, of_pair);  // empty: all
    for (std::size_t i = 0; i < of_pair.size(); ++i)
      (stays.empty() || stays[i] != 0 || is_asked(of_pair[i]) ? kept : dropped).push_back(of_pair[i]);
  }
  collisions.swap(kept);
  return dropped;
}

}  // namespace impinge
