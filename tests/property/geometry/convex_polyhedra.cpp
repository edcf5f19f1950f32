// Distance and depth of convex polyhedra against a brute force over their features.
#include "engine/geometry/convex/convex_gap.hpp"

#include <catch2/catch.hpp>

#include "engine/geometry/convex/convex_hull.hpp"
#include "engine/geometry/convex/convex_polyhedron.hpp"
#include "tests/support/geometry/brute_convex.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

class Polyhedron final : public ConvexSet {
 public:
  explicit Polyhedron(const std::vector<Vec3>& points) : solid_(convex_hull(points).mesh) {}
  Vec3 support(const Vec3& d) const override { return solid_.vertices()[solid_.support_vertex(d)]; }
  ContactFace facing(const Vec3& d) const override { return solid_.facing(d); }
  const ConvexPolyhedron* polyhedron() const override { return &solid_; }

 private:
  ConvexPolyhedron solid_;
};

std::vector<Vec3> random_points(Random& r) {
  std::vector<Vec3> points;
  const int count = 4 + r.below(14);
  switch (r.below(4)) {
    case 0:  // in a ball
      for (int i = 0; i < count; ++i) points.push_back(r.vector());
      break;
    case 1:  // on a sphere
      for (int i = 0; i < count; ++i) points.push_back(r.direction());
      break;
    case 2: {  // a box
      const Vec3 h(r.in(0.2, 1), r.in(0.2, 1), r.in(0.2, 1));
      for (int i = 0; i < 8; ++i)
        points.emplace_back(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
      break;
    }
    default: {  // a prism or a frustum
      const int sides = 3 + r.below(5);
      const double h = r.in(0.2, 1), top = r.below(2) ? 1.0 : r.in(0.2, 1);
      for (int i = 0; i < sides; ++i) {
        const double angle = 2.0 * M_PI * i / sides;
        points.emplace_back(std::cos(angle), -h, std::sin(angle));
        points.emplace_back(top * std::cos(angle), h, top * std::sin(angle));
      }
    }
  }
  return points;
}

TriangleMesh placed(const Polyhedron& p, const Pose& pose) {
  TriangleMesh mesh = p.polyhedron()->surface()->mesh;
  for (Vec3& v : mesh.vertices) v = pose.apply(v);
  return mesh;
}

struct Pair {
  std::vector<Vec3> a, b;
  Pose pose_a, pose_b;
  const char* kind = "";
};

Pair random_pair(Random& r, int number) {
  Pair p{random_points(r), random_points(r), {}, {}, "random"};
  p.pose_a.rotation = r.rotation();
  p.pose_b.rotation = r.rotation();
  p.pose_a.position = r.vector();
  p.pose_b.position = p.pose_a.position + r.in(0.0, 3.0) * r.direction();
  const auto stretch = [](std::vector<Vec3>& points, const Vec3& by) {
    for (Vec3& x : points) x = x.cwiseProduct(by);
  };
  switch (number % 10) {
    case 1:
      p.kind = "parallel";
      p.pose_b.rotation = p.pose_a.rotation;
      if (r.below(2)) p.b = p.a;
      break;
    case 2:
      p.kind = "nearly parallel";
      p.pose_b.rotation =
          Eigen::AngleAxisd(std::pow(10.0, r.in(-14.0, -3.0)), r.direction()).toRotationMatrix() * p.pose_a.rotation;
      break;
    case 3:
      p.kind = "coincident";
      p.b = p.a;
      p.pose_b = p.pose_a;
      if (r.below(2)) p.pose_b.position += 1e-9 * r.vector();
      break;
    case 4:
      p.kind = "nested";
      p.b = r.below(2) ? p.a : p.b;
      stretch(p.b, Vec3::Constant(std::pow(10.0, r.in(-3.0, -0.3))));
      p.pose_b.position = p.pose_a.position + 0.05 * r.vector();
      break;
    case 5:
      p.kind = "thin";
      stretch(p.a, {1.0, std::pow(10.0, r.in(-6.0, -1.0)), 1.0});
      break;
    case 6:
      p.kind = "needles";
      for (std::vector<Vec3>* points : {&p.a, &p.b})
        stretch(*points, {std::pow(10.0, r.in(-6.0, -2.0)), 1.0, std::pow(10.0, r.in(-6.0, -2.0))});
      if (r.below(2)) p.pose_b.rotation = p.pose_a.rotation;
      p.pose_b.position = p.pose_a.position + std::pow(10.0, r.in(-6.0, 0.0)) * r.direction();
      break;
    case 7: {
      p.kind = "scales";
      const double scale = std::pow(10.0, r.in(-6.0, 6.0));
      stretch(p.b, Vec3::Constant(scale));
      p.pose_b.position = p.pose_a.position + (1.0 + scale) * r.in(0.0, 2.0) * r.direction();
      break;
    }
    case 8:
      p.kind = "close";
      break;
    case 9:
      p.kind = "touching";
      break;
    default:
      break;
  }
  return p;
}

}  // namespace

