#include "viewer/gl/marks.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

constexpr float kDiscRim = 1.4f;            // pixels
constexpr float kLeastShare = 1.0f / 3.0f;  // of a disc's size where it has no room
constexpr float kLeastDisc = 2.5f;          // pixels: smaller ones are no longer told apart by colour
constexpr float kFaint = 0.30f;             // of a mark's opacity where it is hidden and shown all the same

std::array<std::uint8_t, 4> packed(const Color& c) {
  const auto byte = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::min(1.0f, std::max(0.0f, v))));
  };
  return {byte(c.r), byte(c.g), byte(c.b), byte(c.a)};
}

/// Calls draw(opacity) with the depth test set: once, or twice for marks that stay faint where they are hidden.
void with_depth(Depth depth, const std::function<void(float)>& draw) {
  if (depth == Depth::both) {
    glDepthFunc(GL_GREATER);
    draw(kFaint);
  }
  glDepthFunc(depth == Depth::on_top ? GL_ALWAYS : GL_LEQUAL);
  draw(1.0f);
  glDepthFunc(GL_LEQUAL);
}

}  // namespace

Marks::Marks(bool ids)
    : segment_program_("segment", ids ? "IDS" : ""),
      point_program_("point", ids ? "IDS" : ""),
      flat_program_("flat", ids ? "IDS" : "") {
  segment_array_.floats(0, 3, sizeof(Segment), offsetof(Segment, a), true);
  segment_array_.floats(1, 3, sizeof(Segment), offsetof(Segment, b), true);
  segment_array_.bytes(2, 4, sizeof(Segment), offsetof(Segment, color), true);
  segment_array_.floats(3, 1, sizeof(Segment), offsetof(Segment, width), true);
  point_array_.floats(0, 3, sizeof(Disc), offsetof(Disc, position), true);
  point_array_.bytes(1, 4, sizeof(Disc), offsetof(Disc, color), true);
  point_array_.floats(2, 1, sizeof(Disc), offsetof(Disc, diameter), true);
  point_array_.floats(3, 1, sizeof(Disc), offsetof(Disc, rim), true);
  flat_array_.floats(0, 3, sizeof(Corner), offsetof(Corner, position));
  flat_array_.bytes(1, 4, sizeof(Corner), offsetof(Corner, color));
}

void Marks::draw(const DrawList& list, const ViewTransform& view, float pixel_scale) {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  for (const Depth depth : {Depth::tested, Depth::both, Depth::on_top}) {
    draw_triangles(list, view, depth);
    draw_lines(list, view, pixel_scale, depth);
    for (const bool heads : {false, true}) draw_arrows(list, view, pixel_scale, depth, heads);
    draw_points(list, view, pixel_scale, depth);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Marks::draw_triangles(const DrawList& list, const ViewTransform& view, Depth depth) {
  std::vector<Corner> corners;
  for (const DrawTriangle& t : list.triangles)
    if (t.depth == depth)
      for (const Vec3& p : t.corners) corners.push_back({view.to_eye(p), packed(t.color)});
  if (corners.empty()) return;
  flat_array_.set_vertices(corners.data(), corners.size() * sizeof(Corner));
  flat_program_.use();
  flat_program_.set("projection", view.projection);
  with_depth(depth, [&](float opacity) {
    flat_program_.set("opacity", opacity);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size()));
  });
}

void Marks::draw_segments(const std::vector<Segment>& segments, const ViewTransform& view, bool heads, float rim,
                          Depth depth) {
  if (segments.empty()) return;
  segment_array_.set_vertices(segments.data(), segments.size() * sizeof(Segment));
  segment_program_.use();
  segment_program_.set("projection", view.projection);
  segment_program_.set("picture", Eigen::Vector2f(static_cast<float>(view.width), static_cast<float>(view.height)));
  segment_program_.set("nearest", static_cast<float>(view.near));
  segment_program_.set("head", heads ? 1.0f : 0.0f);
  segment_program_.set("rim", rim);
  with_depth(depth, [&](float opacity) {
    segment_program_.set("opacity", opacity);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(segments.size()));
  });
}

void Marks::draw_lines(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth) {
  std::vector<Segment> segments;
  for (const DrawLine& line : list.lines)
    if (line.depth == depth)
      segments.push_back({view.to_eye(line.a), view.to_eye(line.b), packed(line.color), line.width * pixel_scale});
  draw_segments(segments, view, false, 0.0f, depth);
}

void Marks::draw_arrows(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth, bool heads) {
  std::vector<Segment> segments;
  for (const DrawArrow& arrow : list.arrows) {
    if (arrow.depth != depth || arrow.has_head != heads) continue;
    double scale = 1.0;
    if (arrow.length_px > 0.0f) {
      const double away = -(view.rotation * (arrow.tail - view.eye)).z();
      scale = arrow.length_px * pixel_scale * std::max(away, view.near) / view.focal;
    }
    segments.push_back({view.to_eye(arrow.tail), view.to_eye(arrow.tail + scale * arrow.direction), packed(arrow.color),
                        arrow.width * pixel_scale});
  }
  draw_segments(segments, view, heads, 1.1f * pixel_scale, depth);
}

void Marks::draw_points(const DrawList& list, const ViewTransform& view, float pixel_scale, Depth depth) {
  std::vector<Disc> discs;
  for (const DrawPoint& p : list.points) {
    if (p.depth != depth) continue;
    const float whole = p.diameter * pixel_scale;
    float diameter = whole;
    if (p.room > 0.0) {
      const double away = std::max(-(view.rotation * (p.position - view.eye)).z(), view.near);
      const float least = std::min(whole, std::max(kLeastShare * whole, kLeastDisc));
      diameter = std::clamp(static_cast<float>(p.room * view.focal / away), least, whole);
    }
    discs.push_back({view.to_eye(p.position), packed(p.color), diameter, kDiscRim * pixel_scale * diameter / whole});
  }
  if (discs.empty()) return;
  point_array_.set_vertices(discs.data(), discs.size() * sizeof(Disc));
  point_program_.use();
  point_program_.set("projection", view.projection);
  point_program_.set("picture", Eigen::Vector2f(static_cast<float>(view.width), static_cast<float>(view.height)));
  with_depth(depth, [&](float opacity) {
    point_program_.set("opacity", opacity);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(discs.size()));
  });
}

}  // namespace impinge
