#include "tests/support/geometry/meshes.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>

namespace impinge::test {
namespace {

double bump(const Vec3& p) {
  return std::sin(3.1 * p.x() + 0.4) * std::sin(2.7 * p.y() - 0.3) * std::cos(3.7 * p.z()) +
         0.4 * std::sin(9.0 * p.x() + 7.0 * p.z());
}

}  // namespace

TriangleMesh icosphere(int k, double radius) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleMesh m;
  m.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : m.vertices) v.normalize();
  for (int level = 0; level < k; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [it, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(m.vertices.size()));
      if (is_new) m.vertices.push_back((m.vertices[a] + m.vertices[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(m.triangles.size() * 4);
    for (const Triangle& t : m.triangles) {
      const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    m.triangles = std::move(finer);
  }
  for (Vec3& v : m.vertices) v *= radius;
  return m;
}

TriangleMesh torus(double major, double minor, int around, int across) {
  TriangleMesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2.0 * M_PI * i / around, v = 2.0 * M_PI * j / across, r = major + minor * std::cos(v);
      m.vertices.emplace_back(r * std::cos(u), minor * std::sin(v), r * std::sin(u));
    }
  const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      m.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      m.triangles.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return m;
}

TriangleMesh bumpy_sphere(int k, double amplitude) {
  TriangleMesh m = icosphere(k);
  for (Vec3& v : m.vertices) v *= 1.0 + amplitude * bump(v);
  return m;
}

TriangleMesh bumpy_torus(int around, int across, double amplitude) {
  const double major = 1.0, minor = 0.4;
  TriangleMesh m = torus(major, minor, around, across);
  for (Vec3& v : m.vertices) {
    const Vec3 ring = major * Vec3(v.x(), 0.0, v.z()).normalized();
    v = ring + (v - ring) * (1.0 + amplitude * bump(1.5 * v));
  }
  return m;
}

TriangleMesh box(const Vec3& half, const Eigen::Vector3i& cells) {
  TriangleMesh m;
  std::map<std::array<int, 3>, int> ids;
  const auto vertex = [&](const std::array<int, 3>& c) {
    const auto [it, is_new] = ids.try_emplace(c, static_cast<int>(m.vertices.size()));
    if (is_new) {
      Vec3 p;
      for (int d = 0; d < 3; ++d) p[d] = half[d] * (2.0 * c[d] / cells[d] - 1.0);
      m.vertices.push_back(p);
    }
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < cells[u]; ++i)
        for (int j = 0; j < cells[v]; ++j) {
          const auto at = [&](int di, int dj) {
            std::array<int, 3> c{};
            c[axis] = side * cells[axis], c[u] = i + di, c[v] = j + dj;
            return vertex(c);
          };
          const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          if (side == 1) {
            m.triangles.insert(m.triangles.end(), {{a, b, c}, {a, c, d}});
          } else {
            m.triangles.insert(m.triangles.end(), {{a, c, b}, {a, d, c}});
          }
        }
    }
  return m;
}

void append(TriangleMesh& mesh, const TriangleMesh& other, const Vec3& shift) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (const Vec3& v : other.vertices) mesh.vertices.push_back(v + shift);
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh sheet(double half, int cells) {
  TriangleMesh m;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j)
      m.vertices.emplace_back(half * (2.0 * i / cells - 1.0), 0.0, half * (2.0 * j / cells - 1.0));
  const auto at = [&](int i, int j) { return i * (cells + 1) + j; };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      m.triangles.insert(m.triangles.end(),
                         {{at(i, j), at(i, j + 1), at(i + 1, j)}, {at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)}});
  return m;
}

std::string shared_file(const std::string& name) {
  const char* set = std::getenv("IMPINGE_SHARED_DATA");
  const std::filesystem::path folder = set != nullptr ? set : std::string(IMPINGE_SOURCE_DIR) + "/../shared/data";
  const std::filesystem::path path = folder / name;
  return std::filesystem::exists(path) ? path.string() : "";
}

MeshPointer surface(TriangleMesh mesh) {
  auto made = std::make_shared<SurfaceMesh>();
  made->mesh = std::move(mesh);
  made->topology = make_topology(made->mesh);
  return made;
}

TriangleMesh scaled_to(TriangleMesh mesh, double longest_side) {
  Aabb box;
  for (const Vec3& v : mesh.vertices) box.include(v);
  const double scale = longest_side / box.extent().maxCoeff();
  for (Vec3& v : mesh.vertices) v = scale * (v - box.center());
  return mesh;
}

int ColliderSet::add(MeshPointer mesh, const Pose& pose) {
  Collider c;
  c.mean_edge = mean_edge_length(mesh->mesh);
  shapes_.emplace_back(std::move(mesh));
  vertices_.emplace_back();
  still_.emplace_back();
  colliders_.push_back(c);
  const int body = static_cast<int>(colliders_.size()) - 1;
  colliders_[body].shape = shapes_.back().get();
  place(body, pose);
  return body;
}

void ColliderSet::place(int body, const Pose& pose) {
  const std::vector<Vec3>& local = colliders_[body].mesh().mesh.vertices;
  std::vector<Vec3> world(local.size());
  for (std::size_t i = 0; i < local.size(); ++i) world[i] = pose.apply(local[i]);
  place(body, std::move(world));
  colliders_[body].pose = pose;
  colliders_[body].vertex_velocities = {};
}

void ColliderSet::place(int body, std::vector<Vec3> world) {
  vertices_[body] = std::move(world);
  Collider& c = colliders_[body];
  c.vertices = vertices_[body];
  c.vertex_velocities = still_[body] = std::vector<Vec3>(c.vertices.size(), Vec3::Zero());
  c.bounds = {};
  for (const Vec3& v : c.vertices) c.bounds.include(v);
}

Pose random_pose(Random& random, double reach) {
  const Mat3 rotation = random.rotation();
  return {rotation, reach * random.vector()};
}

}  // namespace impinge::test
