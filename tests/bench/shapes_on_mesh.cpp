// What a step costs with shapes by formula on meshes of more and more triangles.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <map>
#include <string>

#include "engine/core/parallel.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

#ifdef IMPINGE_HAS_BULLET
#include <btBulletDynamicsCommon.h>
#endif

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kFrame = 1.0 / 60.0, kSize = 0.2;  // s; m, of every shape
constexpr int kSubsteps = 4, kBefore = 20, kMeasured = 31;

double process_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Of a hilly field of 4 m, at (x, z).
double height(double x, double z) {
  return 0.06 * std::sin(1.7 * x + 0.3) * std::cos(2.3 * z) + 0.02 * std::sin(5.1 * x + 3.7 * z);
}

/// The field, closed below: 2 n² triangles on top.
TriangleMesh terrain(int n) {
  constexpr double kHalf = 2.0;
  TriangleMesh m;
  const auto at = [&](int i, int j) { return i * (n + 1) + j; };
  const auto place = [&](int i) { return kHalf * (2.0 * i / n - 1.0); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) m.vertices.emplace_back(place(i), height(place(i), place(j)), place(j));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      m.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      m.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  std::vector<int> rim;  // counter-clockwise seen from below
  for (int i = 0; i < n; ++i) rim.push_back(at(i, 0));
  for (int j = 0; j < n; ++j) rim.push_back(at(n, j));
  for (int i = n; i > 0; --i) rim.push_back(at(i, n));
  for (int j = n; j > 0; --j) rim.push_back(at(0, j));
  const int first = static_cast<int>(m.vertices.size()), count = static_cast<int>(rim.size());
  for (const int v : rim) {
    const Vec3 x = m.vertices[static_cast<std::size_t>(v)];
    m.vertices.emplace_back(x.x(), -1.0, x.z());
  }
  const int middle = static_cast<int>(m.vertices.size());
  m.vertices.emplace_back(0.0, -1.0, 0.0);
  for (int k = 0; k < count; ++k) {
    const int a = rim[static_cast<std::size_t>(k)], b = rim[static_cast<std::size_t>((k + 1) % count)], c = first + k,
              d = first + (k + 1) % count;
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({b, d, c});
    m.triangles.push_back({c, d, middle});
  }
  return m;
}

/// What shapes rest on: a mesh, and where its highest place is near (x, z).
struct Ground {
  std::string name;
  MeshPointer mesh;
  double top(double x, double z) const {
    double y = -INFINITY;
    const TriangleMesh& m = mesh->mesh;
    for (const Triangle& t : m.triangles) {
      const Vec3 &a = m.vertices[t[0]], e1 = m.vertices[t[1]] - a, e2 = m.vertices[t[2]] - a;
      const double det = e1.x() * e2.z() - e1.z() * e2.x();
      if (det == 0.0) continue;
      const double dx = x - a.x(), dz = z - a.z();
      const double u = (dx * e2.z() - dz * e2.x()) / det, v = (e1.x() * dz - e1.z() * dx) / det;
      if (u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9) y = std::max(y, a.y() + u * e1.y() + v * e2.y());
    }
    return y;
  }
};

SharedShape shape_named(const std::string& name) {
  const double r = 0.5 * kSize;
  if (name == "sphere") return Sphere{r};
  if (name == "box") return Box{Vec3::Constant(r)};
  if (name == "capsule") return Capsule{0.5 * r, r};
  if (name == "cylinder") return made("cylinder", {{"radius", r}, {"length", kSize}});
  if (name == "cone") return made("cone", {{"radius", r}, {"length", kSize}});
  std::vector<Vec3> points;
  for (const Vec3& v : icosphere(1, r).vertices) points.push_back(v);
  return made_hull(points);
}

void settle(World& world) {
  world.parameters.simulation.sleeping = false;
  world.parameters.simulation.substeps = kSubsteps;
  world.parameters.simulation.frame_time = kFrame;
  world.parameters.contact.friction = 0.5;
}

void add_ground(World& world, const Ground& ground) {
  BodyDescription d;
  d.name = "ground";
  d.kind = BodyKind::fixed;
  d.shape = ground.mesh;
  world.add_body(d);
}

