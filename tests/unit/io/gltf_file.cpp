// glTF as people have it: integers for coordinates, instances, mirrors, strips, parts of arrays; against the positions that
// the specification's formulas give.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/geometry/mass_properties.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr int kTet[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::uint16_t kPyramidFaces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
constexpr const char* kPlainNodes = R"([{"mesh":0}])";

/// A document of one mesh in a.gltf and a.bin. Accessors are numbered as they are added.
class GltfFile {
 public:
  /// Elements `stride` bytes apart; `more` is put into the accessor.
  template <typename T>
  int add(const std::vector<T>& numbers, int components, int type, const std::string& more = "",
          std::size_t stride = 0) {
    const std::size_t size = sizeof(T) * static_cast<std::size_t>(components);
    const std::size_t count = numbers.size() / static_cast<std::size_t>(components), step = stride > 0 ? stride : size;
    const std::string shape = components == 1 ? "SCALAR" : fmt::format("VEC{}", components);
    accessors_ += fmt::format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                              accessors_.empty() ? "" : ",", count_, type, count, shape, more);
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + (count * step + 3) / 4 * 4, '\0');
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(bytes_.data() + begin + i * step, numbers.data() + i * static_cast<std::size_t>(components), size);
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", views_.empty() ? "" : ",", begin,
                          count * step, stride > 0 ? fmt::format(R"(,"byteStride":{})", stride) : "");
    return count_++;
  }

  /// `more` stands before the end of the document.
  std::filesystem::path write(const TempFolder& folder, const std::string& nodes, const std::string& primitive,
                              const std::string& more = "") const {
    folder.write("a.bin", bytes_);
    return folder.write(
        "a.gltf", fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{},)"
                              R"("meshes":[{{"primitives":[{{{}}}]}}],"buffers":[{{"uri":"a.bin","byteLength":{}}}],)"
                              R"("bufferViews":[{}],"accessors":[{}]{}}})",
                              nodes, primitive, bytes_.size(), views_, accessors_, more));
  }

 private:
  std::string accessors_, views_, bytes_;
  int count_ = 0;
};

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kFloat = 5126;
constexpr const char* kPrimitive = R"("attributes":{"POSITION":0},"indices":1)";

std::vector<std::uint16_t> faces() { return {kPyramidFaces, kPyramidFaces + 12}; }

template <typename T>
std::vector<T> corners(double factor) {
  std::vector<T> out;
  for (const auto& x : kTet)
    for (const int c : x) out.push_back(static_cast<T>(factor * c));
  return out;
}

