#include "viewer/present/mesh_picture.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/gl/context.hpp"
#include "viewer/gl/renderer.hpp"
#include "viewer/panels/overlay/overlay.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostWired = 40000;  // triangles whose edges are drawn: more would be black
constexpr double kCrease = 40.0;           // degrees

constexpr Color kBorder = hex(0xff3b3b), kMulti = hex(0xff5fb0), kOpposite = hex(0xffd23b), kCrossing = hex(0xff8a1f),
                kFlat = hex(0x56c1f5), kThin = hex(0xc59bff);

void draw_marks(const MeshMarks& marks, DrawList& list) {
  const TriangleMesh& mesh = marks.mesh;
  const auto edges = [&](const std::vector<std::pair<int, int>>& pairs, Color color) {
    for (const auto& [a, b] : pairs)
      list.lines.push_back({mesh.vertices[a], mesh.vertices[b], color, 3.0f, Depth::both});
  };
  const auto triangles = [&](const std::vector<int>& which, Color color) {
    for (const int t : which) {
      const Triangle& v = mesh.triangles[t];
      list.triangles.push_back(
          {{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]}, with_alpha(color, 0.8f)});
    }
  };
  triangles(marks.thin, kThin);
  triangles(marks.crossing, kCrossing);
  edges(marks.misoriented, kOpposite);
  edges(marks.border, kBorder);
  edges(marks.nonmanifold, kMulti);
  for (const int t : marks.degenerate) {
    const Triangle& v = mesh.triangles[t];
    list.points.push_back({(mesh.vertices[v[0]] + mesh.vertices[v[1]] + mesh.vertices[v[2]]) / 3.0, kFlat, 7.0f});
  }
}

void draw_legend(const Pen& pen, const MeshMarks& marks, const std::string& title,
                 const std::vector<std::string>& lines) {
  struct Row {
    Color color;
    std::string text;
  };
  std::vector<Row> rows = {{role::kInk, title}};
  for (const std::string& line : lines) rows.push_back({with_alpha(role::kInk, 0.8f), line});
  const auto mark = [&](bool is_there, Color color, const char* text) {
    if (is_there) rows.push_back({color, text});
  };
  mark(!marks.border.empty(), kBorder, "border");
  mark(!marks.nonmanifold.empty(), kMulti, "three triangles or more in an edge");
  mark(!marks.misoriented.empty(), kOpposite, "neighbours face opposite ways");
  mark(!marks.crossing.empty(), kCrossing, "crosses or touches another triangle");
  mark(!marks.degenerate.empty(), kFlat, "no area");
  mark(!marks.thin.empty(), kThin, "thin place");
  float width = 0.0f;
  for (const Row& row : rows) width = std::max(width, pen.text_width(row.text));
  const float margin = pen.margin(), padding = pen.padding();
  pen.sheet(margin, margin, width + 2.0f * padding, static_cast<float>(rows.size()) * pen.row() + 2.0f * padding);
  for (std::size_t i = 0; i < rows.size(); ++i)
    pen.text(margin + padding, margin + padding + static_cast<float>(i) * pen.row(), rows[i].color, rows[i].text);
}

}  // namespace

Image mesh_picture(const MeshMarks& marks, const std::string& title, const std::vector<std::string>& lines, int width,
                   int height) {
  const std::unique_ptr<GlContext> context = make_offscreen_context();
  context->make_current();
  Framebuffer target(width, height);
  Renderer renderer;
  DrawList list;
  const TriangleMesh& mesh = marks.mesh;
  Aabb box;
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) box.include(mesh.vertices[v]);
  if (!box.is_empty()) {
    DrawSurface surface;
    surface.surface = std::make_shared<const ShadedSurface>(make_shaded_surface(mesh, make_topology(mesh), kCrease));
    surface.color = hex(0xb9c4d0);
    list.surfaces.push_back(surface);
    if (mesh.triangles.size() <= kMostWired)
      for (const auto& [a, b] : surface.surface->edges)
        list.lines.push_back({surface.surface->positions[a].cast<double>(),
                              surface.surface->positions[b].cast<double>(), with_alpha(role::kOutline, 0.35f), 0.8f});
    draw_marks(marks, list);
  }
  Camera camera;
  camera.look_at(Vec3(1.0, 0.8, 2.0), Vec3::Zero());
  camera.fit(box, static_cast<double>(width) / height);
  const float scale = std::max(0.5f, static_cast<float>(height) / 720.0f);
  renderer.draw(list, camera, {{hex(0x5a6472), hex(0x23272e)}, true, scale}, target);
  Overlay overlay(std::max(1, static_cast<int>(std::lround(height / 800.0))));
  overlay.draw(width, height, [&](const Pen& pen) { draw_legend(pen, marks, title, lines); });
  Image image;
  target.read(image);
  return image;
}

}  // namespace impinge