/// So many shapes on a square about the middle, each over its own place.
void add_shapes(World& world, const Ground& ground, const std::string& shape, const std::string& motion, int count) {
  const SharedShape made = shape_named(shape);
  const int row = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int k = 0; k < count; ++k) {
    const double apart = row == 1 ? 0.0 : std::min(0.22, 3.7 / row);
    const double x = apart * (k % row - 0.5 * (row - 1)) + 0.013, z = apart * (k / row - 0.5 * (row - 1)) + 0.007;
    const double clear = (motion == "fall" ? 1.5 : 0.005) + (count > 1 ? 0.02 : 0.0);
    BodyDescription d = dynamic_body(fmt::format("{}{}", shape, k), made, Vec3::Zero());
    double least = 0.0;
    const Aabb box = made->bounds({});
    for (const double dx : {-0.5, 0.0, 0.5})  // over the highest of what is below
      for (const double dz : {-0.5, 0.0, 0.5}) {
        const double y = count > 1 && ground.name == "terrain" ? height(x + dx * kSize, z + dz * kSize)
                                                               : ground.top(x + dx * kSize, z + dz * kSize);
        if (std::isfinite(y)) least = (dx == -0.5 && dz == -0.5) ? y : std::max(least, y);
      }
    if (shape == "sphere" && motion != "fall") least = ground.top(x, z);
    d.position = Vec3(x, least - box.min.y() + clear, z);
    if (motion == "fall") d.velocity = Vec3(0.0, -3.0, 0.0);
    if (motion == "roll") d.velocity = Vec3(0.8, 0.0, 0.3), d.angular_velocity = Vec3(0.3, 0.0, -0.8) / (0.5 * kSize);
    d.mass = 1.0;
    world.add_body(d);
  }
}

#ifdef IMPINGE_HAS_BULLET
/// The world's bodies in Bullet, each by its own shape.
class Bullet {
 public:
  Bullet(const World& world, const Ground& ground) {
    dynamics_.setGravity(btVector3(0, -9.81, 0));
    for (const Vec3& v : ground.mesh->mesh.vertices) vertices_.push_back(vector(v));
    for (const Triangle& t : ground.mesh->mesh.triangles) indices_.insert(indices_.end(), t.begin(), t.end());
    const btIndexedMesh part = [&] {
      btIndexedMesh m;
      m.m_numTriangles = static_cast<int>(ground.mesh->mesh.triangles.size());
      m.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices_.data());
      m.m_triangleIndexStride = 3 * sizeof(int);
      m.m_numVertices = static_cast<int>(vertices_.size());
      m.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices_.data());
      m.m_vertexStride = sizeof(btVector3);
      return m;
    }();
    triangles_.addIndexedMesh(part, PHY_INTEGER);
    for (const Body& body : world.bodies()) {
      const bool moves = body.kind() == BodyKind::dynamic;
      std::unique_ptr<btCollisionShape> shape = moves ? shape_of(*body.shape) : ground_shape();
      btVector3 inertia(0, 0, 0);
      if (moves) shape->calculateLocalInertia(1.0, inertia);
      btRigidBody::btRigidBodyConstructionInfo info(moves ? 1.0 : 0.0, nullptr, shape.get(), inertia);
      info.m_startWorldTransform.setIdentity();
      if (moves) info.m_startWorldTransform.setOrigin(vector(body.pose.position));
      info.m_friction = 0.5;
      bodies_.push_back(std::make_unique<btRigidBody>(info));
      if (moves) {
        bodies_.back()->setLinearVelocity(vector(body.twist().linear));
        bodies_.back()->setAngularVelocity(vector(body.twist().angular));
      }
      bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
      shapes_.push_back(std::move(shape));
      dynamics_.addRigidBody(bodies_.back().get());
    }
  }
  ~Bullet() {
    for (const auto& body : bodies_) dynamics_.removeRigidBody(body.get());
  }
  void step() { dynamics_.stepSimulation(kFrame, kSubsteps, kFrame / kSubsteps); }

 private:
  static btVector3 vector(const Vec3& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
  }
  std::unique_ptr<btCollisionShape> ground_shape() {
    return std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
  }
  static std::unique_ptr<btCollisionShape> shape_of(const Shape& shape) {
    const double r = 0.5 * kSize;
    const auto s = [](double x) { return static_cast<btScalar>(x); };
    if (shape.name() == "sphere") return std::make_unique<btSphereShape>(s(r));
    if (shape.name() == "box") return std::make_unique<btBoxShape>(vector(Vec3::Constant(r)));
    if (shape.name() == "capsule") return std::make_unique<btCapsuleShape>(s(0.5 * r), s(2.0 * r));
    if (shape.name() == "cylinder") return std::make_unique<btCylinderShape>(vector(Vec3::Constant(r)));
    if (shape.name() == "cone") return std::make_unique<btConeShape>(s(r), s(kSize));
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& v : icosphere(1, r).vertices) hull->addPoint(vector(v));
    return hull;
  }

  std::vector<btVector3> vertices_;
  std::vector<int> indices_;
  btTriangleIndexVertexArray triangles_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld dynamics_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};
