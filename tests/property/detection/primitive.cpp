// What every exact test must do, over random poses of every pair: contracts, symmetry, invariance, and distances
// against an independent solver.
#include <catch2/catch.hpp>

#include <set>

#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

SharedShape random_shape(Random& r, int kind) {
  switch (kind) {
    case 0:
      return Plane{r.direction(), 0.3 * r.sym()};
    case 1:
      return Sphere{r.in(0.2, 0.8)};
    case 2:
      return Box{Vec3(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8))};
    case 3:
      return Capsule{r.in(0.1, 0.4), r.in(0.1, 0.8)};
    default:
      return surface(r.below(2) ? icosphere(1, r.in(0.4, 0.8))
                                : box({r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8)}, {2, 2, 2}));
  }
}

/// A convex set by its projection: the point of the set nearest to x.
struct Projection {
  Pose pose;
  SharedShape shape;
  Vec3 operator()(const Vec3& x) const {
    const Vec3 l = pose.apply_inverse(x);
    if (const Box* box = shape->as<Box>()) return pose.apply(l.cwiseMax(-box->half).cwiseMin(box->half));
    if (const Capsule* c = shape->as<Capsule>())
      return pose.apply({0.0, std::clamp(l.y(), -c->half_length, c->half_length), 0.0});
    return pose.position;
  }
  /// How far the core reaches from its centre along a unit direction.
  double reach(const Vec3& n) const {
    const Vec3 l = pose.rotation.transpose() * n;
    if (const Box* box = shape->as<Box>()) return l.cwiseAbs().dot(box->half);
    if (const Capsule* c = shape->as<Capsule>()) return std::abs(l.y()) * c->half_length;
    return 0.0;
  }
  double radius() const {
    if (const Sphere* s = shape->as<Sphere>()) return s->radius;
    if (const Capsule* c = shape->as<Capsule>()) return c->radius;
    return 0.0;
  }
};

/// Bounds of the distance of the two cores (box, segment, point): from above by accelerated projected gradient with
/// restart on |x - y|²/2 over the product of the two convex sets, from below by the separation along x - y.
struct Distance {
  double low, high;
};
Distance core_distance(const Projection& a, const Projection& b, int iterations = 4000) {
  Vec3 x = a.pose.position, y = b.pose.position, xm = x, ym = y;
  double momentum = 1.0;
  for (int i = 0; i < iterations; ++i) {
    const Vec3 g = xm - ym;
    const Vec3 xn = a(xm - 0.5 * g), yn = b(ym + 0.5 * g);
    if ((xm - xn).dot(xn - x) + (ym - yn).dot(yn - y) > 0.0) momentum = 1.0;
    const double next = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * momentum * momentum));
    const double beta = (momentum - 1.0) / next;
    momentum = next;
    xm = xn + beta * (xn - x);
    ym = yn + beta * (yn - y);
    x = xn;
    y = yn;
  }
  const double high = (x - y).norm();
  const Vec3 n = high > 0.0 ? Vec3((x - y) / high) : Vec3(Vec3::UnitX());
  return {n.dot(a.pose.position - b.pose.position) - a.reach(n) - b.reach(n), high};
}

void check_contract(const std::vector<Collision>& contacts, const TestColliders& bodies, int a, int b,
                    const ContactQuery& query) {
  std::set<std::uint64_t> keys;
  for (const Collision& c : contacts) {
    REQUIRE(c.body_a == a);
    REQUIRE(c.body_b == b);
    REQUIRE(c.point_a.allFinite());
    REQUIRE(c.point_b.allFinite());
    REQUIRE(c.normal.allFinite());
    REQUIRE(c.normal.norm() == Approx(1.0).epsilon(1e-12));
    REQUIRE(c.gap == Approx(c.normal.dot(c.point_a - c.point_b)).margin(1e-13));
    REQUIRE((c.triangle_a >= 0) == (bodies.colliders()[a].shape->mesh() != nullptr));
    REQUIRE((c.triangle_b >= 0) == (bodies.colliders()[b].shape->mesh() != nullptr));
    REQUIRE((c.normal_owner == -1 || c.normal_owner == a || c.normal_owner == b));
    REQUIRE(c.gap <= (query.proximity ? query.activation : 0.0));
    REQUIRE(keys.insert(c.feature).second);
  }
}

}  // namespace

