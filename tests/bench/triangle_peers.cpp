// Triangle pairs of two meshes beside Embree's and FCL's, in the same run.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <iterator>
#include <limits>
#include <memory>
#include <string>

#include "engine/core/parallel.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

#ifdef IMPINGE_HAS_EMBREE
#include <embree3/rtcore.h>
#endif
#ifdef IMPINGE_HAS_FCL
#include <fcl/fcl.h>
#endif

using namespace impinge;
using namespace impinge::test;

namespace {

double process_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

using Pairs = std::vector<std::pair<int, int>>;
using Places = std::vector<Vec3>;

/// Two bodies of one mesh.
struct Scene {
  MeshPointer mesh;
  Pose pose;
  /// In frame k of the deformation, or at rest.
  std::array<Places, 2> places(int k, bool is_deforming) const {
    std::array<Places, 2> all;
    for (Vec3 p : mesh->mesh.vertices) {
      if (is_deforming)
        p *= 1.0 + 0.02 * std::sin(6.0 * p.x() + 0.3 * k) * std::sin(5.0 * p.y()) * std::sin(4.0 * p.z() + 0.1 * k);
      all[0].push_back(p), all[1].push_back(pose.apply(p));
    }
    return all;
  }
};

/// Whoever finds the pairs of a scene's triangles.
class Finder {
 public:
  virtual ~Finder() = default;
  virtual void place(const std::array<Places, 2>& at) = 0;
  virtual void fit() {}
  virtual void find() = 0;
  virtual Pairs pairs() const = 0;  ///< sorted
};

class Ours final : public Finder {
 public:
  explicit Ours(const Scene& scene) {
    bodies_.add(scene.mesh);
    bodies_.add(scene.mesh, scene.pose);
  }
  void place(const std::array<Places, 2>& at) override {
    for (int i = 0; i < 2; ++i) bodies_.place(i, at[static_cast<std::size_t>(i)]);
  }
  void find() override { phase_->find(bodies_.all(), pair_, found_); }
  Pairs pairs() const override {
    Pairs all;
    for (const TrianglePair& p : found_) all.emplace_back(p.triangle_a.value(), p.triangle_b.value());
    return all;
  }

 private:
  ColliderSet bodies_;
  std::unique_ptr<NarrowPhase> phase_ = find_entry(narrow_phases(), "bvh")->make();
  std::vector<BodyPair> pair_ = {{BodyIndex(0), BodyIndex(1), 0.0}};
  std::vector<TrianglePair> found_;
};

#ifdef IMPINGE_HAS_EMBREE
bool segment_meets(const Vec3& p, const Vec3& q, const TriangleCorners& c) {
  const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0], d = q - p, h = d.cross(e2), s = p - c[0], n = s.cross(e1);
  const double det = e1.dot(h);
  if (det == 0.0) return false;
  const double u = s.dot(h) / det, v = d.dot(n) / det, t = e2.dot(n) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 && t <= 1.0;
}

bool is_on_one_side(const TriangleCorners& of, const TriangleCorners& c) {
  const Vec3 n = (of[1] - of[0]).cross(of[2] - of[0]);
  const double x = n.dot(c[0] - of[0]), y = n.dot(c[1] - of[0]), z = n.dot(c[2] - of[0]);
  return (x > 0.0 && y > 0.0 && z > 0.0) || (x < 0.0 && y < 0.0 && z < 0.0);
}

