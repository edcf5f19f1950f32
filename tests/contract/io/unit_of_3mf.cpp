// 3MF files, which say their unit in an XML attribute inside of a zip archive; the archive is written here by hand.
#include <fmt/format.h>
#include <libdeflate.h>
#include <catch2/catch.hpp>

#include <map>

#include "engine/geometry/aabb.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void little_endian(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 255);
}

/// Nothing is compressed: method 0.
std::string zip(const std::map<std::string, std::string>& files) {
  std::string out, directory;
  for (const auto& [name, text] : files) {
    const auto size = static_cast<std::uint32_t>(text.size());
    std::string head;
    little_endian(head, 20, 2);                             // version
    for (int i = 0; i < 4; ++i) little_endian(head, 0, 2);  // flags, method, time, date
    little_endian(head, libdeflate_crc32(0, text.data(), text.size()), 4);
    little_endian(head, size, 4);
    little_endian(head, size, 4);
    little_endian(head, static_cast<std::uint32_t>(name.size()), 2);
    little_endian(head, 0, 2);  // extra
    directory += "PK\1\2";
    little_endian(directory, 20, 2);
    directory += head;
    little_endian(directory, 0, 2);  // comment
    little_endian(directory, 0, 2);  // disk
    little_endian(directory, 0, 2);
    little_endian(directory, 0, 4);
    little_endian(directory, static_cast<std::uint32_t>(out.size()), 4);
    directory += name;
    out += "PK\3\4" + head + name + text;
  }
  const auto begin = static_cast<std::uint32_t>(out.size());
  out += directory + "PK\5\6";
  little_endian(out, 0, 4);
  for (int i = 0; i < 2; ++i) little_endian(out, static_cast<std::uint32_t>(files.size()), 2);
  little_endian(out, static_cast<std::uint32_t>(directory.size()), 4);
  little_endian(out, begin, 4);
  little_endian(out, 0, 2);
  return out;
}

/// A tetrahedron of 2 by 3 by 4 units.
std::string file_3mf(const std::string& attributes) {
  const std::string model = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- <model unit='foot'> is a remark -->\n"
      "<model {} xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
      "<resources><object id=\"1\" type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"2\" "
      "y=\"0\" "
      "z=\"0\"/><vertex x=\"0\" y=\"3\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"4\"/></vertices><triangles><triangle "
      "v1=\"0\" "
      "v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle "
      "v1=\"1\" v2=\"2\" "
      "v3=\"3\"/></triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n",
      attributes);
  return zip({{"[Content_Types].xml",
               "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
               "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
               "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
               "</Types>"},
              {"_rels/.rels",
               "<?xml version=\"1.0\"?><Relationships "
               "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
               "Target=\"/3D/3dmodel.model\" "
               "Id=\"rel0\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
              {"3D/3dmodel.model", model}});
}

}  // namespace

TEST_CASE("a 3MF file comes out in metres, whatever unit it says") {
  const TempFolder folder;
  const std::map<std::string, double> units = {{"unit=\"micron\"", 1e-6},
                                               {"unit=\"millimeter\"", 1e-3},
                                               {"unit=\"centimeter\"", 1e-2},
                                               {"unit=\"inch\"", 0.0254},
                                               {"unit = 'foot'", 0.3048},
                                               {"unit=\"meter\"", 1.0},
                                               {"requiredunit=\"m\"", 1e-3},
                                               {"unit=\"inch\" other=\"x\"", 0.0254},
                                               {"", 1e-3}};
  for (const auto& [attributes, metres] : units) {
    CAPTURE(attributes);
    folder.write("a.3mf", file_3mf(attributes));
    MeshOrigin origin;
    const TriangleMesh mesh = read_mesh(folder.path() / "a.3mf", {}, &origin);
    Aabb box;
    for (const Vec3& x : mesh.vertices) box.include(x);
    CHECK(mesh.triangles.size() == 4);
    CHECK((box.extent() - metres * Vec3(2.0, 3.0, 4.0)).norm() <= 1e-7 * metres);
    CHECK(origin.unit == fmt::format("{:.6g} m, as it says", metres));
  }
  folder.write("a.3mf", file_3mf("unit=\"cubit\""));
  const Outcome refused = impinge_run(folder.path(), {"mesh", "a.3mf"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("its unit is 'cubit'") != std::string::npos);
}
