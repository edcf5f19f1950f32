#include "viewer/gl/grid.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/gl/gl.hpp"

namespace impinge {
namespace {

struct Corner {
  Eigen::Vector3f position;
  Eigen::Vector2f in_plane, from_center;
};

/// 1, 2 or 5 times a power of ten, at most `length`.
double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length))), mantissa = length / power;
  return power * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

}  // namespace

Grid::Grid(bool ids) : program_("grid", ids ? "IDS" : "") {
  array_.floats(0, 3, sizeof(Corner), offsetof(Corner, position));
  array_.floats(1, 2, sizeof(Corner), offsetof(Corner, in_plane));
  array_.floats(2, 2, sizeof(Corner), offsetof(Corner, from_center));
}

void Grid::draw(const DrawPlane& plane, const Camera& camera, const ViewTransform& view, float pixel_scale) {
  const Vec3 n = plane.normal;
  if (n.dot(camera.eye) <= plane.offset) return;  // seen from its solid side it would only be in the way
  // axes in the plane that follow the world's where they can
  const Vec3 guide = std::abs(n.x()) < 0.9 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ());
  const Vec3 u = (guide - n * n.dot(guide)).normalized(), v = n.cross(u);
  const double radius = view.floor_radius, cell = round_length(view.distance / 12.0);
  const Vec3 center = camera.target + n * (plane.offset - n.dot(camera.target)), origin = n * plane.offset;
  // the grid's lines are the world's; only the distance from a crossing near by goes to single precision
  const double period = 5.0 * cell;
  const double cu = u.dot(center - origin), cv = v.dot(center - origin);
  const double su = cu - period * std::floor(cu / period), sv = cv - period * std::floor(cv / period);
  Corner corners[4];
  for (int i = 0; i < 4; ++i) {
    const double a = i & 1 ? radius : -radius, b = i & 2 ? radius : -radius;
    corners[i].position = view.to_eye(center + a * u + b * v);
    corners[i].in_plane = Eigen::Vector2d(su + a, sv + b).cast<float>();
    corners[i].from_center = Eigen::Vector2d(a / radius, b / radius).cast<float>();
  }
  array_.set_vertices(corners, sizeof corners);
  program_.use();
  program_.set("projection", view.projection);
  program_.set("pixel_scale", std::max(1.0f, pixel_scale));
  program_.set("cell", static_cast<float>(cell));
  program_.set("color", Eigen::Vector4f(plane.color.r, plane.color.g, plane.color.b, plane.color.a));
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
}

}  // namespace impinge