#else
struct Bullet {
  Bullet(const World&, const Ground&) {}
  void step() {}
};
#endif

struct Row {
  std::size_t triangles = 0;
  double step = 0.0, mean = 0.0, most = 0.0, broad = 0.0, narrow = 0.0, response = 0.0, integrate = 0.0;
  double contacts = 0.0, peer = 0.0, peer_mean = 0.0;
  std::uint64_t hash = 0;  // of the last state
};

Row measure(const Ground& ground, const std::string& shape, const std::string& motion, int count) {
  World world;
  settle(world);
  add_ground(world, ground);
  add_shapes(world, ground, shape, motion, count);
  world.start();
  Bullet bullet(world, ground);
  Row row;
  row.triangles = ground.mesh->mesh.triangles.size();
  std::map<std::string, std::vector<double>> ms;
  const int before = motion == "rest" ? kBefore : 1;
  for (int k = 0; k < before + kMeasured; ++k) {
    double own = 0.0, peer = 0.0;
    const auto run = [&](bool is_ours) {
      const double start = process_ms();
      is_ours ? world.step() : bullet.step();
      (is_ours ? own : peer) = process_ms() - start;
    };
    run(k % 2 == 0), run(k % 2 != 0);
    if (k < before) continue;  // makes trees and allocates, comes to rest
    const FrameStats& stats = world.record().stats;
    ms["step"].push_back(own), ms["peer"].push_back(peer);
    ms["broad"].push_back(stats.times.broad_ms), ms["narrow"].push_back(stats.times.narrow_ms);
    ms["response"].push_back(stats.times.response_ms + stats.times.assemble_ms);
    ms["integrate"].push_back(stats.times.integrate_ms);
    row.contacts += static_cast<double>(stats.contacts) / kMeasured;
    row.mean += own / kMeasured, row.peer_mean += peer / kMeasured;
    row.most = std::max(row.most, own);
  }
  row.hash = world.state_hash();
  row.step = median(ms["step"]), row.peer = median(ms["peer"]);
  row.broad = median(ms["broad"]), row.narrow = median(ms["narrow"]);
  row.response = median(ms["response"]), row.integrate = median(ms["integrate"]);
  return row;
}

