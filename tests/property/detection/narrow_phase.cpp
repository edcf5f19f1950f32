// Every registered narrow phase against a reference that shares nothing with them but the triangle test, on random
// poses and on scenes made to be awkward; the same answer for any number of threads and for a phase that has worked
// before.
#include <catch2/catch.hpp>

#include <algorithm>

#include "engine/core/parallel.hpp"
#include "engine/core/rows.hpp"
#include "engine/geometry/triangle_intersection.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/indices.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/shapes.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

// all triangle pairs, no box test but a generous one
std::vector<TrianglePair> reference(std::span<const Collider> colliders, std::span<const BodyPair> pairs) {
  std::vector<TrianglePair> found;
  for (const BodyPair& p : pairs) {
    const Collider &a = colliders[p.a], &b = colliders[p.b];
    const auto &ta = a.mesh().mesh.triangles, &tb = b.mesh().mesh.triangles;
    for (int i = 0; i < static_cast<int>(ta.size()); ++i) {
      const TriangleCorners ca = corners(a, i);
      const Aabb box = bounds_of(ca[0], ca[1], ca[2]).inflated(2.0 * p.margin + 1e-6);
      for (int j = p.a == p.b ? i + 1 : 0; j < static_cast<int>(tb.size()); ++j) {
        const TriangleCorners cb = corners(b, j);
        if (!overlap(box, bounds_of(cb[0], cb[1], cb[2]))) continue;
        const auto shared = [&](int v) { return std::find(tb[j].begin(), tb[j].end(), v) != tb[j].end(); };
        if (p.a == p.b && std::any_of(ta[i].begin(), ta[i].end(), shared)) continue;
        if (triangles_intersect(ca, cb))
          found.push_back(triangle_pair(p.a, p.b, i, j, true));
        else if (p.margin > 0.0 && closest_features(ca, cb).squared_distance <= p.margin * p.margin)
          found.push_back(triangle_pair(p.a, p.b, i, j, false));
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

// one phase of each kind, kept over all scenes: what an old step left in a table must not show
struct Phases {
  std::vector<std::unique_ptr<NarrowPhase>> all;
  std::vector<std::string> names;
  Phases() {
    for (const auto& e : narrow_phases()) add(e, "", "");
    for (const auto& e : narrow_phases())
      if (e.name == "bvh")
        for (const char* volume : {"aabb", "obb", "sphere"}) add(e, "volume", volume);
    CHECK(all.size() == narrow_phases().size() + 3);
  }
  void add(const Entry<NarrowPhase>& entry, const std::string& setting, const std::string& value) {
    all.push_back(entry.make());
    names.push_back(std::string(entry.name) + " " + value);
    ParameterSet rows;
    all.back()->declare(Rows(rows));
    if (!setting.empty()) rows.find(setting)->set(value);
  }
  std::size_t check(const ColliderSet& set, const std::vector<BodyPair>& pairs) {
    const std::vector<TrianglePair> expected = reference(set.all(), pairs);
    for (std::size_t i = 0; i < all.size(); ++i) {
      INFO(names[i] << ", expected " << expected.size());
      std::vector<TrianglePair> found;
      for (int threads : {1, 2}) {
        set_thread_count(threads);
        all[i]->find(set.all(), pairs, found);
        set_thread_count(0);
        REQUIRE(found.size() == expected.size());
        REQUIRE(found == expected);
      }
    }
    return expected.size();
  }
};

// 300 poses of two meshes of about unit size, with and without margin
void check_poses(Phases& phases, const MeshPointer& a, const MeshPointer& b, int poses, std::uint64_t seed) {
  Random random(seed);
  ColliderSet set;
  set.add(a);
  set.add(b);
  std::size_t total = 0;
  for (int i = 0; i < poses; ++i) {
    set.place(0, random_pose(random, 0.9));
    set.place(1, random_pose(random, 0.9));
    const double margin = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.01 : 0.15;
    CAPTURE(seed, i, margin);
    total += phases.check(set, {body_pair(0, 1, margin)});
  }
  CHECK(total > 1000);
}

}  // namespace

TEST_CASE("narrow phases equal the reference on random poses of spheres, bumpy spheres and tori",
          "[narrow_phase][methods]") {
  Phases phases;
  const MeshPointer sphere = surface(icosphere(2)), torus = surface(bumpy_torus(24, 12)),
                    stone = surface(bumpy_sphere(2));
  check_poses(phases, sphere, torus, 100, 3001);
  check_poses(phases, stone, torus, 100, 3002);
  check_poses(phases, torus, torus, 100, 3003);
}

TEST_CASE("narrow phases equal the reference on random poses of scans", "[narrow_phase][methods]") {
  const std::string dragon = shared_file("meshes/dragon/dragon_5k.off"), human = shared_file("meshes/human.off");
  if (dragon.empty() || human.empty()) {
    WARN("skipped: the shared data folder is absent (IMPINGE_SHARED_DATA)");
    return;
  }
  Phases phases;
  check_poses(phases, surface(scaled_to(read_mesh(dragon), 2.0)), surface(scaled_to(read_mesh(human), 2.0)), 12, 3004);
}

TEST_CASE("narrow phases find the published pair counts of two icospheres", "[narrow_phase]") {
  const std::size_t far_counts[] = {174, 346, 702, 1400}, near_counts[] = {0, 0, 1221, 1814};
  for (const auto& e : narrow_phases())
    for (int k = 3; k <= (e.name == "brute_force" ? 5 : 6); ++k) {
      const std::unique_ptr<NarrowPhase> phase = e.make();
      ColliderSet set;
      const MeshPointer mesh = surface(icosphere(k));
      set.add(mesh);
      const Vec3 axis = Vec3(1, 2, 3).normalized();
      set.add(mesh, {Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), Vec3(0.35, 0.22, 0.13)});
      std::vector<TrianglePair> found;
      const std::vector<BodyPair> pairs{body_pair(0, 1, 0.0)};
      phase->find(set.all(), pairs, found);
      INFO(e.name << " ico" << k);
      CHECK(found.size() == far_counts[k - 3]);
      if (near_counts[k - 3] == 0) continue;
      set.place(1, Pose{Eigen::AngleAxisd(0.05, axis).toRotationMatrix(), Vec3(0.010, 0.007, 0.003)});
      phase->find(set.all(), pairs, found);
      CHECK(found.size() == near_counts[k - 3]);
    }
}

TEST_CASE("narrow phases equal the reference on boxes that touch, lie in one plane and share edges",
          "[narrow_phase][methods]") {
  Phases phases;
  Random random(3005);
  std::size_t total = 0;
  for (const Vec3& offset :
       {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(0.25, 1, 0.5), Vec3(0, 0, 0), Vec3(0.5, 0.5, 0)})
    for (double far : {0.0, 1e5}) {
      const MeshPointer mesh = surface(box(Vec3::Constant(0.5), {3, 2, 4}));
      const Mat3 rotation = random.rotation();
      const Vec3 base = far * random.vector();
      ColliderSet set;
      set.add(mesh, {rotation, base});
      set.add(mesh, {rotation, base + rotation * offset});
      for (double margin : {0.0, 1e-3, 0.4}) {
        CAPTURE(offset.transpose(), far, margin);
        const std::size_t found = phases.check(set, {body_pair(0, 1, margin)});
        CHECK(found > 0);  // they touch
        total += found;
      }
    }
  CHECK(total > 5000);
}

TEST_CASE("narrow phases equal the reference on slivers, triangles of no area and huge ones",
          "[narrow_phase][methods]") {
  Phases phases;
  Random random(3006);
  std::size_t total = 0;
  for (int round = 0; round < 60; ++round) {
    TriangleMesh soup[2];
    for (TriangleMesh& m : soup)
      for (int t = 0; t < 60; ++t) {
        Vec3 a = random.vector(), b = a + 0.3 * random.vector(), c = a + 0.3 * random.vector();
        switch (random.below(8)) {
          case 0:
            c = a + 0.5 * (b - a) + 1e-9 * random.vector();
            break;
          case 1:
            c = a + 0.5 * (b - a);
            break;
          case 2:
            b = c = a;
            break;
          case 3:
            b = a + 200.0 * random.vector(), c = a + 200.0 * random.vector();
            break;
          case 4:
            a.y() = b.y() = c.y() = 0.0;
            break;
          default:
            break;
        }
        const int first = static_cast<int>(m.vertices.size());
        m.vertices.insert(m.vertices.end(), {a, b, c});
        m.triangles.push_back({first, first + 1, first + 2});
      }
    ColliderSet set;
    set.add(surface(std::move(soup[0])));
    set.add(surface(std::move(soup[1])));
    for (double margin : {0.0, 0.02}) total += phases.check(set, {body_pair(0, 1, margin)});
  }
  CHECK(total > 2000);
}

TEST_CASE("narrow phases equal the reference on a mesh over a floor of two huge triangles", "[narrow_phase][methods]") {
  Phases phases;
  ColliderSet set;
  set.add(surface(sheet(1e4, 1)));
  set.add(surface(bumpy_sphere(3)), {Mat3::Identity(), Vec3(3.0, 0.2, 5.0)});
  CHECK(phases.check(set, {body_pair(0, 1, 0.0)}) > 20);
  CHECK(phases.check(set, {body_pair(0, 1, 0.05)}) > 50);
}

TEST_CASE("narrow phases equal the reference on many bodies, each pair with its own margin, and on self-collision",
          "[narrow_phase][methods]") {
  Phases phases;
  Random random(3007);
  ColliderSet set;
  std::vector<BodyPair> pairs;
  const int bodies = 45;  // more than a mark has bits
  for (int i = 0; i < bodies; ++i)
    set.add(surface(i % 2 == 0 ? icosphere(1, 0.5) : torus(0.4, 0.15, 12, 6)), random_pose(random, 0.9));
  // a ribbon that crosses itself
  TriangleMesh knot = bumpy_torus(30, 8);
  for (Vec3& v : knot.vertices) v = 0.5 * Vec3(v.x() * (1.0 - 0.9 * v.z() * v.z()), v.y() + 0.2 * v.x() * v.z(), v.z());
  set.add(surface(knot));
  for (int i = 0; i < bodies; ++i)
    for (int j = i + 1; j < bodies; ++j)
      if ((i * 7 + j) % 3 != 0) pairs.push_back(body_pair(i, j, (i + j) % 4 == 0 ? 0.0 : 0.01 * (j % 5)));
  pairs.push_back(body_pair(3, bodies, 0.02));
  std::sort(pairs.begin(), pairs.end());
  CHECK(phases.check(set, pairs) > 1000);
  CHECK(phases.check(set, {body_pair(bodies, bodies, 0.0)}) > 10);
  CHECK(phases.check(set, {body_pair(3, bodies, 0.02), body_pair(bodies, bodies, 0.01)}) > 10);
  CHECK(phases.check(set, {}) == 0);
}

TEST_CASE("narrow phases follow bodies that move, deform and part", "[narrow_phase][methods]") {
  Phases phases;
  ColliderSet set;
  const MeshPointer mesh = surface(icosphere(2));
  set.add(mesh);
  set.add(mesh);
  std::size_t first = 0;
  for (int k = 0; k < 40; ++k) {
    std::vector<Vec3> world = mesh->mesh.vertices;
    for (Vec3& p : world) {
      p *= 1.0 + 0.02 * std::sin(6 * p.x() + 0.3 * k) * std::sin(5 * p.y()) * std::sin(4 * p.z() + 0.1 * k);
      p += Vec3(0.08 * k, 0.01 * k, 0);
    }
    set.place(1, std::move(world));
    CAPTURE(k);
    const std::size_t count = phases.check(set, {body_pair(0, 1, k % 2 == 0 ? 0.0 : 0.03)});
    if (k == 1) first = count;
    if (k == 39) CHECK(count == 0);
  }
  CHECK(first > 100);
}
