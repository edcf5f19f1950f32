// STL, ASCII and binary: a soup of triangles, three new vertices each. Whoever needs a closed surface welds them.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "engine/core/error.hpp"
#include "engine/io/meshes/mesh_readers.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {

static_assert(std::endian::native == std::endian::little, "binary files are read in place");

namespace {

constexpr std::size_t kHead = 84, kFacet = 50;  // bytes

TriangleMesh read_binary(const std::string& name, std::string_view bytes, std::uint32_t facets) {
  TriangleMesh mesh;
  mesh.vertices.reserve(std::size_t{facets} * 3);
  mesh.triangles.reserve(facets);
  for (std::uint32_t f = 0; f < facets; ++f) {
    const std::size_t start = kHead + f * kFacet + 12;  // after the normal, which the corners give better
    float x[9];
    std::memcpy(x, bytes.data() + start, sizeof x);
    for (int i = 0; i < 9; ++i)
      if (!std::isfinite(x[i]))
        throw InputError(fmt::format(
            "{}: byte {}: a coordinate that is not finite; a finite number is wanted; export the file again", name,
            start + 4 * i));
    const int first = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i < 3; ++i) mesh.vertices.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

void need_words(TextLines& in, std::initializer_list<std::string_view> words, const char* what) {
  in.need(what);
  std::size_t i = 0;
  for (const std::string_view word : words) {
    if (i >= in.count() || in.word(i) != word)
      in.fail(i, quoted(i < in.count() ? in.word(i) : "the end of the line"), fmt::format("{} should stand here", what),
              "export the file again");
    ++i;
  }
}

TriangleMesh read_ascii(const std::string& name, std::string_view bytes) {
  TextLines in(name, bytes);
  TriangleMesh mesh;
  bool inside = false;
  while (in.next()) {
    if (!inside) {
      if (in.word(0) != "solid")
        in.fail(0, quoted(in.word(0)), "the word solid should stand here", "export the file again");
      inside = true;
    } else if (in.word(0) == "endsolid") {
      inside = false;
    } else if (in.word(0) == "facet") {
      need_words(in, {"outer", "loop"}, "'outer loop'");
      const int first = static_cast<int>(mesh.vertices.size());
      for (int i = 0; i < 3; ++i) {
        need_words(in, {"vertex"}, "'vertex x y z'");
        const double x = in.real(1), y = in.real(2), z = in.real(3);
        mesh.vertices.emplace_back(x, y, z);
      }
      need_words(in, {"endloop"}, "'endloop'");
      need_words(in, {"endfacet"}, "'endfacet'");
      mesh.triangles.push_back({first, first + 1, first + 2});
    } else {
      in.fail(0, quoted(in.word(0)), "facet or endsolid should stand here", "export the file again");
    }
  }
  if (inside)
    throw InputError(
        fmt::format("{}:{}: the file ends early; 'endsolid' should follow; export it again", name, in.line()));
  return mesh;
}

}  // namespace

TriangleMesh read_stl(const std::string& name, std::string_view bytes) {
  std::uint32_t facets = 0;
  if (bytes.size() >= kHead) std::memcpy(&facets, bytes.data() + 80, sizeof facets);
  // some writers start binary files with "solid" too, so the size decides
  const bool fits = bytes.size() >= kHead && bytes.size() == kHead + std::uint64_t{facets} * kFacet;
  if (fits && facets <= kMostElements) return read_binary(name, bytes, facets);
  // of a binary file that is cut off the zeros tell
  if (bytes.substr(0, 5) == "solid" && bytes.find('\0') == std::string_view::npos) return read_ascii(name, bytes);
  throw InputError(
      fmt::format("{}: byte 80: {} facets in a file of {} bytes; binary STL has 84 + 50 bytes a facet, ASCII STL "
                  "starts with 'solid'; export the file again",
                  name, facets, bytes.size()));
}

}  // namespace impinge
