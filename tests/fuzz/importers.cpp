// Damaged FBX, glTF and Collada: a mesh with indices in range and finite coordinates, or one message that begins with
// the file's name; never a crash, for the importer works in a process of its own.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "engine/geometry/mend/mend.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string gltf() {
  // a tetrahedron: four corners in single precision, twelve indices, in base64
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::string bytes(96, '\0');
  std::memcpy(bytes.data(), corners, 48);
  std::memcpy(bytes.data() + 48, faces, 48);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<unsigned char>(bytes[i + k]);
    for (int k = 3; k >= 0; --k) text += kDigits[word >> (6 * k) & 63];
  }
  return "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"scale\":["
         "2,2,"
         "2]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],\"buffers\":[{\"uri\":"
         "\"data:application/octet-stream;base64," +
         text +
         "\",\"byteLength\":96}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,"
         "\"byteLength\":48}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
         "\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5125,\"count\":12,\"type\":\"SCALAR\"}]}"
         "\n";
}

constexpr const char* kFbx =
    "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}\nGlobalSettings: "
    "{\n Version: 1000\n Properties70: {\n P: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n }\n}\n"
    "Definitions: {\n Version: 100\n Count: 2\n ObjectType: \"Geometry\" {\n Count: 1\n }\n ObjectType: \"Model\" {\n "
    "Count: 1\n }\n}\nObjects: {\n Geometry: 1001, \"Geometry::tet\", \"Mesh\" {\n Vertices: *12 {\n a: "
    "0,0,0,100,0,0,0,100,0,0,0,100\n }\n PolygonVertexIndex: *12 {\n a: 0,2,-2,0,1,-4,0,3,-3,1,2,-4\n }\n "
    "GeometryVersion: 124\n }\n Model: 2001, \"Model::tet\", \"Mesh\" {\n Version: 232\n }\n}\nConnections: {\n C: "
    "\"OO\",2001,0\n C: \"OO\",1001,2001\n}\n";

constexpr const char* kDae =
    "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
    "version=\"1.4.1\"><asset><unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis></asset><library_geometries>"
    "<geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"12\">0 0 0 100 0 0 0 100 0 0 0 "
    "100</float_array><technique_common><accessor source=\"#pa\" count=\"4\" stride=\"3\"><param name=\"X\" "
    "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
    "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles "
    "count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>"
    "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
    "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
    "url=\"#s\"/></scene></COLLADA>\n";

std::string damaged(std::string out, Random& random) {
  for (int n = 1 + random.below(4); n > 0 && !out.empty(); --n) {
    const std::size_t at = static_cast<std::size_t>(random.below(static_cast<int>(out.size())));
    switch (random.below(5)) {
      case 0:
        out[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        out.erase(at, static_cast<std::size_t>(1 + random.below(8)));
        break;
      case 2:
        out.insert(at, out.substr(static_cast<std::size_t>(random.below(static_cast<int>(out.size()))),
                                  static_cast<std::size_t>(1 + random.below(16))));
        break;
      case 3:
        out[at] = "0123456789-+.e[]{}<>=/#\"\n"[random.below(25)];
        break;
      default:
        if (random.below(8) == 0) out.resize(at);
        break;
    }
  }
  return out;
}

struct Fates {
  int taken = 0, refused = 0;
};

Fates damage_all(int each, std::uint64_t seed) {
  const TempFolder folder;
  Fates fates;
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>("a.gltf", gltf()), {"a.fbx", kFbx}, {"a.dae", kDae}}) {
    REQUIRE(read_mesh(folder.write(name, text)).triangles.size() == 4);
    Random random(seed);
    for (int i = 0; i < each; ++i) {
      const std::filesystem::path path = folder.write(name, damaged(text, random));
      try {
        const TriangleMesh mesh = read_mesh(path);
        for (const Vec3& v : mesh.vertices) REQUIRE(v.allFinite());
        for (const Triangle& t : mesh.triangles)
          for (const int v : t) REQUIRE((v >= 0 && v < static_cast<int>(mesh.vertices.size())));
        const MendedMesh mended = mend(mesh, {});
        if (!mended.problem) REQUIRE_FALSE(check_mesh(mended.mesh, make_topology(mended.mesh)));
        ++fates.taken;
      } catch (const InputError& error) {
        REQUIRE(std::string(error.what()).rfind(path.string() + ":", 0) == 0);
        ++fates.refused;
      }
    }
  }
  return fates;
}

}  // namespace

TEST_CASE("FBX, glTF and Collada with damaged bytes are refused or read, and what is read is mended or refused") {
  const Fates fates = damage_all(150, 5);
  CHECK(fates.taken > 150 / 4);
  CHECK(fates.refused > 150 / 4);
}

// 102,000 in all
TEST_CASE("the same, many times", "[long]") {
  const Fates fates = damage_all(15000, 6);
  CHECK(fates.taken > 15000 / 4);
  CHECK(fates.refused > 15000 / 4);
}

TEST_CASE("the same, many times, damaged in other places", "[long]") {
  const Fates fates = damage_all(19000, 7);
  CHECK(fates.taken > 19000 / 4);
  CHECK(fates.refused > 19000 / 4);
}
