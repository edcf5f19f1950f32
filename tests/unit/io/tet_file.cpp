#include "engine/io/tets/tet_file.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "engine/core/error.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/tet_writers.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;

namespace {

TetMesh sample() {
  TetMesh mesh = make_tet_box(Vec3(1, 2, 3), 2, 3, 2);
  test::Random random(41);
  for (Vec3& v : mesh.vertices) v += 0.05 * random.vector();
  return mesh;
}

void check_same(const TetFile& file, const TetMesh& mesh) {
  REQUIRE(file.mesh.vertices.size() == mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) CHECK(file.mesh.vertices[i] == mesh.vertices[i]);
  CHECK(file.mesh.tets == mesh.tets);
}

/// The message of the one InputError, which must start with `place`.
void check_refused(const std::string& place, const std::string& part, const std::function<void()>& read) {
  std::string message = "(nothing was refused)";
  try {
    read();
  } catch (const InputError& error) {
    message = error.what();
  }
  CAPTURE(place, part, message);
  CHECK(message.substr(0, place.size()) == place);
  CHECK(message.find(part) != std::string::npos);
  CHECK(std::count(message.begin(), message.end(), '\n') == 0);
}

struct Case {
  const char *place, *part;
  std::string text;
};

const std::string kVertices = "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
const std::string kTet = "*ELEMENTS\nTET\n1 4 0\n1 1 2 3 4\n";
const std::string kVeg = kVertices + kTet;  // 10 lines

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("volume meshes come back from every format as they were written") {
  const TetMesh mesh = sample();
  for (const int base : {0, 1}) {
    check_same(parse_veg("m.veg", test::veg_text(mesh, base), "."), mesh);
    check_same(parse_tetgen("m.node", test::node_text(mesh, base), "m.ele", test::ele_text(mesh, base)), mesh);
  }
  check_same(parse_msh("m.msh", test::msh22_text(mesh)), mesh);
  check_same(parse_msh("m.msh", test::msh41_text(mesh)), mesh);
  for (const bool swapped : {false, true}) {
    check_same(parse_msh("m.msh", test::msh22_binary(mesh, swapped)), mesh);
    check_same(parse_msh("m.msh", test::msh41_binary(mesh, swapped)), mesh);
  }
  const std::string crlf = [&] {
    std::string out;
    for (const char c : test::veg_text(mesh)) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return out;
  }();
  check_same(parse_veg("m.veg", crlf, "."), mesh);
}

TEST_CASE("files are found by their ending and read from disk") {
  const test::TempFolder folder;
  const TetMesh mesh = sample();
  check_same(read_tet_file(folder.write("a.veg", test::veg_text(mesh))), mesh);
  check_same(read_tet_file(folder.write("a.msh", test::msh41_text(mesh))), mesh);
  folder.write("a.node", test::node_text(mesh));
  const auto ele = folder.write("a.ele", test::ele_text(mesh));
  check_same(read_tet_file(ele), mesh);
  check_same(read_tet_file(folder / "a.node"), mesh);
  const auto alone = folder.write("alone.ele", test::ele_text(mesh));
  check_refused(alone.string(), "alone.node", [&] { read_tet_file(alone); });
  check_refused((folder / "a.xyz").string(), "'.xyz'", [&] { read_tet_file(folder / "a.xyz"); });
  check_refused((folder / "none.veg").string(), "", [&] { read_tet_file(folder / "none.veg"); });
}

TEST_CASE(".veg materials, sets and regions") {
  const std::string text = kVertices +
                           "*ELEMENTS\nTETS\n1 4 0\n1 1 2 3 4\n*MATERIAL unused one\nENU, 900, 1e5, 0.3\n*SET "
                           "half\n1,\n*MATERIAL soft\nMOONEYRIVLIN 1100 1 2 3\n*MATERIAL\tbone\nORTHOTROPIC_N1G1, "
                           "1200, 1,2,3, 0.1, 5\n*REGION\nallElements, unusedone\n*REGION\n half , soft\n";
  const TetFile file = parse_veg("m.veg", text, ".");
  REQUIRE(file.materials.size() == 3);
  CHECK(file.materials[0].name == "unusedone");
  CHECK(file.materials[0].young == 1e5);
  CHECK(file.materials[0].poisson == 0.3);
  CHECK_FALSE(file.materials[1].isotropic);
  CHECK(file.materials[2].density == 1200);
  CHECK(file.element_material == std::vector<int>{1});
  CHECK(file.notes.empty());

  // no region: the last material of the file; no material: Vega's own default; both said
  const TetFile last = parse_veg("m.veg", kVeg + "*MATERIAL a\nENU, 1, 2, 0.1\n*MATERIAL b\nENU, 3, 4, 0.2\n", ".");
  CHECK(last.element_material == std::vector<int>{1});
  CHECK(last.notes.size() == 1);
  const TetFile none = parse_veg("m.veg", kVeg, ".");
  CHECK(none.materials.at(0).young == 1e9);
  CHECK(none.notes.size() == 1);
}

TEST_CASE(".veg includes") {
  const test::TempFolder folder;
  folder.write("vertices.txt", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  folder.write("nested.txt", "*INCLUDE list.txt\n");
  folder.write("list.txt", "1\n");
  const std::string good = "*VERTICES\n*INCLUDE vertices.txt\n" + kTet +
                           "*SET s\n*INCLUDE nested.txt\n*MATERIAL m\nENU 1 1 0\n*REGION\ns,m\n";
  CHECK(read_tet_file(folder.write("good.veg", good)).mesh.tets.size() == 1);
  const std::string place = (folder / "bad.veg").string();
  const auto refuse = [&](const std::string& text, const std::string& at, const std::string& part) {
    check_refused(at, part, [&] { read_tet_file(folder.write("bad.veg", text)); });
  };
  refuse(kVeg + "*INCLUDE missing.txt\n", place + ":11:10:", "missing.txt");
  refuse(kVeg + "*INCLUDE\n", place + ":11:9:", "file name");
  refuse(kVeg + "*INCLUDE /etc/passwd\n", place + ":11:10:", "relative");
  refuse(kVeg + "*INCLUDE ../x.txt\n", place + ":11:10:", "inside");
  refuse(kVeg + "*INCLUDE bad.veg\n", place + ":11:10:", "itself");
  folder.write("cycle_a.txt", "# a\n*INCLUDE cycle_b.txt\n");
  folder.write("cycle_b.txt", "*INCLUDE cycle_a.txt\n");
  refuse(kVeg + "*INCLUDE cycle_a.txt\n", (folder / "cycle_b.txt").string() + ":1:10:", "itself");
  for (int i = 0; i < 12; ++i) folder.write(fmt::format("deep{}.txt", i), fmt::format("*INCLUDE deep{}.txt\n", i + 1));
  refuse(kVeg + "*INCLUDE deep0.txt\n", (folder / "deep6.txt").string() + ":1:10:", "deep");
  folder.write("wrong.txt", "# list\n1, 2\n");
  refuse(kVeg + "*SET s\n*INCLUDE wrong.txt\n", (folder / "wrong.txt").string() + ":2:4:", "element 2");
}

TEST_CASE("what a volume file needs beside itself stays in the folder, and is bounded in number") {
  const test::TempFolder folder;
  folder.write("secret.txt", "root:*:20228\n");
  folder.write("scene/m.veg", kVeg + "*INCLUDE link.txt\n");
  std::filesystem::create_symlink("../secret.txt", folder / "scene/link.txt");
  const FileGuard guard(folder / "scene");
  const std::string place = (folder / "scene/m.veg").string();
  const auto refuse = [&](const std::string& at, const std::string& part) {
    check_refused(at, part, [&] { read_tet_file(place, guard); });
  };
  refuse(place + ":11:10:", "'link.txt' leads out of the scene's folder");
  // through a folder, and through a link to a link
  std::filesystem::create_directory_symlink("..", folder / "scene/up");
  std::filesystem::create_symlink("link.txt", folder / "scene/twice.txt");
  folder.write("scene/m.veg", kVeg + "*INCLUDE up/secret.txt\n");
  refuse(place + ":11:10:", "leads out of the scene's folder");
  folder.write("scene/m.veg", kVeg + "*INCLUDE twice.txt\n");
  refuse(place + ":11:10:", "leads out of the scene's folder");
  folder.write("scene/inner.txt", "# fine\n");
  std::filesystem::create_symlink("inner.txt", folder / "scene/inside.txt");
  folder.write("scene/m.veg", kVeg + "*INCLUDE inside.txt\n");
  CHECK(read_tet_file(place, guard).mesh.tets.size() == 1);

  // a pair whose other half is elsewhere
  folder.write("t.ele", "1 4 0\n0 0 1 2 3\n");
  folder.write("scene/t.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  std::filesystem::create_symlink("../t.ele", folder / "scene/t.ele");
  check_refused((folder / "scene/t.node").string() + ": ", "leads out of the scene's folder",
                [&] { read_tet_file(folder / "scene/t.node", guard); });
  CHECK(read_tet_file(folder / "scene/t.node").mesh.tets.size() == 1);

  // 64 in all, nested or not: what includes 200 that include 200 ends
  std::string most = kVeg;
  for (int i = 0; i < 32; ++i) most += "*INCLUDE pair.txt\n";
  folder.write("scene/pair.txt", "*INCLUDE inner.txt\n");
  folder.write("scene/m.veg", most);
  CHECK(read_tet_file(place, guard).mesh.tets.size() == 1);
  folder.write("scene/m.veg", most + "*INCLUDE inner.txt\n");
  refuse(place + ":43:10:", "64 files may be included in all");
  std::string bomb;
  for (int i = 0; i < 200; ++i) bomb += "*INCLUDE b0.txt\n";
  folder.write("scene/m.veg", kVeg + bomb);
  for (int level = 0; level < 6; ++level) {
    std::string text;
    for (int i = 0; i < 200; ++i) text += fmt::format("*INCLUDE b{}.txt\n", level + 1);
    folder.write(fmt::format("scene/b{}.txt", level), level < 5 ? text : "# end\n");
  }
  check_refused((folder / "scene/b4.txt").string() + ":60:10:", "64 files may be included",
                [&] { read_tet_file(place, guard); });
}

TEST_CASE("each damaged .veg file gives one located error") {
  const std::vector<Case> cases = {
      {"m.veg:1:1:", "*VERTICES", ""},
      {"m.veg:1:1:", "section", "mesh of mine\n" + kVeg},
      {"m.veg:1:1:", "*VERTICES", kTet},
      {"m.veg:1:1:", "*VERTICES", kTet + kVertices},
      {"m.veg:7:1:", "*ELEMENTS", kVertices},
      {"m.veg:7:1:", "second", kVertices + kVertices + kTet},
      {"m.veg:11:1:", "second", kVeg + kTet},
      {"m.veg:7:1:", "4 vertices", replaced(kVeg, "*ELEMENTS", "5 1 1 1\n*ELEMENTS")},
      {"m.veg:7:1:", "vertex 5 of 5", replaced(kVeg, "4 3 0 0", "5 3 0 0")},
      {"m.veg:2:1:", "room", replaced(kVeg, "4 3 0 0", "900000000 3 0 0")},
      {"m.veg:2:1:", "-4", replaced(kVeg, "4 3 0 0", "-4 3 0 0")},
      {"m.veg:11:1:", "element 2 of 2", replaced(kVeg, "1 4 0", "2 4 0")},
      {"m.veg:11:1:", "1 elements", kVeg + "2 1 2 3 4\n"},
      {"m.veg:10:9:", "vertex 5", replaced(kVeg, "1 1 2 3 4", "1 1 2 3 5")},
      {"m.veg:10:3:", "vertex 0", replaced(kVeg, "1 1 2 3 4", "1 0 1 2 3")},
      {"m.veg:10:1:", "twice", replaced(kVeg, "1 1 2 3 4", "1 1 2 2 4")},
      {"m.veg:10:1:", "inverted", replaced(kVeg, "1 1 2 3 4", "1 2 1 3 4")},
      {"m.veg:10:1:", "flat", replaced(kVeg, "4 0 0 1", "4 1 1 0")},
      {"m.veg:4:3:", "1.0abc", replaced(kVeg, "2 1 0 0", "2 1.0abc 0 0")},
      {"m.veg:4:5:", "nan", replaced(kVeg, "2 1 0 0", "2 1 nan 0")},
      {"m.veg:4:3:", "1e999", replaced(kVeg, "2 1 0 0", "2 1e999 0 0")},
      {"m.veg:4:6:", "3 entries", replaced(kVeg, "2 1 0 0", "2 1 0")},
      {"m.veg:4:9:", "'7'", replaced(kVeg, "2 1 0 0", "2 1 0 0 7")},
      {"m.veg:8:1:", "cubes", replaced(kVeg, "TET", "CUBIC")},
      {"m.veg:8:1:", "HEX", replaced(kVeg, "TET", "HEX")},
      {"m.veg:9:3:", "8 corners", replaced(kVeg, "1 4 0", "1 8 0")},
      {"m.veg:11:1:", "*MESH", kVeg + "*MESH x\n"},
      {"m.veg:11:1:", "*vertices", kVeg + "*vertices\n"},
      {"m.veg:7:1:", "blanks", replaced(kVeg, "*ELEMENTS", "  \n*ELEMENTS")},
      {"m.veg:7:1:", "# no remark", replaced(kVeg, "*ELEMENTS", " # no remark\n*ELEMENTS")},
      {"m.veg:12:1:", "RUBBER", kVeg + "*MATERIAL m\nRUBBER, 1, 2, 3\n"},
      {"m.veg:12:10:", "3 entries", kVeg + "*MATERIAL m\nENU, 1, 2\n"},
      {"m.veg:12:18:", "'9'", kVeg + "*MATERIAL m\nENU, 1, 2, 0.3,  9\n"},
      {"m.veg:12:6:", "density", kVeg + "*MATERIAL m\nENU, 0, 2, 0.3\n"},
      {"m.veg:12:9:", "Young", kVeg + "*MATERIAL m\nENU, 1, -2, 0.3\n"},
      {"m.veg:12:12:", "Poisson", kVeg + "*MATERIAL m\nENU, 1, 2, 0.5\n"},
      {"m.veg:12:", "entries", kVeg + "*MATERIAL m\nORTHOTROPIC_N3G3, 1,1,1,1,1,1,1,1,1\n"},
      {"m.veg:13:10:", "second time", kVeg + "*MATERIAL m\nENU 1 1 0\n*MATERIAL m\nENU 1 1 0\n"},
      {"m.veg:11:10:", "name", kVeg + "*MATERIAL\nENU 1 1 0\n"},
      {"m.veg:12:4:", "element 2", kVeg + "*SET s\n1, 2\n"},
      {"m.veg:12:1:", "element 0", kVeg + "*SET s\n0\n"},
      {"m.veg:12:1:", "x", kVeg + "*SET s\nx\n"},
      {"m.veg:13:5:", "second time", kVeg + "*SET s\n1\n*SET s\n1\n"},
      {"m.veg:11:5:", "allElements", kVeg + "*SET allElements\n1\n"},
      {"m.veg:14:1:", "set 't'", kVeg + "*MATERIAL m\nENU 1 1 0\n*REGION\nt,m\n"},
      {"m.veg:12:1:", "material 'm'", kVeg + "*REGION\nallElements,m\n"},
      {"m.veg:12:1:", "wanted", kVeg + "*REGION\nallElements\n"},
      {"m.veg:1:1:", "CR alone", "*VERTICES\r4 3 0 0\r1 0 0 0\r"},
      {"m.veg:1:1:", "not text", std::string("\0\1\2\3", 4) + kVeg},
      {"m.veg:7:1:", "in no tetrahedron",
       replaced(replaced(kVeg, "4 3 0 0", "5 3 0 0"), "*ELEMENTS", "5 1 1 1\n*ELEMENTS")},
      {"m.veg:12:1:", "third",
       "*VERTICES\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n*ELEMENTS\nTET\n3 4 0\n1 1 2 3 4\n2 1 2 3 4\n3 1 2 3 "
       "4\n"},
  };
  for (const Case& c : cases) check_refused(c.place, c.part, [&] { parse_veg("m.veg", c.text, "."); });
}

TEST_CASE("each damaged TetGen pair gives one located error") {
  const std::string node = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", ele = "1 4 0\n0 0 1 2 3\n";
  const auto nodes = [&](const char* place, const char* part, const std::string& from, const std::string& to) {
    check_refused(place, part, [&] { parse_tetgen("m.node", replaced(node, from, to), "m.ele", ele); });
  };
  const auto tets = [&](const char* place, const char* part, const std::string& from, const std::string& to) {
    check_refused(place, part, [&] { parse_tetgen("m.node", node, "m.ele", replaced(ele, from, to)); });
  };
  CHECK(parse_tetgen("m.node", node, "m.ele", ele).mesh.tets.size() == 1);
  nodes("m.node:1:3:", "dimension 2", "4 3 0 0", "4 2 0 0");
  nodes("m.node:3:1:", "vertex 5", "1 1 0 0", "5 1 0 0");
  nodes("m.node:2:1:", "first vertex 7", "0 0 0 0", "7 0 0 0");
  nodes("m.node:6:", "ends early", "4 3 0 0", "5 3 0 0");
  nodes("m.node:5:1:", "end after 3", "4 3 0 0", "3 3 0 0");
  nodes("m.node:3:3:", "inf", "1 1 0 0", "1 inf 0 0");
  nodes("m.node:3:5:", "3 entries", "1 1 0 0", "1 1 0");
  nodes("m.node:3:9:", "'9'", "1 1 0 0", "1 1 0 0 9");
  nodes("m.node:1:7:", "markers", "4 3 0 0", "4 3 0 2");
  tets("m.ele:1:3:", "second-order", "1 4 0", "1 10 0");
  tets("m.ele:1:3:", "3 corners", "1 4 0", "1 3 0");
  tets("m.ele:2:1:", "counts from 0", "0 0 1 2 3", "1 1 2 3 4");
  tets("m.ele:2:9:", "vertex 4", "0 0 1 2 3", "0 0 1 2 4");
  tets("m.ele:2:1:", "inverted", "0 0 1 2 3", "0 1 0 2 3");
  tets("m.ele:3:", "ends early", "1 4 0", "2 4 0");
  tets("m.ele:3:1:", "end after 1", "2 3\n", "2 3\n1 0 1 2 3\n");
  tets("m.ele:2:3:", "0.5", "0 0 1 2 3", "0 0.5 1 2 3");
  tets("m.ele:1:1:", "0 tetrahedra", "1 4 0", "0 4 0");
  const TetFile extra = parse_tetgen("m.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 9 9 9\n", "m.ele", ele);
  CHECK(extra.mesh.vertices.size() == 4);
  CHECK(extra.notes.size() == 1);
}

TEST_CASE("each damaged .msh file gives one located error") {
  const std::string a =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n9 0 0 1\n$EndNodes\n$Elements\n1\n1 "
      "4 2 0 0 1 2 3 9\n$EndElements\n";
  const std::string b =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 "
      "1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n";
  CHECK(parse_msh("m.msh", a).mesh.tets.size() == 1);
  CHECK(parse_msh("m.msh", b).mesh.tets.size() == 1);
  const auto refuse = [](const char* place, const char* part, const std::string& text) {
    check_refused(place, part, [&] { parse_msh("m.msh", text); });
  };
  refuse("m.msh:1:1:", "empty", "");
  refuse("m.msh:1:1:", "$MeshFormat", a.substr(35));
  refuse("m.msh:2:1:", "4.0", replaced(a, "2.2", "4.0"));
  refuse("m.msh:2:1:", "'1'", replaced(a, "2.2", "1"));
  refuse("m.msh:2:5:", "file type 2", replaced(a, "2.2 0 8", "2.2 2 8"));
  refuse("m.msh:3:1:", "order of bytes", replaced(a, "2.2 0 8", "2.2 1 8"));
  refuse("m.msh:2:7:", "data size 4", replaced(a, "2.2 0 8", "2.2 0 4"));
  refuse("m.msh:11:1:", "'$Data' does not end", replaced(a, "$Elements\n", "$Data\n"));
  refuse("m.msh:10:1:", "x should follow", replaced(a, "9 0 0 1\n", "9\n"));
  refuse("m.msh:10:1:", "whole", replaced(replaced(a, "$EndNodes", "oops\n$EndNodes"), "$Nodes\n4", "$Nodes\n5"));
  refuse("m.msh:8:1:", "node 2 a second time", replaced(a, "3 0 1 0", "2 0 1 0"));
  refuse("m.msh:13:17:", "node 8", replaced(a, "1 2 3 9", "1 2 3 8"));
  refuse("m.msh:13:3:", "hexahedron", replaced(a, "1 4 2 0 0", "1 5 2 0 0"));
  refuse("m.msh:13:3:", "second-order", replaced(a, "1 4 2 0 0", "1 11 2 0 0"));
  refuse("m.msh:13:3:", "type 99", replaced(a, "1 4 2 0 0", "1 99 2 0 0"));
  refuse("m.msh:13:1:", "inverted", replaced(a, "1 2 3 9", "2 1 3 9"));
  refuse("m.msh:13:1:", "twice", replaced(a, "1 2 3 9", "1 1 3 9"));
  refuse("m.msh:7:3:", "nan", replaced(a, "2 1 0 0", "2 nan 0 0"));
  refuse("m.msh:15:1:", "surface-only mesh: 1 triangles", replaced(a, "1 4 2 0 0 1 2 3 9", "1 2 2 0 0 1 2 3"));
  refuse("m.msh:14:1:", "element's number", replaced(a, "$Elements\n1\n", "$Elements\n2\n"));
  refuse("m.msh:14:1:", "$EndElements", replaced(a, "9\n$EndE", "9\n2 4 2 0 0 1 2 3 9\n$EndE"));
  refuse("m.msh:14:1:", "$Elements", a.substr(0, a.find("$Elements")) + "$Foo\n\n$EndFoo\n");
  refuse("m.msh:15:1:", "second $Nodes", a + "$Nodes\n0\n$EndNodes\n");
  refuse("m.msh:4:1:", "before $Nodes",
         replaced(a, a.substr(a.find("$Nodes"), a.find("$Elements") - a.find("$Nodes")), ""));
  refuse("m.msh:15:1:", "'stray'", a + "stray\n");
  refuse("m.msh:14:5:", "4 nodes", replaced(b, "1 4 1 4", "1 5 1 4"));
  refuse("m.msh:19:9:", "1 elements", replaced(b, "$Elements\n1 1 1 1", "$Elements\n1 7 1 1"));
  refuse("m.msh:6:1:", "dimension 4", replaced(b, "3 1 0 4", "4 1 0 4"));
  refuse("m.msh:5:1:", "room", replaced(b, "1 4 1 4", "99999999 4 1 4"));
  // parametric nodes are legal: a parameter a dimension follows each position
  const TetFile parametric =
      parse_msh("m.msh", replaced(replaced(b, "3 1 0 4", "1 1 1 4"), "0 0 0\n1 0 0\n0 1 0\n0 0 1",
                                  "0 0 0 .5\n1 0 0 .5\n0 1 0 .5\n0 0 1 .5"));
  CHECK(parametric.mesh.vertices[3] == Vec3(0, 0, 1));
}

TEST_CASE("each damaged binary .msh file gives one located error") {
  const TetMesh mesh = make_tet_box(Vec3::Ones(), 1, 1, 1);
  for (const std::string& whole :
       {test::msh22_binary(mesh), test::msh41_binary(mesh), test::msh22_binary(mesh, true)}) {
    const std::size_t end = whole.rfind("$EndElements");
    // cut anywhere before the last word
    for (std::size_t length = 0; length < end + 12; ++length)
      check_refused("m.msh:", ";", [&] { parse_msh("m.msh", std::string_view(whole).substr(0, length)); });
    // a byte changed anywhere: refused or read, never more
    test::Random random(3);
    int refused = 0;
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(256.0 * random.u());
      try {
        parse_msh("m.msh", damaged);
      } catch (const InputError& error) {
        ++refused;
        CHECK(std::string(error.what()).substr(0, 6) == "m.msh:");
      }
    }
    CHECK(refused > 50);
  }
  const auto refuse = [](const char* part, std::string text, std::size_t at, char byte) {
    text[at] = byte;
    check_refused("m.msh:", part, [&] { parse_msh("m.msh", text); });
  };
  const std::string a = test::msh22_binary(mesh), b = test::msh41_binary(mesh);
  const std::size_t nodes = a.find("$Nodes\n8\n") + 9, elements = a.find("$Elements\n7\n") + 12;
  refuse("node 7 a second time", a, nodes + 28, 7);
  std::string infinite = a;
  infinite[nodes + 10] = '\xf0';
  refuse("finite", infinite, nodes + 11, '\x7f');
  refuse("hexahedron", a, elements + 36, 5);
  refuse("a block of 100 elements", a, elements + 40, 100);
  refuse("node 8", a, elements + 48 + 12, 8);
  refuse("$EndNodes", a, a.find("$EndNodes"), '!');
  refuse("room", b, b.find("$Nodes\n") + 7 + 9, '\x7f');
}

TEST_CASE("meshes of other programs are read") {
  const std::filesystem::path folder = std::filesystem::path(test::shared_file("meshes/cube.msh")).parent_path();
  if (folder.empty()) {
    WARN("no sample meshes at hand: skipped");
    return;
  }
  const auto count = [&](const char* name) { return read_tet_file(folder / name).mesh.tets.size(); };
  CHECK(count("cube.msh") == 6);
  CHECK(count("vega/beam3/beam3_tet.veg") == 450);
  const TetFile turtle = read_tet_file(folder / "vega/turtle/turtle-volumetric-heterogeneous.ortho.veg");
  CHECK(turtle.mesh.tets.size() == 1185);
  CHECK(turtle.materials.size() == 2);
  CHECK(std::count(turtle.element_material.begin(), turtle.element_material.end(), 0) > 0);
  CHECK(std::count(turtle.element_material.begin(), turtle.element_material.end(), 1) > 0);
  for (const char* name : {"mat20x20.msh", "sphere1K.msh", "tet-pyramid.msh", "torus.msh", "erleben/spike.msh",
                           "test_2.2_ascii.msh", "test_4.1_ascii.msh"}) {
    CAPTURE(name);
    try {
      const TetFile file = read_tet_file(folder / name);
      CHECK_FALSE(check_tet_mesh(file.mesh).has_value());
    } catch (const InputError& error) {
      WARN(error.what());
      CHECK(std::string(name).substr(0, 5) == "test_");
    }
  }
  check_refused((folder / "vega/beam3/beam3.veg").string() + ":", "cubes",
                [&] { read_tet_file(folder / "vega/beam3/beam3.veg"); });
  // binary; both hold two quadrangles and no tetrahedron, which is found after all of it was read
  for (const char* name : {"test_2.2_bin.msh", "test_4.1_bin.msh"})
    check_refused((folder / name).string() + ":", "surface-only mesh", [&] { read_tet_file(folder / name); });
}
