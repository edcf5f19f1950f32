// Meshes as the bytes of files, written here by hand so that readers are not checked against our own writer alone.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/geometry/triangle_mesh.hpp"

namespace impinge::test {

/// Vertices of a tetrahedron whose coordinates no single-precision number holds, outward faces.
inline TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0.2, 0.3}, {1.1, 0.2, 0.3}, {0.1, 1.2, 0.3}, {0.1, 0.2, 1.3000000000000003}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

inline std::string off_text(const TriangleMesh& mesh) {
  std::string out = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) out += fmt::format("{} {} {}\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

inline std::string obj_text(const TriangleMesh& mesh) {
  std::string out = "# a comment\n";
  for (const Vec3& v : mesh.vertices) out += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles) out += fmt::format("f {}//1 {}//1 {}//1\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return out;
}

inline std::string ply_head(const TriangleMesh& mesh, const char* format) {
  return fmt::format(
      "ply\nformat {} 1.0\ncomment made by a test\nelement vertex {}\nproperty double x\nproperty double y\nproperty "
      "uchar red\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices.size(), mesh.triangles.size());
}

inline std::string ply_ascii(const TriangleMesh& mesh) {
  std::string out = ply_head(mesh, "ascii");
  for (const Vec3& v : mesh.vertices) out += fmt::format("{} {} 7 {}\n", v.x(), v.y(), v.z());
  for (const Triangle& t : mesh.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

inline std::string ply_binary(const TriangleMesh& mesh, bool big) {
  std::string out = ply_head(mesh, big ? "binary_big_endian" : "binary_little_endian");
  const auto put = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big) std::reverse(raw, raw + sizeof value);
    out.append(raw, sizeof value);
  };
  for (const Vec3& v : mesh.vertices) put(v.x()), put(v.y()), put(std::uint8_t{7}), put(v.z());
  for (const Triangle& t : mesh.triangles) {
    put(std::uint8_t{3});
    for (const int v : t) put(v);
  }
  return out;
}

inline std::string stl_ascii(const TriangleMesh& mesh) {
  std::string out = "solid a name\n";
  for (const Triangle& t : mesh.triangles) {
    out += "facet normal 0 0 0\n outer loop\n";
    for (const int v : t)
      out += fmt::format("  vertex {} {} {}\n", mesh.vertices[v].x(), mesh.vertices[v].y(), mesh.vertices[v].z());
    out += " endloop\nendfacet\n";
  }
  return out + "endsolid a name\n";
}

inline std::string stl_binary(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  const auto put = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    out.append(raw, sizeof value);
  };
  put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(0.0f);
    for (const int v : t)
      for (int i = 0; i < 3; ++i) put(static_cast<float>(mesh.vertices[v][i]));
    put(std::uint16_t{0});
  }
  return out;
}

}  // namespace impinge::test
