#include "engine/io/meshes/mesh_file.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

#include "engine/core/error.hpp"
#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string message(const std::string& name, const std::string& bytes) {
  try {
    parse_mesh(name, bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

}  // namespace

TEST_CASE("each format gives the vertices in double precision and in source order") {
  const TriangleMesh mesh = tetrahedron();
  const std::pair<std::string, std::string> files[] = {{"a.off", off_text(mesh)},
                                                       {"a.obj", obj_text(mesh)},
                                                       {"a.ply", ply_ascii(mesh)},
                                                       {"b.ply", ply_binary(mesh, false)},
                                                       {"c.PLY", ply_binary(mesh, true)}};
  for (const auto& [name, bytes] : files) {
    INFO(name);
    const TriangleMesh read = parse_mesh(name, bytes);
    CHECK(read.vertices == mesh.vertices);
    CHECK(read.triangles == mesh.triangles);
  }
}

TEST_CASE("STL gives three vertices a facet") {
  const TriangleMesh mesh = tetrahedron();
  const TriangleMesh ascii = parse_mesh("a.stl", stl_ascii(mesh)), binary = parse_mesh("a.stl", stl_binary(mesh));
  REQUIRE(ascii.vertices.size() == 12);
  REQUIRE(binary.vertices.size() == 12);
  for (int t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3& x = mesh.vertices[mesh.triangles[t][k]];
      CHECK(ascii.vertices[ascii.triangles[t][k]] == x);
      CHECK(binary.vertices[binary.triangles[t][k]] == Vec3(x.cast<float>().cast<double>()));
    }
}

TEST_CASE("polygons are fanned from their first corner") {
  const TriangleMesh off = parse_mesh("a.off", "OFF 4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n");
  CHECK(off.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  const TriangleMesh obj =
      parse_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 1\nvt 0 0\nf -4/1 -3/1 \\\n -2 -1\n");
  CHECK(obj.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("variants of the formats are understood") {
  CHECK(
      parse_mesh("a.off",
                 "# c\nCOFF\n# c\n3 1 0  # counts\n\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n3 0 1 2")
          .vertices.size() == 3);
  CHECK(parse_mesh("a.off", "OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n").triangles.size() == 1);
  const std::string extra =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar uint vertex_index\nproperty list uchar float "
      "texcoord\nelement vertex 3\n"
      "property float32 x\nproperty float32 y\nproperty float32 z\nelement edge 1\nproperty int a\nproperty int "
      "b\nend_header\n"
      "3 0 1 2 2 0.5 0.5\n0 0 0\n1 0 0\n0 1 0\n0 1\n";
  CHECK(parse_mesh("a.ply", extra).triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("what is wrong is located") {
  const TriangleMesh mesh = tetrahedron();
  CHECK(starts_with(message("a.off", "OFF\n4 1 0\n0 0 0\n1 0 nan\n0 1 0\n0 0 1\n3 0 1 2\n"),
                    "a.off:4:5: 'nan'; a finite number is wanted"));
  CHECK(starts_with(message("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
                    "a.off:6:7: vertex 3; there are vertices 0 to 2"));
  CHECK(starts_with(message("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"), "a.off:6:1: a face of 2 corners"));
  CHECK(starts_with(message("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1\n3 0 1 2\n"), "a.off:5:3: the line ends early"));
  CHECK(starts_with(message("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "a.off: has no faces"));
  CHECK(starts_with(message("a.off", "OFF\n2000000000 1 0\n0 0 0\n"), "a.off:2:1: 2000000000 vertices"));
  CHECK(starts_with(message("a.off", "hello\n"), "a.off:1:1: 'hello'"));
  CHECK(starts_with(message("a.off", ""), "a.off:1: the file ends early"));
  CHECK(starts_with(message("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"), "a.obj:4:7: vertex 4"));
  CHECK(starts_with(message("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"), "a.obj:4:7: vertex 0"));
  CHECK(starts_with(message("a.obj", "v 0 0 1e999\n"), "a.obj:1:7: '1e999'"));
  CHECK(starts_with(message("a.obj", "curv 0 1\n"), "a.obj:1:1: 'curv'"));
  CHECK(starts_with(message("a.ply",
                            "ply\nformat ascii 1.0\nelement vertex 90000000\nproperty float x\nproperty float "
                            "y\nproperty float z\nend_header\n"),
                    "a.ply:7: 90000000 elements 'vertex'; no more than the file has room for"));
  CHECK(starts_with(
      message("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"),
      "a.ply:1: vertices without z"));
  std::string infinite = ply_binary(mesh, false);
  const std::size_t body = infinite.find("end_header\n") + 11;
  const double inf = std::numeric_limits<double>::infinity();
  std::memcpy(infinite.data() + body + 8, &inf, 8);
  CHECK(starts_with(message("a.ply", infinite),
                    fmt::format("a.ply: byte {}: a coordinate that is not finite", body + 8)));
  std::string far = ply_binary(mesh, true);
  far[far.size() - 1] = 4;
  CHECK(starts_with(message("a.ply", far),
                    fmt::format("a.ply: byte {}: vertex 4; there are vertices 0 to 3", far.size() - 4)));
  CHECK(starts_with(message("a.ply", ply_binary(mesh, false) + "x"), "a.ply: byte "));
  std::string cut = stl_binary(mesh);
  cut.pop_back();
  CHECK(starts_with(message("a.stl", cut), "a.stl: byte 80: 4 facets in a file of 283 bytes"));
  cut.replace(0, 5, "solid");  // as some writers of binary files begin
  CHECK(starts_with(message("a.stl", cut), "a.stl: byte 80: 4 facets in a file of 283 bytes"));
  CHECK(starts_with(message("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\n"),
                    "a.stl:5:10: the line ends early"));
}

TEST_CASE("a PLY that is written reads back bit for bit, with the head that was promised") {
  const TempFolder folder;
  TriangleMesh mesh = tetrahedron();
  mesh.vertices[0].x() = -0.0;
  mesh.vertices[1].y() = 5e-324;
  write_ply(folder / "a.ply", mesh.vertices, mesh.triangles);
  const std::string bytes = slurp(folder / "a.ply");
  CHECK(starts_with(bytes,
                    "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty double x\nproperty double "
                    "y\nproperty double z\n"
                    "element face 4\nproperty list uchar uint vertex_indices\nend_header\n"));
  const TriangleMesh read = read_mesh(folder / "a.ply");
  CHECK(read.triangles == mesh.triangles);
  CHECK(std::memcmp(read.vertices.data(), mesh.vertices.data(), 4 * sizeof(Vec3)) == 0);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
  CHECK_THROWS_AS(write_ply(folder / "missing/a.ply", mesh.vertices, mesh.triangles), InputError);
}

TEST_CASE("other formats are read in a process of their own, whose death is an error message") {
  const TempFolder folder;
  // DirectX text: read by assimp only
  const auto good = folder.write("a.x",
                                 "xof 0303txt 0032\nMesh m {\n 4;\n 0;0;0;,\n 1;0;0;,\n 0;1;0;,\n 0;0;1;;\n 4;\n "
                                 "3;0,2,1;,\n 3;0,1,3;,\n 3;0,3,2;,\n 3;1,2,3;;\n}\n");
  CHECK(read_mesh(good).triangles.size() == 4);
  CHECK_THROWS_AS(read_mesh(folder.write("b.x", "xof 0303txt 0032\nMesh m {\n 4000000000;\n 0;0")), InputError);
  CHECK_THROWS_AS(read_mesh(folder.write("c.dae", "<?xml version=\"1.0\"?><COLLADA")), InputError);
  CHECK_THROWS_AS(read_mesh(folder.write("d.xyzzy", "hello")), InputError);
  CHECK_THROWS_AS(read_mesh(folder.path()), InputError);
  CHECK_THROWS_AS(read_mesh(folder / "nothing.ply"), InputError);
}

namespace {

// a tetrahedron of edge 100 along the axes, moved by 100 in x, as Autodesk's ASCII FBX 7.4
std::string fbx_text(const std::string& settings) {
  return "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXHeaderVersion: 1003\n FBXVersion: 7400\n}\n" +
         (settings.empty() ? "" : "GlobalSettings: {\n Version: 1000\n Properties70: {\n" + settings + " }\n}\n") +
         "Definitions: {\n Version: 100\n Count: 2\n ObjectType: \"Geometry\" {\n Count: 1\n }\n ObjectType: \"Model\" "
         "{\n Count: 1\n }\n}\nObjects: {\n Geometry: 1001, \"Geometry::tet\", \"Mesh\" {\n Vertices: *12 {\n a: "
         "0,0,0,100,0,0,0,100,0,0,0,100\n }\n PolygonVertexIndex: *12 {\n a: 0,2,-2,0,1,-4,0,3,-3,1,2,-4\n }\n "
         "GeometryVersion: 124\n }\n Model: 2001, \"Model::tet\", \"Mesh\" {\n Version: 232\n Properties70: {\n P: "
         "\"Lcl "
         "Translation\", \"Lcl Translation\", \"\", \"A\",100,0,0\n }\n }\n}\nConnections: {\n C: \"OO\",2001,0\n C: "
         "\"OO\",1001,2001\n}\n";
}

std::string fbx_unit(const std::string& factor) {
  return " P: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + factor + "\n";
}

// the same as Collada
std::string dae_text(const std::string& unit) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset>" +
         unit +
         "<up_axis>Y_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array "
         "id=\"pa\" count=\"12\">0 0 0 100 0 0 0 100 0 0 0 100</float_array><technique_common><accessor source=\"#pa\" "
         "count=\"4\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param "
         "name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input "
         "semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"4\"><input semantic=\"VERTEX\" "
         "source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><translate>100 0 "
         "0</translate><instance_geometry "
         "url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
         "url=\"#s\"/></scene></COLLADA>\n";
}

}  // namespace

TEST_CASE("formats that know their unit arrive in metres") {
  const TempFolder folder;
  const auto check_edge = [&](const std::string& name, const std::string& text, double edge) {
    const TriangleMesh mesh = read_mesh(folder.write(name, text));
    Vec3 low = mesh.vertices.at(0), high = low;
    for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
    INFO(name);
    // the mesh and where its node stands, both in the file's unit
    CHECK((low - Vec3(edge, 0, 0)).norm() < 1e-6 * edge);
    CHECK((high - Vec3(2 * edge, edge, edge)).norm() < 1e-6 * edge);
  };
  check_edge("none.fbx", fbx_text(""), 1.0);  // centimetres unless it says otherwise
  check_edge("cm.fbx", fbx_text(fbx_unit("1")), 1.0);
  check_edge("mm.fbx", fbx_text(fbx_unit("0.1")), 0.1);
  check_edge("inch.fbx", fbx_text(fbx_unit("2.54")), 2.54);
  check_edge("m.fbx", fbx_text(fbx_unit("100")), 100.0);
  check_edge("none.dae", dae_text(""), 100.0);  // metres unless it says otherwise
  check_edge("cm.dae", dae_text("<unit name=\"centimeter\" meter=\"0.01\"/>"), 1.0);
  check_edge("inch.dae", dae_text("<unit name=\"inch\" meter=\"0.0254\"/>"), 2.54);
}

TEST_CASE("cameras and lights of one name, as exporters leave them, are nothing to a surface") {
  std::string text = dae_text("");
  const auto insert = [&](const std::string& before, const std::string& part) { text.insert(text.find(before), part); };
  insert("<library_geometries>",
         "<library_cameras><camera id=\"c\"><optics><technique_common><perspective><xfov>49</xfov><znear>0.1</znear>"
         "<zfar>100</zfar></perspective></technique_common></optics></camera></library_cameras><library_lights><light "
         "id=\"l\"><technique_common><point><color>1 1 1</color></point></technique_common></light></library_lights>");
  for (int k = 0; k < 2; ++k)
    insert("<node id=\"n\">",
           "<node id=\"eye\" name=\"eye\"><instance_camera url=\"#c\"/></node><node id=\"lamp\" "
           "name=\"lamp\"><instance_light url=\"#l\"/></node>");
  const TempFolder folder;
  const TriangleMesh mesh = read_mesh(folder.write("twice.dae", text)),
                     plain = read_mesh(folder.write("plain.dae", dae_text("")));
  CHECK(mesh.triangles == plain.triangles);
  CHECK(mesh.vertices == plain.vertices);
}

TEST_CASE("what was said before another process reads a mesh is said once") {
  const TempFolder folder;
  const auto mesh = folder.write("a.fbx", fbx_text(""));
  std::fflush(stdout);
  const int before = dup(STDOUT_FILENO), file = open((folder / "said").c_str(), O_WRONLY | O_CREAT, 0600);
  REQUIRE((before >= 0 && file >= 0));
  dup2(file, STDOUT_FILENO);
  std::fputs("hello", stdout);  // and not written yet
  const std::size_t triangles = read_mesh(mesh).triangles.size();
  std::fflush(stdout);
  dup2(before, STDOUT_FILENO);
  close(before), close(file);
  CHECK(triangles == 4);
  CHECK(slurp(folder / "said") == "hello");
}

TEST_CASE("a mesh file that names another one reads it where that is allowed only") {
  const TempFolder folder;
  const auto gltf = [](const std::string& uri) {
    return "{ \"asset\": { \"version\": \"2.0\" }, \"scene\": 0, \"scenes\": [ { \"nodes\": [0] } ], \"nodes\": [ { "
           "\"mesh\": 0 } ], \"meshes\": [ { \"primitives\": [ { \"attributes\": { \"POSITION\": 0 }, \"indices\": 1 } "
           "] } "
           "], \"buffers\": [ { \"uri\": \"" +
           uri +
           "\", \"byteLength\": 96 } ], \"bufferViews\": [ { \"buffer\": 0, \"byteLength\": 48 }, { \"buffer\": 0, "
           "\"byteOffset\": 48, \"byteLength\": 48 } ], \"accessors\": [ { \"bufferView\": 0, \"componentType\": 5126, "
           "\"count\": 4, \"type\": \"VEC3\", \"min\": [0,0,0], \"max\": [1,1,1] }, { \"bufferView\": 1, "
           "\"componentType\": 5125, \"count\": 12, \"type\": \"SCALAR\" } ] }\n";
  };
  const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::string buffer(96, '\0');
  std::memcpy(buffer.data(), corners, 48);
  std::memcpy(buffer.data() + 48, faces, 48);
  folder.write("outside.bin", buffer);
  folder.write("scene/inside.bin", buffer);
  std::filesystem::create_symlink("../outside.bin", folder / "scene/link.bin");
  const FileGuard guard(folder / "scene");
  const auto refusal = [&](const std::string& uri) -> std::string {
    try {
      read_mesh(folder.write("scene/a.gltf", gltf(uri)), guard);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  CHECK(refusal("inside.bin") == "");
  for (const std::string uri : {"../outside.bin", "link.bin"}) {
    const std::string message = refusal(uri);
    INFO(message);
    CHECK(message.find("a.gltf: names '") != std::string::npos);
    CHECK(message.find("leads out of the scene's folder") != std::string::npos);
    CHECK(read_mesh(folder / "scene/a.gltf").triangles.size() == 4);  // where nothing was forbidden
  }
}