double exponent(const std::vector<Row>& rows, double Row::*ms) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Row& row : rows) {
    const double x = std::log(static_cast<double>(row.triangles)), y = std::log(row.*ms);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double count = static_cast<double>(rows.size());
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

void print_head() {
  fmt::print("{:<30} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>17}\n",
             "ms a frame of four sub-steps", "triangles", "contacts", "step", "mean", "most", "broad", "narrow",
             "response", "Bullet", "mean", "last state");
}

void print(const std::string& name, const Row& row) {
  fmt::print("{:<30} {:>9} {:>9.1f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f}  {:016x}\n",
             name, row.triangles, row.contacts, row.step, row.mean, row.most, row.broad, row.narrow, row.response,
             row.peer, row.peer_mean, row.hash);
  std::fflush(stdout);
}

struct Wanted {
  int finest = 5, many = 300;
  std::string mesh, shape, motion;
};

std::vector<Ground> grounds(const Wanted& wanted, const std::string& name) {
  std::vector<Ground> all;
  if (name.ends_with(".off")) return {{name.substr(name.rfind('/') + 1), surface(scaled_to(read_mesh(name), 2.0))}};
  for (int k = 0; k <= wanted.finest; ++k)
    all.push_back({name, surface(name == "terrain" ? terrain(23 << k) : icosphere(3 + k))});
  return all;
}

const std::vector<std::string> kShapes = {"sphere", "capsule", "box", "cylinder", "cone", "hull"};
const std::vector<std::string> kMotions = {"rest", "roll", "fall"};

std::string mesh_fault(const std::string& name) {
  if (name == "terrain" || name == "sphere") return "";
  return name.ends_with(".off") && file_fault(name).empty() ? "" : "terrain, sphere or an .off file that is there";
}

void compare_one(const Wanted& wanted, const std::string& mesh) {
  const std::vector<Ground> of = grounds(wanted, mesh);
  for (const std::string& shape : kShapes)
    for (const std::string& motion : kMotions) {
      if ((!wanted.shape.empty() && wanted.shape != shape) || (!wanted.motion.empty() && wanted.motion != motion))
        continue;
      std::vector<Row> rows;
      for (const Ground& ground : of) {
        rows.push_back(measure(ground, shape, motion, 1));
        print(fmt::format("{}, {} on {}", motion, shape, ground.name), rows.back());
      }
      if (rows.size() > 1)
        fmt::print("  grows as n^{:.2f}, mean n^{:.2f}; Bullet n^{:.2f}\n", exponent(rows, &Row::step),
                   exponent(rows, &Row::mean), exponent(rows, &Row::peer));
    }
}

void compare_many(const Wanted& wanted) {
  for (const std::string& shape : kShapes) {
    if (!wanted.shape.empty() && wanted.shape != shape) continue;
    const Row few = measure({"terrain", surface(terrain(23))}, shape, "rest", wanted.many),
              lots = measure({"terrain", surface(terrain(362))}, shape, "rest", wanted.many);
    print(fmt::format("{} of {}", wanted.many, shape), few);
    print(fmt::format("{} of {}", wanted.many, shape), lots);
    fmt::print("  costs {:.2f} times as much, its narrow phase {:.2f}; Bullet {:.2f}\n", lots.step / few.step,
               lots.narrow / few.narrow, lots.peer / few.peer);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Wanted wanted;
  BenchArguments arguments(
      "bench_shapes_on_mesh",
      "What a step costs with shapes by formula on meshes of more and more triangles: at rest on them,\n"
      "rolling (or sliding) over them, falling onto them; one shape, and many on one mesh. A step is a\n"
      "frame of 1/60 s in four sub-steps, as World::step makes it, its record included. Processor time of\n"
      "one thread, ms; the median over the frames that are measured (all: their mean where it says so),\n"
      "parts by the stages' own clocks. Bullet's btBvhTriangleMeshShape, where it was found (libbullet-\n"
      "dev), makes the same frames in turn: four steps of 1/240 s, as it comes, double or single as Debian\n"
      "has it.");
  arguments.number("--finest", wanted.finest, {0, 6}, "K of the finest mesh, 4^K times the coarsest's triangles");
  arguments.word("--mesh", wanted.mesh, mesh_fault, "terrain, sphere or FILE.off alone; all unless given");
  arguments.word("--shape", wanted.shape, one_of(kShapes),
                 "sphere, capsule, box, cylinder, cone or hull alone; all unless given");
  arguments.word("--motion", wanted.motion, one_of(kMotions), "rest, roll or fall alone; all unless given");
  arguments.number("--many", wanted.many, {0}, "shapes on one mesh");
  arguments.read_or_exit(argc, argv);
  set_thread_count(1);
  print_head();
  for (const char* mesh : {"terrain", "sphere"})
    if (wanted.mesh.empty() || wanted.mesh == mesh) compare_one(wanted, mesh);
  if (wanted.mesh.ends_with(".off")) compare_one(wanted, wanted.mesh);
  if (wanted.mesh.empty()) {
    for (const char* file : {"bunny/bunny.off", "dragon/dragon_5k.off", "human/head.off"})
      compare_one(wanted, std::string(IMPINGE_SOURCE_DIR) + "/scenes/meshes/" + file);
    if (const std::string file = shared_file("meshes/dragon/dragon_20k.off"); !file.empty()) compare_one(wanted, file);
  }
  if (wanted.many > 0 && (wanted.mesh.empty() || wanted.mesh == "terrain")) compare_many(wanted);
}