GltfFile tetrahedron() {
  GltfFile file;
  file.add(corners<float>(1.0), 3, kFloat);
  file.add(faces(), 1, kUnsignedShort);
  return file;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_mesh(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("glTF's integer coordinates are what its formulas say") {
  const TempFolder folder;
  const char* quantized =
      R"(,"extensionsRequired":["KHR_mesh_quantization"],"extensionsUsed":["KHR_mesh_quantization"])";
  const auto read = [&](auto numbers, int type, bool normalized, std::size_t stride, double scale) {
    GltfFile file;
    file.add(numbers, 3, type, normalized ? R"(,"normalized":true)" : "", stride);
    file.add(faces(), 1, kUnsignedShort);
    const std::string nodes = fmt::format(R"([{{"mesh":0,"scale":[{0},{0},{0}],"translation":[1,2,3]}}])", scale);
    return read_mesh(file.write(folder, nodes, kPrimitive, quantized));
  };
  const TriangleMesh meshes[] = {
      read(corners<std::int8_t>(127), kByte, true, 4, 2.0),
      read(corners<std::uint8_t>(200), kUnsignedByte, false, 4, 0.01),
      read(corners<std::int16_t>(-32768), kShort, true, 8, -2.0),  // which is -1 as well as -32767 is
      read(corners<std::uint16_t>(60000), kUnsignedShort, false, 8, 1.0 / 30000),
  };
  for (const TriangleMesh& mesh : meshes) {
    REQUIRE(mesh.vertices.size() == 4);
    REQUIRE(mesh.triangles.size() == 4);
    for (int v = 0; v < 4; ++v) {
      const Vec3 due = Vec3(1, 2, 3) + 2.0 * Vec3(kTet[v][0], kTet[v][1], kTet[v][2]);
      CHECK((mesh.vertices[static_cast<std::size_t>(v)] - due).norm() < 1e-6);
    }
  }
  CHECK(signed_volume(meshes[0]) == Approx(8.0 / 6.0));
  CHECK(signed_volume(meshes[2]) == Approx(-8.0 / 6.0));  // inside out by its integers, which no node mends
}

TEST_CASE("what stands in a mirror of glTF keeps its outside") {
  const TempFolder folder;
  const GltfFile file = tetrahedron();
  for (const char* nodes : {R"([{"mesh":0,"scale":[-1,1,1]}])", R"([{"scale":[1,-2,1],"children":[1]},{"mesh":0}])",
                            R"([{"mesh":0,"matrix":[0,1,0,0, 1,0,0,0, 0,0,1,0, 5,0,0,1]}])"}) {
    INFO(nodes);
    CHECK(signed_volume(read_mesh(file.write(folder, nodes, kPrimitive))) > 0.16);
  }
}

TEST_CASE("each instance of a glTF mesh is there") {
  const TempFolder folder;
  GltfFile file = tetrahedron();
  const std::vector<float> shifts = {0, 0, 0, 5, 0, 0, 0, 7, 0}, sizes = {1, 1, 1, 2, 2, 2, 1, 1, -3};
  const int translation = file.add(shifts, 3, kFloat), scale = file.add(sizes, 3, kFloat);
  const std::string nodes = fmt::format(
      R"([{{"mesh":0,"translation":[0,0,1],"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{},"SCALE":{}}}}}}}}}])",
      translation, scale);
  const TriangleMesh mesh =
      read_mesh(file.write(folder, nodes, kPrimitive, R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])"));
  REQUIRE(mesh.vertices.size() == 12);
  REQUIRE(mesh.triangles.size() == 12);
  CHECK(signed_volume(mesh) == Approx((1.0 + 8.0 + 3.0) / 6.0));
  CHECK((mesh.vertices[4] - Vec3(5, 0, 1)).norm() < 1e-12);
  CHECK((mesh.vertices[5] - Vec3(7, 0, 1)).norm() < 1e-12);
  CHECK((mesh.vertices[11] - Vec3(0, 7, -2)).norm() < 1e-12);
}

TEST_CASE("glTF's strips and fans face outwards") {
  const TempFolder folder;
  for (const int mode : {5, 6}) {
    GltfFile file;
    file.add(corners<float>(1.0), 3, kFloat);
    // as a strip 0 2 1, 2 3 1 (turned), 1 3 0, 3 2 0 (turned); as a fan 0 2 1, 0 1 3, 0 3 2 and no face across
    file.add(mode == 5 ? std::vector<std::uint16_t>{0, 2, 1, 3, 0, 2} : std::vector<std::uint16_t>{0, 2, 1, 3, 2}, 1,
             kUnsignedShort);
    const TriangleMesh mesh =
        read_mesh(file.write(folder, kPlainNodes, fmt::format(R"({},"mode":{})", kPrimitive, mode)));
    REQUIRE(mesh.triangles.size() == (mode == 5 ? 4u : 3u));
    for (const Triangle& t : mesh.triangles) {
      const auto x = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
      const Vec3 normal = (x(1) - x(0)).cross(x(2) - x(0));
      CHECK(normal.dot(x(0) - Vec3::Constant(0.1)) > 0.0);
    }
  }
}

TEST_CASE("a sparse accessor of glTF moves the vertices that it names") {
  const TempFolder folder;
  GltfFile file;
  const std::string sparse =
      R"(,"sparse":{"count":1,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}})";
  file.add(corners<float>(1.0), 3, kFloat, sparse);
  file.add(faces(), 1, kUnsignedShort);
  file.add(std::vector<std::uint16_t>{3}, 1, kUnsignedShort);
  file.add(std::vector<float>{0, 0, 4}, 3, kFloat);
  CHECK(signed_volume(read_mesh(file.write(folder, kPlainNodes, kPrimitive))) == Approx(4.0 / 6.0));
}

