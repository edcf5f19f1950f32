#include "engine/io/meshes/mesh_memory.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace impinge {

namespace fs = std::filesystem;

namespace {

constexpr std::streamsize kPiece = 1 << 16;
constexpr int kPieces = 17;
constexpr double kStlHead = 84.0, kStlFacet = 50.0;

std::string piece_at(std::ifstream& in, double offset) {
  std::string piece(kPiece, '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(offset));
  in.read(piece.data(), kPiece);
  piece.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return piece;
}

/// Words of the lines of a piece, without the broken line at its begin unless it is the file's.
template <class Line>
void for_each_line(const std::string& piece, bool is_first, Line line) {
  for (std::size_t begin = is_first ? 0 : piece.find('\n') + 1; begin < piece.size();) {
    const std::size_t end = std::min(piece.find('\n', begin), piece.size());
    line(std::string_view(piece).substr(begin, end - begin));
    begin = end + 1;
  }
}

// "element vertex 35947"
void count_ply(const std::string& head, MeshCount& count) {
  std::istringstream in(head.substr(0, head.find("end_header")));
  std::string word, name;
  while (in >> word) {
    if (word != "element") continue;
    double number = 0.0;
    if (in >> name >> number) (name == "vertex" ? count.vertices : name == "face" ? count.triangles : number) = number;
  }
}

void count_off(const std::string& head, MeshCount& count) {
  for_each_line(head, true, [&](std::string_view line) {
    line = line.substr(0, line.find('#'));
    if (count.vertices > 0.0 || line.empty()) return;
    std::istringstream in{std::string(line)};
    std::string word;
    if (line.find("OFF") != std::string_view::npos) in >> word;
    double vertices = 0.0, faces = 0.0;
    if (in >> vertices >> faces) count.vertices = vertices, count.triangles = faces;
  });
}

/// Texts whose lines say what they are, in any order: a few pieces stand for the rest.
void sample_lines(std::ifstream& in, std::string_view vertex, std::string_view face, MeshCount& count) {
  double seen = 0.0, vertices = 0.0, triangles = 0.0;
  for (int k = 0; k < kPieces; ++k) {
    const double offset = std::max(0.0, count.bytes - kPiece) * k / (kPieces - 1);
    const std::string piece = piece_at(in, offset);
    seen += static_cast<double>(piece.size());
    for_each_line(piece, offset == 0.0, [&](std::string_view line) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
      if (line.substr(0, vertex.size()) == vertex) ++vertices;
      if (line.substr(0, face.size()) != face) return;
      double corners = 0.0;
      for (std::size_t i = 1; i < line.size(); ++i) corners += line[i - 1] == ' ' && line[i] > ' ';
      triangles += std::max(1.0, corners - 2.0);
    });
  }
  if (seen <= 0.0) return;
  count.vertices = vertices * std::max(1.0, count.bytes / seen);
  count.triangles = triangles * std::max(1.0, count.bytes / seen);
}

}  // namespace

MeshCount estimate_mesh(const fs::path& path) {
  MeshCount count;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return count;
  count.bytes = static_cast<double>(fs::file_size(path, error));
  std::ifstream in(path, std::ios::binary);
  if (error || !in) return {};
  const std::string head = piece_at(in, 0.0);
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  if (ending == ".ply") {
    count_ply(head, count);
  } else if (ending == ".off") {
    count_off(head, count);
  } else if (ending == ".obj") {
    sample_lines(in, "v ", "f ", count);
  } else if (ending == ".stl") {
    count.is_soup = true;
    count.triangles = (count.bytes - kStlHead) / kStlFacet;
    if (head.compare(0, 5, "solid") == 0 && head.find("facet") != std::string::npos)
      sample_lines(in, "vertex ", "facet ", count);
    count.vertices = 3.0 * count.triangles;
  } else {
    // assimp's: as dense as a binary file usually is
    count.triangles = count.bytes / 40.0;
    count.vertices = 3.0 * count.triangles;
    count.is_soup = true;
  }
  // a header may say anything: no more than there are bytes for
  count.triangles = std::clamp(count.triangles, 0.0, count.bytes / 4.0);
  count.vertices = std::clamp(count.vertices, 0.0, count.bytes / 2.0);
  return count;
}

double surface_bytes(double triangles) {
  // a triangle 12 bytes, its share of vertices 12, of edges 24, of what joins them 26
  return 74.0 * triangles;
}

double surface_memory(const MeshCount& count) {
  // vectors grow by doubling; the edges are sorted in a list of half edges of 20 bytes; measured with spheres of 0.3 and
  // 1.3 million triangles in each format
  const double mesh = 1.5 * (24.0 * count.vertices + 12.0 * count.triangles);
  const double body = surface_bytes(count.triangles) + 12.0 * count.triangles;
  const double joined = surface_bytes(count.triangles) + (count.is_soup ? 160.0 : 86.0) * count.triangles;
  return std::max({count.bytes + mesh, joined, surface_bytes(count.triangles) + body});
}

}  // namespace impinge
