// Geomview's OFF, ASCII, with the COFF, NOFF and STOFF variants, whose extra columns are skipped.
#include <fmt/format.h>

#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/meshes/polygon.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {

TriangleMesh read_off(const std::string& name, std::string_view bytes) {
  TextLines in(name, bytes, '#');
  in.need("the word OFF");
  std::string_view word = in.word(0);
  std::string_view prefix = word;
  if (prefix.size() >= 3 && prefix.substr(prefix.size() - 3) == "OFF")
    prefix.remove_suffix(3);
  else
    in.fail(0, quoted(word), "an OFF file starts with the word OFF", "check the file's ending");
  for (const char c : prefix)
    if (std::string_view("STCN").find(c) == std::string_view::npos)
      in.fail(0, quoted(word), "three-dimensional OFF (OFF, COFF, NOFF) is read", "convert the file to PLY");

  std::size_t first = 1;
  if (in.count() == 1) {
    in.need("the counts of vertices, faces and edges");
    first = 0;
  } else if (in.word(1) == "BINARY") {
    in.fail(1, "'BINARY'", "ASCII OFF is read", "convert the file to PLY");
  }
  const std::int64_t vertices = in.integer(first), faces = in.integer(first + 1);
  // a vertex takes at least "0 0 0\n", a face "3 0 1 2\n" (the last line may lack its end)
  const auto most = static_cast<std::int64_t>(in.bytes_left() + 1);
  if (vertices < 0 || vertices > kMostElements || vertices * 6 > most)
    in.fail(first, fmt::format("{} vertices", vertices), "no more than the file has room for", "export the file again");
  if (faces < 0 || faces > kMostElements || faces * 4 > most)
    in.fail(first + 1, fmt::format("{} faces", faces), "no more than the file has room for", "export the file again");

  TriangleMesh mesh;
  mesh.vertices.reserve(vertices);
  for (std::int64_t i = 0; i < vertices; ++i) {
    in.need("a vertex");
    const double x = in.real(0), y = in.real(1), z = in.real(2);
    mesh.vertices.emplace_back(x, y, z);
  }
  mesh.triangles.reserve(faces);
  std::vector<int> corners;
  for (std::int64_t i = 0; i < faces; ++i) {
    in.need("a face");
    const std::int64_t n = in.integer(0);
    if (n < 3 || n > kMostCorners)
      in.fail(0, fmt::format("a face of {} corners", n), "a face has at least 3", "remove it from the file");
    corners.clear();
    for (std::int64_t k = 1; k <= n; ++k) {
      const std::int64_t v = in.integer(k);
      if (v < 0 || v >= vertices)
        in.fail(k, fmt::format("vertex {}", v), fmt::format("there are vertices 0 to {}", vertices - 1),
                "export the file again");
      corners.push_back(static_cast<int>(v));
    }
    append_polygon(corners, mesh.vertices, mesh.triangles);
  }
  if (in.next())
    in.fail(0, quoted(in.word(0)), fmt::format("the file should end after {} faces", faces),
            "mend the counts in its head");
  return mesh;
}

}  // namespace impinge
