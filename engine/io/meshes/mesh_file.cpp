#include "engine/io/meshes/mesh_file.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_readers.hpp"

namespace impinge {

namespace {

bool has_own_reader(const std::string& end) { return end == ".ply" || end == ".off" || end == ".obj" || end == ".stl"; }

void check_faces(const std::string& name, const TriangleMesh& mesh) {
  if (mesh.triangles.empty())
    throw InputError(name + ": has no faces; a closed surface of triangles is wanted; export the mesh with its faces");
}

}  // namespace

std::string ending(const std::string& name) {
  std::string text = std::filesystem::path(name).extension().string();
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

TriangleMesh parse_mesh(const std::string& name, std::string_view bytes) {
  const std::string end = ending(name);
  if (end != ".stl") bytes = without_byte_order_mark(bytes);  // whose binary form begins with any 80 bytes
  TriangleMesh mesh;
  if (end == ".ply")
    mesh = read_ply(name, bytes);
  else if (end == ".off")
    mesh = read_off(name, bytes);
  else if (end == ".obj")
    mesh = read_obj(name, bytes);
  else if (end == ".stl")
    mesh = read_stl(name, bytes);
  else
    throw InputError(name + ": this ending is not read from memory; ply, off, obj and stl are; convert it to PLY");
  check_faces(name, mesh);
  return mesh;
}

TriangleMesh read_mesh(const std::filesystem::path& path, const FileGuard& guard, MeshOrigin* origin) {
  const std::string bytes = read_file(path, kMostMeshBytes), end = ending(path.string());
  if (has_own_reader(end)) return parse_mesh(path.string(), bytes);
  MeshOrigin own;
  TriangleMesh mesh =
      end == ".gltf" || end == ".glb" ? read_gltf(path, guard, own) : read_with_assimp(path, guard, own);
  if (origin != nullptr) *origin = std::move(own);
  check_faces(path.string(), mesh);
  return mesh;
}

void write_ply(const std::filesystem::path& path, std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");
  std::string out = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double "
      "z\n"
      "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      vertices.size(), triangles.size());
  const std::size_t head = out.size();
  out.resize(head + vertices.size() * 24 + triangles.size() * 13);
  char* at = out.data() + head;
  for (const Vec3& v : vertices) {
    std::memcpy(at, v.data(), 24);
    at += 24;
  }
  for (const Triangle& t : triangles) {
    *at++ = 3;
    std::memcpy(at, t.data(), 12);
    at += 12;
  }
  write_file(path, out);
}

}  // namespace impinge