TEST_CASE("exact contacts keep their contract in every pair and pose") {
  Random r(7);
  int found = 0;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      if (i == 4 && j == 4) continue;
      int pairs = 0;
      for (int k = 0; k < 150; ++k) {
        TestColliders bodies;
        const SharedShape sa = random_shape(r, i), sb = random_shape(r, j);
        const Pose pa = i == 0 ? Pose{} : random_pose(r, 0.7), pb = j == 0 ? Pose{} : random_pose(r, 0.7);
        bodies.add(sa, pa);
        bodies.add(sb, pb);
        bodies.add(sa, pa);  // body 2 repeats body 0, so that pair (1, 2) is the pair swapped
        const ContactQuery query{k % 3 != 0, 0.05, 0.0};
        const auto contacts = bodies.contacts(0, 1, query);
        INFO(sa->name() << " " << sb->name() << " case " << k);
        check_contract(contacts, bodies, 0, 1, query);
        pairs += contacts.empty() ? 0 : 1;

        // of coplanar triangles that a box overlaps equally, rounding chooses the one that a contact is named after:
        // only the gap is compared then
        const bool may_tie = i + j == 6 && i != j;
        const auto swapped = bodies.contacts(1, 2, query);
        REQUIRE(swapped.empty() == contacts.empty());
        if (!contacts.empty()) REQUIRE(smallest_gap(swapped) == Approx(smallest_gap(contacts)).margin(1e-12));
        if (!may_tie) REQUIRE(swapped.size() == contacts.size());
        // the pair swapped: the same gaps, opposite normals
        for (const Collision& c : contacts) {
          bool same = false;
          for (const Collision& s : swapped)
            same = same || (std::abs(s.gap - c.gap) < 1e-12 && (s.normal + c.normal).norm() < 1e-9 &&
                            (s.point_b - c.point_a).norm() < 1e-9 && (s.point_a - c.point_b).norm() < 1e-9);
          REQUIRE((same || may_tie));
        }

        // the scene moved as a whole: the same contacts
        const Pose move = random_pose(r, 2.0);
        TestColliders moved;
        moved.add(sa, then(move, pa));
        moved.add(sb, then(move, pb));
        const auto there = moved.contacts(0, 1, query);
        REQUIRE(there.empty() == contacts.empty());
        if (!contacts.empty()) REQUIRE(std::abs(smallest_gap(there) - smallest_gap(contacts)) < 1e-12);
        if (may_tie) continue;
        REQUIRE(there.size() == contacts.size());
        for (std::size_t n = 0; n < contacts.size(); ++n) {
          REQUIRE(std::abs(there[n].gap - contacts[n].gap) < 1e-12);
          REQUIRE((there[n].normal - move.rotation * contacts[n].normal).norm() < 1e-9);
          REQUIRE(there[n].feature == contacts[n].feature);
          REQUIRE((there[n].point_a - move.apply(contacts[n].point_a)).norm() < 1e-9);
        }
      }
      found += pairs;
      INFO("pair " << i << " " << j);
      REQUIRE((pairs > 15 || (i == 0 && j == 0)));
    }
  REQUIRE(found > 1000);
}

TEST_CASE("gaps of separated exact shapes are their distances") {
  Random r(11);
  int apart[5][5] = {};
  for (int i = 1; i < 4; ++i)
    for (int j = 1; j < 4; ++j)
      for (int k = 0; k < 250; ++k) {
        TestColliders bodies;
        const Projection a{random_pose(r, 1.0), random_shape(r, i)}, b{random_pose(r, 1.0), random_shape(r, j)};
        bodies.add(a.shape, a.pose);
        bodies.add(b.shape, b.pose);
        const Distance distance = core_distance(a, b);
        if (distance.high < 1e-6) continue;
        const double gap = distance.high - a.radius() - b.radius();
        INFO(a.shape->name() << " " << b.shape->name() << " case " << k << " distance " << distance.high);
        const auto contacts = bodies.contacts(0, 1, {true, 10.0, 0.0});
        REQUIRE(!contacts.empty());
        REQUIRE(std::abs(smallest_gap(contacts) - gap) < 1e-8);
        if (gap > 0.0) {
          ++apart[i][j];
          // the nearest points lie on the surfaces, all others on or (the far cap of a tilted capsule) below them
          for (const Collision& c : contacts) {
            const double off_a = (a(c.point_a) - c.point_a).norm() - a.radius(),
                         off_b = (b(c.point_b) - c.point_b).norm() - b.radius();
            REQUIRE(off_a < 1e-9);
            REQUIRE(off_b < 1e-9);
            if (c.gap < gap + 1e-12) {
              REQUIRE(off_a > -1e-9);
              REQUIRE(off_b > -1e-9);
            }
          }
          REQUIRE(bodies.contacts(0, 1, {true, 0.999 * gap, 0.0}).empty());
          REQUIRE(bodies.contacts(0, 1, {false, 10.0, 0.0}).empty());
        }
      }
  for (int i = 1; i < 4; ++i)
    for (int j = 1; j < 4; ++j) REQUIRE(apart[i][j] > 20);
}