TEST_CASE("glTF that can't be read as it is meant is refused, and says why") {
  const TempFolder folder;
  const auto with = [&](const std::string& nodes, const std::string& primitive, const std::string& more) {
    const std::string message = refusal(tetrahedron().write(folder, nodes, primitive, more));
    INFO(message);
    CHECK(message.find("a.gltf: can't be read (") != std::string::npos);
    CHECK(message.find("convert it to PLY") != std::string::npos);
    return message;
  };
  CHECK(with(kPlainNodes, kPrimitive, R"(,"extensionsRequired":["VENDOR_curves"])").find("VENDOR_curves") !=
        std::string::npos);
  CHECK(with(R"([{"mesh":0,"children":[0]}])", kPrimitive, "").find("node 0 hangs at two places") != std::string::npos);
  CHECK(with(R"([{"mesh":3}])", kPrimitive, "").find("mesh 3 is named, of 1") != std::string::npos);
  CHECK(with(kPlainNodes, R"("attributes":{"POSITION":9})", "").find("accessor 9") != std::string::npos);
  CHECK(with(kPlainNodes, R"("attributes":{"POSITION":1})", "").find("other than 3 numbers") != std::string::npos);
  CHECK(with(kPlainNodes, R"("attributes":{"POSITION":0})", "").find("4 indices") != std::string::npos);

  GltfFile wrong;
  wrong.add(corners<float>(1.0), 3, kFloat);
  wrong.add(std::vector<std::uint16_t>{0, 2, 77}, 1, kUnsignedShort);
  CHECK(refusal(wrong.write(folder, kPlainNodes, kPrimitive)).find("index 2 of a mesh names vertex 77 of 4") !=
        std::string::npos);
  GltfFile infinite;
  infinite.add(corners<float>(INFINITY), 3, kFloat);
  infinite.add(faces(), 1, kUnsignedShort);
  CHECK(refusal(infinite.write(folder, kPlainNodes, kPrimitive)).find("is not finite") != std::string::npos);
  GltfFile beyond;
  beyond.add(corners<float>(1.0), 3, kFloat, R"(,"byteOffset":8)");
  beyond.add(faces(), 1, kUnsignedShort);
  CHECK(refusal(beyond.write(folder, kPlainNodes, kPrimitive)).find("read beyond its end") != std::string::npos);
}

TEST_CASE("pictures of a glTF file need not be there, and its appearance is no reason to refuse it") {
  const TempFolder folder;
  const char* textured =
      R"(,"images":[{"uri":"../nowhere/skin.png"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"extensionsRequired":["KHR_materials_unlit","KHR_texture_transform"])";
  const std::filesystem::path path =
      tetrahedron().write(folder, kPlainNodes, fmt::format(R"({},"material":0)", kPrimitive), textured);
  MeshOrigin origin;
  CHECK(read_mesh(path, FileGuard(folder.path()), &origin).triangles.size() == 4);
  REQUIRE(origin.others.size() == 1);
  CHECK(origin.others[0].filename() == "a.bin");
  CHECK(origin.unit == "metres, as the format has it");
}

TEST_CASE("a buffer that a glTF file names and that isn't there is named") {
  const TempFolder folder;
  const std::filesystem::path path = tetrahedron().write(folder, kPlainNodes, kPrimitive);
  std::filesystem::remove(folder / "a.bin");
  const std::string message = refusal(path);
  INFO(message);
  CHECK(message.find("a.bin', which can't be opened") != std::string::npos);
}

TEST_CASE("glTF 1 is read as well") {
  const TempFolder folder;
  const float x[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::string bytes(72, '\0');
  std::memcpy(bytes.data(), x, 48);
  std::memcpy(bytes.data() + 48, kPyramidFaces, 24);
  folder.write("a.bin", bytes);
  const std::filesystem::path path = folder.write(
      "a.gltf",
      R"({"asset":{"version":"1.0"},"scene":"s","scenes":{"s":{"nodes":["n"]}},"nodes":{"n":{"meshes":["m"]}},)"
      R"("meshes":{"m":{"primitives":[{"attributes":{"POSITION":"p"},"indices":"i","mode":4}]}},)"
      R"("accessors":{"p":{"bufferView":"v","byteOffset":0,"byteStride":12,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"("i":{"bufferView":"w","byteOffset":0,"componentType":5123,"count":12,"type":"SCALAR"}},)"
      R"("bufferViews":{"v":{"buffer":"b","byteOffset":0,"byteLength":48},"w":{"buffer":"b","byteOffset":48,"byteLength":24}},)"
      R"("buffers":{"b":{"uri":"a.bin","byteLength":72,"type":"arraybuffer"}}})");
  CHECK(signed_volume(read_mesh(path)) == Approx(1.0 / 6.0));
}
