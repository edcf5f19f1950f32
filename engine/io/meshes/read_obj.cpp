// Wavefront OBJ: polygonal surfaces. Texture coordinates, normals, groups and materials are skipped.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/meshes/polygon.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {

namespace {

constexpr std::string_view kSkipped[] = {"vt",       "vn",         "vp",        "o",      "g",     "s",   "mg",
                                         "usemtl",   "mtllib",     "l",         "p",      "bevel", "lod", "c_interp",
                                         "d_interp", "shadow_obj", "trace_obj", "usemap", "maplib"};

// the vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative numbers count back from the last vertex
int corner(const TextLines& in, std::size_t i, std::size_t vertices) {
  const std::string_view word = in.word(i);
  std::int64_t v = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
  if (error != std::errc() || (end != word.data() + word.size() && *end != '/'))
    in.fail(i, quoted(word), "a corner is v, v/vt, v//vn or v/vt/vn", "export the file again");
  const auto count = static_cast<std::int64_t>(vertices);
  const std::int64_t index = v < 0 ? count + v : v - 1;
  if (v == 0 || index < 0 || index >= count)
    in.fail(i, fmt::format("vertex {}", v), fmt::format("{} vertices came before this line, counted from 1", count),
            "export the file again");
  return static_cast<int>(index);
}

}  // namespace

TriangleMesh read_obj(const std::string& name, std::string_view bytes) {
  TextLines in(name, bytes, '#', '\\');
  TriangleMesh mesh;
  std::vector<int> corners;
  while (in.next()) {
    const std::string_view key = in.word(0);
    if (key == "v") {
      const double x = in.real(1), y = in.real(2), z = in.real(3);
      mesh.vertices.emplace_back(x, y, z);
    } else if (key == "f" || key == "fo") {
      if (in.count() < 4)
        in.fail(0, fmt::format("a face of {} corners", in.count() - 1), "a face has at least 3",
                "remove it from the file");
      corners.clear();
      for (std::size_t i = 1; i < in.count(); ++i) corners.push_back(corner(in, i, mesh.vertices.size()));
      append_polygon(corners, mesh.vertices, mesh.triangles);
    } else if (std::find(std::begin(kSkipped), std::end(kSkipped), key) == std::end(kSkipped)) {
      in.fail(0, quoted(key), "v, f and the usual attributes are read", "export the surface as polygons");
    }
  }
  return mesh;
}

}  // namespace impinge
