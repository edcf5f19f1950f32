#include "engine/io/tessellation.hpp"

#include <cmath>

namespace impinge {

namespace {

constexpr int kAround = 48, kRings = 12;  // of a circle; of a quarter circle from pole to equator

// two caps whose centres lie at y = +-half_length, joined by a tube if they are apart
TriangleMesh round_body(double radius, double half_length) {
  TriangleMesh mesh;
  std::vector<std::pair<double, double>> rings;  // radius, y; from the upper pole down, poles left out
  for (int r = 1; r <= kRings; ++r) {
    const double angle = 0.5 * M_PI * r / kRings;
    rings.emplace_back(radius * std::sin(angle), half_length + radius * std::cos(angle));
  }
  for (int r = kRings; r >= 1; --r) {
    if (r == kRings && half_length == 0.0) continue;  // a sphere has one equator
    rings.emplace_back(rings[r - 1].first, -rings[r - 1].second);
  }
  mesh.vertices.emplace_back(0.0, half_length + radius, 0.0);
  for (const auto& [ring_radius, y] : rings) {
    for (int i = 0; i < kAround; ++i) {
      const double turn = 2.0 * M_PI * i / kAround;
      mesh.vertices.emplace_back(ring_radius * std::cos(turn), y, ring_radius * std::sin(turn));
    }
  }
  mesh.vertices.emplace_back(0.0, -half_length - radius, 0.0);

  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto vertex = [](std::size_t ring, int i) { return 1 + static_cast<int>(ring) * kAround + i % kAround; };
  for (int i = 0; i < kAround; ++i) mesh.triangles.push_back({0, vertex(0, i + 1), vertex(0, i)});
  for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
    for (int i = 0; i < kAround; ++i) {
      mesh.triangles.push_back({vertex(r, i), vertex(r, i + 1), vertex(r + 1, i + 1)});
      mesh.triangles.push_back({vertex(r, i), vertex(r + 1, i + 1), vertex(r + 1, i)});
    }
  }
  for (int i = 0; i < kAround; ++i) mesh.triangles.push_back({last, vertex(rings.size() - 1, i), vertex(rings.size() - 1, i + 1)});
  return mesh;
}

}  // namespace

TriangleMesh tessellate(const Shape& shape) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return round_body(sphere->radius, 0.0);
  if (const auto* capsule = std::get_if<Capsule>(&shape)) return round_body(capsule->radius, capsule->half_length);
  if (const auto* box = std::get_if<Box>(&shape)) return make_box_mesh(box->half)->mesh;
  if (const auto* mesh = std::get_if<MeshPointer>(&shape)) return (*mesh)->mesh;
  return {};
}

}  // namespace impinge