TEST_CASE("distance and depth of convex polyhedra are those of their features") {
  Random r(20261122);
  int overlapping = 0, apart = 0;
  for (int i = 0; i < 10000; ++i) {
    Pair pair = random_pair(r, i);
    const Polyhedron a(pair.a), b(pair.b);
    if (i % 10 >= 8) {
      // moved along the direction between the nearest points until the gap is a given small one, or nothing
      for (int step = 0; step < 3; ++step) {
        const ConvexGap now = convex_gap({&a, pair.pose_a}, {&b, pair.pose_b});
        const double wanted = i % 10 == 9 ? 0.0 : std::pow(10.0, -2.0 - i % 130 / 10);
        pair.pose_a.position += (wanted - now.gap) * now.normal;
      }
    }
    const TriangleMesh mesh_a = placed(a, pair.pose_a), mesh_b = placed(b, pair.pose_b);
    const double size = a.polyhedron()->size() + b.polyhedron()->size();
    const BruteGap truth = brute_convex_gap(mesh_a, mesh_b);
    const ConvexGap found = convex_gap({&a, pair.pose_a}, {&b, pair.pose_b});
    (truth.overlaps ? overlapping : apart)++;
    const double error = std::abs(found.gap - truth.gap) / size;
    const double off = (found.point_a - found.point_b - found.gap * found.normal).norm() / size;
    INFO("case " << i << " " << pair.kind << " brute force " << truth.gap << " found " << found.gap << " size "
                 << size);
    CHECK(error <= 1e-9);
    CHECK(std::abs(found.normal.norm() - 1.0) < 1e-12);
    CHECK(off <= 1e-9);
  }
  CHECK(overlapping > 2000);
  CHECK(apart > 2000);
}

TEST_CASE("hulls of many corners, whose overlap a growing polytope finds, are as exact") {
  Random r(7);
  int overlapping = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<Vec3> points[2];
    for (std::vector<Vec3>& p : points) {
      const Vec3 stretch(r.in(0.1, 1), r.in(0.1, 1), 1.0);
      const bool is_drum = i % 3 == 0;
      for (int k = 0; k < 24; ++k) {
        const double angle = 2.0 * M_PI * k / 24;
        if (is_drum)
          p.emplace_back(std::cos(angle), 0.4, std::sin(angle)), p.emplace_back(std::cos(angle), -0.4, std::sin(angle));
        if (!is_drum)
          p.push_back(stretch.cwiseProduct(r.direction())), p.push_back(stretch.cwiseProduct(r.direction()));
      }
    }
    const Polyhedron a(points[0]), b(points[1]);
    Pose pose_a{r.rotation(), r.vector()}, pose_b{r.rotation(), Vec3::Zero()};
    if (i % 6 == 0) pose_b.rotation = pose_a.rotation;
    pose_b.position = pose_a.position + r.in(0.0, 1.5) * r.direction();
    const double size = a.polyhedron()->size() + b.polyhedron()->size();
    const BruteGap truth = brute_convex_gap(placed(a, pose_a), placed(b, pose_b));
    const ConvexGap found = convex_gap({&a, pose_a}, {&b, pose_b});
    overlapping += truth.overlaps ? 1 : 0;
    INFO("case " << i << " brute force " << truth.gap << " found " << found.gap);
    CHECK(std::abs(found.gap - truth.gap) <= 1e-9 * size);
    CHECK((found.point_a - found.point_b - found.gap * found.normal).norm() <= 1e-9 * size);
  }
  CHECK(overlapping > 20);
}