bool plainly_meet(const TriangleCorners& a, const TriangleCorners& b) {
  if (!overlap(bounds_of(a[0], a[1], a[2]), bounds_of(b[0], b[1], b[2]))) return false;
  if (is_on_one_side(a, b) || is_on_one_side(b, a)) return false;
  for (int k = 0; k < 3; ++k)
    if (segment_meets(a[k], a[(k + 1) % 3], b) || segment_meets(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

class Embree final : public Finder {
 public:
  Embree(const Scene& scene, const std::array<Places, 2>& at, bool is_deforming)
      : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    for (int i = 0; i < 2; ++i) {
      Body& body = bodies_[i];
      body = {&scene.mesh->mesh.triangles, &at[static_cast<std::size_t>(i)], rtcNewScene(device_), nullptr};
      if (is_deforming) rtcSetSceneFlags(body.scene, RTC_SCENE_FLAG_DYNAMIC);
      rtcSetSceneBuildQuality(body.scene, is_deforming ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
      body.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
      if (is_deforming) rtcSetGeometryBuildQuality(body.geometry, RTC_BUILD_QUALITY_REFIT);
      rtcSetGeometryUserPrimitiveCount(body.geometry, static_cast<unsigned>(body.triangles->size()));
      rtcSetGeometryUserData(body.geometry, &body);
      rtcSetGeometryBoundsFunction(body.geometry, bounds, nullptr);
      rtcCommitGeometry(body.geometry);
      rtcAttachGeometry(body.scene, body.geometry);
      rtcCommitScene(body.scene);
    }
  }
  ~Embree() override {
    for (Body& body : bodies_) rtcReleaseGeometry(body.geometry), rtcReleaseScene(body.scene);
    rtcReleaseDevice(device_);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  void place(const std::array<Places, 2>& at) override {
    for (std::size_t i = 0; i < 2; ++i) bodies_[i].places = &at[i];
  }
  void fit() override {
    for (Body& body : bodies_) rtcCommitGeometry(body.geometry), rtcCommitScene(body.scene);
  }
  void find() override {
    found_.clear();
    rtcCollide(bodies_[0].scene, bodies_[1].scene, meet, this);
  }
  Pairs pairs() const override {
    Pairs sorted = found_;
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

 private:
  struct Body {
    const std::vector<Triangle>* triangles;
    const Places* places;
    RTCScene scene;
    RTCGeometry geometry;
    TriangleCorners corners(unsigned t) const {
      const Triangle& c = (*triangles)[t];
      return {(*places)[c[0]], (*places)[c[1]], (*places)[c[2]]};
    }
  };

  static void bounds(const RTCBoundsFunctionArguments* asked) {
    const TriangleCorners c = static_cast<const Body*>(asked->geometryUserPtr)->corners(asked->primID);
    const Aabb box = bounds_of(c[0], c[1], c[2]);
    float *low = &asked->bounds_o->lower_x, *high = &asked->bounds_o->upper_x;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::nextafter(static_cast<float>(box.min[axis]), -INFINITY);
      high[axis] = std::nextafter(static_cast<float>(box.max[axis]), INFINITY);
    }
  }
  static void meet(void* self, RTCCollision* near, unsigned count) {
    auto& own = *static_cast<Embree*>(self);
    for (unsigned i = 0; i < count; ++i)
      if (plainly_meet(own.bodies_[0].corners(near[i].primID0), own.bodies_[1].corners(near[i].primID1)))
        own.found_.emplace_back(near[i].primID0, near[i].primID1);
  }

  RTCDevice device_;
  Body bodies_[2];
  Pairs found_;
};

#endif

#ifdef IMPINGE_HAS_FCL
class Fcl final : public Finder {
 public:
  Fcl(const Scene& scene, const std::array<Places, 2>& at, bool is_deforming) {
    for (std::size_t i = 0; i < 2; ++i) {
      Model& model = *models_[i];
      model.beginModel(static_cast<int>(scene.mesh->mesh.triangles.size()), static_cast<int>(at[i].size()));
      std::vector<fcl::Triangle> triangles;
      for (const Triangle& t : scene.mesh->mesh.triangles)
        triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                               static_cast<std::size_t>(t[2]));
      model.addSubModel(is_deforming ? at[i] : scene.mesh->mesh.vertices, triangles);
      model.endModel();
    }
    if (is_deforming) return;
    pose_.linear() = scene.pose.rotation;
    pose_.translation() = scene.pose.position;
  }
  void place(const std::array<Places, 2>& at) override { at_ = &at; }
  void fit() override {
    for (std::size_t i = 0; i < 2; ++i) {
      models_[i]->beginReplaceModel();
      models_[i]->replaceSubModel((*at_)[i]);
      models_[i]->endReplaceModel(true);
    }
  }
  void find() override {
    result_.clear();
    const fcl::CollisionRequestd request(std::numeric_limits<std::size_t>::max(), false);
    fcl::collide(models_[0].get(), fcl::Transform3d::Identity(), models_[1].get(), pose_, request, result_);
  }
  Pairs pairs() const override {
    Pairs sorted;
    for (std::size_t i = 0; i < result_.numContacts(); ++i)
      sorted.emplace_back(result_.getContact(i).b1, result_.getContact(i).b2);
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }

 private:
  using Model = fcl::BVHModel<fcl::OBBRSSd>;
  std::array<std::shared_ptr<Model>, 2> models_{std::make_shared<Model>(), std::make_shared<Model>()};
  fcl::Transform3d pose_ = fcl::Transform3d::Identity();
  const std::array<Places, 2>* at_ = nullptr;
  fcl::CollisionResultd result_;
};
#endif

/// Ours first, then the peers that were found.
std::vector<std::pair<std::string, std::unique_ptr<Finder>>> finders(const Scene& scene,
                                                                     const std::array<Places, 2>& at,
                                                                     bool is_deforming) {
  std::vector<std::pair<std::string, std::unique_ptr<Finder>>> all;
  all.emplace_back("ours", std::make_unique<Ours>(scene));
#ifdef IMPINGE_HAS_EMBREE
  all.emplace_back("Embree", std::make_unique<Embree>(scene, at, is_deforming));
#endif
#ifdef IMPINGE_HAS_FCL
  all.emplace_back("FCL", std::make_unique<Fcl>(scene, at, is_deforming));
#endif
  (void)at, (void)is_deforming;
  return all;
}

struct Column {
  std::string name;
  std::vector<double> ms, ratios;  // of ours to it
  std::size_t different = 0;       // pairs, at most
};

struct Row {
  std::size_t triangles = 0, pairs = 0;
  std::vector<Column> columns;
};

std::size_t count_different(const Pairs& l, const Pairs& r) {
  Pairs apart;
  std::set_symmetric_difference(l.begin(), l.end(), r.begin(), r.end(), std::back_inserter(apart));
  return apart.size();
}

Row compare(const Scene& scene, bool is_deforming) {
  constexpr int kTimes = 15;
  std::array<Places, 2> at = scene.places(0, is_deforming);
  const auto all = finders(scene, at, is_deforming);
  Row row{2 * scene.mesh->mesh.triangles.size(), 0, {}};
  for (const auto& [name, finder] : all) row.columns.push_back({name, {}, {}, 0});
  for (int k = 0; k <= kTimes; ++k) {
    if (is_deforming) at = scene.places(k, true);
    std::vector<double> ms(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t at_turn = k % 2 == 0 ? i : all.size() - 1 - i;
      Finder& finder = *all[at_turn].second;
      if (is_deforming) finder.place(at);
      const double start = process_ms();
      if (is_deforming) finder.fit();
      finder.find();
      ms[at_turn] = process_ms() - start;
    }
    const Pairs found = all[0].second->pairs();
    row.pairs = found.size();
    for (std::size_t i = 0; i < all.size(); ++i) {
      Column& column = row.columns[i];
      column.different = std::max(column.different, count_different(found, all[i].second->pairs()));
      if (k == 0) continue;  // makes trees and allocates
      column.ms.push_back(ms[i]), column.ratios.push_back(ms[0] / ms[i]);
    }
  }
  return row;
}

double exponent(const std::vector<Row>& rows, std::size_t column) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Row& row : rows) {
    const double x = std::log(static_cast<double>(row.triangles)), y = std::log(median(row.columns[column].ms));
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double count = static_cast<double>(rows.size());
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

void print(const std::string& name, const Row& row) {
  fmt::print("{:<22} {:>9} {:>7} {:>10.3f}", name, row.triangles, row.pairs, median(row.columns[0].ms));
  for (std::size_t i = 1; i < row.columns.size(); ++i) {
    const Column& peer = row.columns[i];
    fmt::print(" | {:>10.3f} {:>6.2f} {:>5}", median(peer.ms), median(peer.ratios), peer.different);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

Pose pose_of(bool is_far) {
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  return is_far ? Pose{Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), Vec3(0.35, 0.22, 0.13)}
                : Pose{Eigen::AngleAxisd(0.05, axis).toRotationMatrix(), Vec3(0.010, 0.007, 0.003)};
}

void compare_all(int finest) {
  std::vector<std::pair<std::string, std::vector<MeshPointer>>> series(2);
  series[0].first = "icosphere";
  for (int k = 4; k <= finest; ++k) series[0].second.push_back(surface(icosphere(k)));
  series[1].first = "dragon";
  if (const std::string file = shared_file("meshes/dragon/dragon_20k.off"); !file.empty())
    series[1].second.push_back(surface(scaled_to(read_mesh(file), 2.0)));
  fmt::print("{:<22} {:>9} {:>7} {:>10}", "", "triangles", "pairs", "ours, ms");
  const Scene least{surface(icosphere(1)), {}};
  for (const auto& [name, finder] : finders(least, least.places(0, false), false))
    if (name != "ours") fmt::print(" | {:>10} {:>6} {:>5}", name + ", ms", "ratio", "other");
  fmt::print("\n");
  for (const auto& [name, meshes] : series)
    for (const bool is_deforming : {false, true})
      for (const bool is_far : {true, false}) {
        const std::string text =
            fmt::format("{} {} {}", name, is_deforming ? "deforming" : "rigid", is_far ? "far" : "near");
        std::vector<Row> rows;
        for (const MeshPointer& mesh : meshes)
          rows.push_back(compare({mesh, pose_of(is_far)}, is_deforming)), print(text, rows.back());
        if (rows.size() < 2) continue;
        fmt::print("  grow as");
        for (std::size_t i = 0; i < rows[0].columns.size(); ++i)
          fmt::print(" {} n^{:.2f}", rows[0].columns[i].name, exponent(rows, i));
        fmt::print("\n");
      }
}

}  // namespace

int main(int argc, char** argv) {
  int finest = 7;
  BenchArguments arguments(
      "bench_triangle_peers",
      "Triangle pairs of two meshes beside Embree's rtcCollide and FCL's collide over its OBB-RSS trees, in\n"
      "the same run: rigid ones, whose trees stay as they are, and deforming ones, whose trees are fitted\n"
      "before they are asked. Far and near pose of two icospheres, and a dragon. Processor time of one\n"
      "thread, ms. All are called in turn, 15 times and more; medians, and the median of the ratios of\n"
      "neighbours. Embree's callback tests the triangles in plain doubles, after their boxes; its list\n"
      "isn't sorted, nor is FCL's. FCL turns one body into the frame of the other, so that triangles that\n"
      "just touch may be told otherwise: the last column counts pairs that only one of the two has.");
  arguments.number("--finest", finest, {4, 8}, "K of the finest icosphere, 20·4^K triangles a body");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  compare_all(finest);
}