TEST_CASE("gaps of nearly aligned boxes and capsules are their distances too") {
  // ties between faces, edges and corners: right angles disturbed by 1e-12 to 0.1 rad
  Random r(12);
  int converged = 0, compared = 0;
  for (int i = 2; i < 4; ++i)
    for (int j = 2; j < 4; ++j)
      for (int k = 0; k < 200; ++k) {
        const auto tilted = [&] {
          Mat3 m = Eigen::AngleAxisd(0.5 * M_PI * r.below(4), Vec3::Unit(r.below(3))).toRotationMatrix();
          return Mat3(Eigen::AngleAxisd(std::pow(10.0, r.in(-12.0, -1.0)), r.direction()).toRotationMatrix() * m);
        };
        SharedShape sa = random_shape(r, i), sb = random_shape(r, j);
        if (i == j && k % 2) sb = sa;
        Vec3 offset = r.vector();
        if (k % 3 == 0) offset[r.below(3)] = 1e-9 * r.sym();
        if (k % 5 == 0) offset[r.below(3)] = 0.0;
        const Projection a{{tilted(), Vec3::Zero()}, sa}, b{{tilted(), 2.0 * offset}, sb};
        const Distance distance = core_distance(a, b, 6000);
        if (distance.high < 1e-3) continue;
        TestColliders bodies;
        bodies.add(a.shape, a.pose);
        bodies.add(b.shape, b.pose);
        const ContactQuery query{true, 10.0, 0.0};
        const auto contacts = bodies.contacts(0, 1, query);
        const double radii = a.radius() + b.radius();
        INFO(a.shape->name() << " " << b.shape->name() << " case " << k << " distance " << distance.low << " to "
                             << distance.high);
        check_contract(contacts, bodies, 0, 1, query);
        REQUIRE(!contacts.empty());
        // the solver creeps where faces are nearly parallel: both bounds hold always, and nearly meet almost always
        // (a contact that another one at the same place covers to 1e-8 of the size is left out, so that names last)
        REQUIRE(smallest_gap(contacts) < distance.high - radii + 1e-7);
        REQUIRE(smallest_gap(contacts) > distance.low - radii - 2e-8);
        converged += distance.high - distance.low < 1e-6 ? 1 : 0;
        ++compared;
      }
  REQUIRE(compared > 400);
  REQUIRE(converged > compared * 3 / 4);
}

TEST_CASE("overlapping boxes are as deep as the shortest way out") {
  // the depth of convex bodies is the minimum over directions of their overlap along it; sampled densely and refined
  Random r(13);
  int overlapping = 0, crossings = 0;
  for (int k = 0; k < 300; ++k) {
    const Box a{Vec3(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8))},
        b{Vec3(r.in(0.2, 0.8), r.in(0.2, 0.8), r.in(0.2, 0.8))};
    const Pose pa = random_pose(r, 0.6), pb = random_pose(r, 0.6);
    const auto overlap = [&](const Vec3& n) {
      return (pa.rotation.transpose() * n).cwiseAbs().dot(a.half) +
             (pb.rotation.transpose() * n).cwiseAbs().dot(b.half) - n.dot(pa.position - pb.position);
    };
    double depth = 1e300;
    Vec3 way = Vec3::UnitX();
    for (int i = 0; i < 4000; ++i) {
      const Vec3 n = r.direction();
      if (overlap(n) < depth) depth = overlap(way = n);
    }
    for (double step = 0.05; step > 1e-10; step *= 0.7)
      for (int i = 0; i < 40; ++i) {
        const Vec3 n = (way + step * r.vector()).normalized();
        if (overlap(n) < depth) depth = overlap(way = n);
      }
    if (depth < 1e-3) continue;
    ++overlapping;
    TestColliders bodies;
    bodies.add(a, pa);
    bodies.add(b, pb);
    const auto contacts = bodies.contacts(0, 1, {false, 0.0, 0.0});
    INFO("case " << k << " depth " << depth);
    REQUIRE(!contacts.empty());
    // a face is taken beside a crossing that is less deep by up to 5 %, and clipped away corners may be the deepest
    REQUIRE(-smallest_gap(contacts) < 1.051 * depth + 1e-6);
    REQUIRE(-smallest_gap(contacts) > 0.0);
    for (const Collision& c : contacts) {
      REQUIRE(overlap(c.normal) < 1.08 * depth + 1e-6);
      if (c.normal_owner == -1) ++crossings;
    }
  }
  REQUIRE(overlapping > 100);
  REQUIRE(crossings > 5);
}

TEST_CASE("the smallest gap changes continuously as shapes move into each other") {
  Random r(17);
  for (int i = 1; i < 4; ++i)
    for (int j = 1; j < 4; ++j)
      for (int k = 0; k < 40; ++k) {
        const SharedShape sa = random_shape(r, i), sb = random_shape(r, j);
        Pose pa = random_pose(r, 0.0), pb = random_pose(r, 0.0);
        const Vec3 way = r.direction();
        TestColliders bodies;
        bodies.add(sa, pa);
        bodies.add(sb, pb);
        double before = 0.0, touched = 0.0;
        bool first = true;
        const double step = 2e-4;
        // from afar until 5 mm deep: deeper the nearest way out may jump to another face
        for (double s = 3.0; s > 0.0; s -= step) {
          pa.position = s * way;
          bodies.place(0, pa);
          const double gap = smallest_gap(bodies.contacts(0, 1, {true, 0.02, 0.0}));
          if (!std::isfinite(gap)) continue;
          INFO(sa->name() << " " << sb->name() << " case " << k << " at " << s);
          if (!first) REQUIRE(std::abs(gap - before) < 1.5 * step);
          first = false;
          before = gap;
          touched = std::min(touched, gap);
          if (gap < -0.005) break;
        }
        REQUIRE(touched < -0.004);
      }
}
