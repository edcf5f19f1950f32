// TetGen 1.5: vertices in a .node file, tetrahedra in an .ele file, `#` remarks anywhere.
#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/io/tets/tet_draft.hpp"
#include "engine/io/text_lines.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostAttributes = 1000;

/// A count that the rest of the file has room for (`least` bytes an entry).
long long read_count(const TextLines& in, std::size_t word, const char* what, std::size_t least) {
  const std::int64_t n = in.integer(word);
  if (n < 1 || n > kMostTets || static_cast<std::uint64_t>(n) * least > in.bytes_left() + least)
    in.fail(word, fmt::format("{} {}", n, what), "at least one and no more than the file has room for",
            "export the file again");
  return n;
}

std::size_t read_small(const TextLines& in, std::size_t word, std::size_t most, const char* what) {
  const std::int64_t n = in.integer(word);
  if (n < 0 || n > static_cast<std::int64_t>(most))
    in.fail(word, fmt::format("{} {}", n, what), fmt::format("0 to {} are allowed", most), "export the file again");
  return static_cast<std::size_t>(n);
}

void need_words(const TextLines& in, std::size_t count, const char* what) {
  if (in.count() < count)
    in.fail(in.count() - 1, fmt::format("the line ends after {} entries", in.count()),
            fmt::format("{} has {}", what, count), "export the file again");
  if (in.count() > count)
    in.fail(count, quoted(in.word(count)), fmt::format("{} has {} entries", what, count), "remove what follows");
}

void need_end(TextLines& in, long long count, const char* what) {
  if (in.next())
    in.fail(0, quoted(in.word(0)), fmt::format("the file should end after {} {}", count, what),
            "mend the count in its first line");
}

}  // namespace

TetFile parse_tetgen(const std::string& node_name, std::string_view node_bytes, const std::string& ele_name,
                     std::string_view ele_bytes) {
  TetDraft draft;
  draft.files = {node_name, ele_name};
  TetMesh& mesh = draft.result.mesh;

  TextLines nodes(node_name, node_bytes, '#');
  nodes.need("the number of vertices");
  if (nodes.count() < 2 || nodes.count() > 4)
    nodes.fail(0, fmt::format("{} numbers", nodes.count()),
               "a .node file starts with vertices, dimension, attributes, markers",
               "check that this is a TetGen .node file");
  const long long vertex_count = read_count(nodes, 0, "vertices", 8);
  if (nodes.integer(1) != 3)
    nodes.fail(1, fmt::format("dimension {}", nodes.integer(1)), "three-dimensional vertices are read",
               "export a volume mesh");
  const std::size_t vertex_words = 4 + (nodes.count() > 2 ? read_small(nodes, 2, kMostAttributes, "attributes") : 0) +
                                   (nodes.count() > 3 ? read_small(nodes, 3, 1, "markers") : 0);
  std::int64_t base = 0;
  for (long long i = 0; i < vertex_count; ++i) {
    nodes.need("a vertex");
    need_words(nodes, vertex_words, "a vertex of this file");
    const std::int64_t label = nodes.integer(0);
    if (i == 0) {
      base = label;
      if (base != 0 && base != 1)
        nodes.fail(0, fmt::format("first vertex {}", base), "vertices are counted from 0 or 1",
                   "export the file again");
    }
    if (label != base + i)
      nodes.fail(0, fmt::format("vertex {}", label), fmt::format("vertex {} should follow", base + i),
                 "export the file again");
    const double x = nodes.real(1), y = nodes.real(2), z = nodes.real(3);
    for (std::size_t k = 4; k < vertex_words; ++k) nodes.real(k);
    mesh.vertices.emplace_back(x, y, z);
    draft.vertex_place.push_back({0, nodes.line(), 1});
    draft.vertex_label.push_back(label);
  }
  need_end(nodes, vertex_count, "vertices");

  TextLines tets(ele_name, ele_bytes, '#');
  tets.need("the number of tetrahedra");
  if (tets.count() < 2 || tets.count() > 3)
    tets.fail(0, fmt::format("{} numbers", tets.count()), "an .ele file starts with tetrahedra, corners, attributes",
              "check that this is a TetGen .ele file");
  const long long tet_count = read_count(tets, 0, "tetrahedra", 10);
  const std::int64_t corners = tets.integer(1);
  if (corners == 10)
    tets.fail(1, "10 corners", "tetrahedra of 4 corners are read",
              "mesh again without second-order elements (TetGen's -o2)");
  if (corners != 4) tets.fail(1, fmt::format("{} corners", corners), "tetrahedra have 4", "export the file again");
  const std::size_t tet_words = 5 + (tets.count() > 2 ? read_small(tets, 2, kMostAttributes, "attributes") : 0);
  for (long long i = 0; i < tet_count; ++i) {
    tets.need("a tetrahedron");
    need_words(tets, tet_words, "a tetrahedron of this file");
    const std::int64_t label = tets.integer(0);
    if (i == 0 && label != base)
      tets.fail(0, fmt::format("first tetrahedron {}", label), fmt::format("the .node file counts from {}", base),
                "export both files together");
    if (label != base + i)
      tets.fail(0, fmt::format("tetrahedron {}", label), fmt::format("tetrahedron {} should follow", base + i),
                "export the file again");
    Tet tet;
    for (int k = 0; k < 4; ++k) {
      const std::int64_t v = tets.integer(k + 1);
      if (v < base || v >= base + vertex_count)
        tets.fail(k + 1, fmt::format("vertex {}", v),
                  fmt::format("there are vertices {} to {}", base, base + vertex_count - 1),
                  "export both files together");
      tet[k] = static_cast<int>(v - base);
    }
    for (std::size_t k = 5; k < tet_words; ++k) tets.real(k);
    mesh.tets.push_back(tet);
    draft.tet_place.push_back({1, tets.line(), 1});
    draft.tet_label.push_back(label);
  }
  need_end(tets, tet_count, "tetrahedra");
  return finish_tets(std::move(draft), true);
}

}  // namespace impinge
