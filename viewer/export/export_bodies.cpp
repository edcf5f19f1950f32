#include "viewer/export/export_bodies.hpp"

#include <cmath>
#include <map>

#include "engine/shapes/primitives.hpp"
#include "viewer/layers/body_style.hpp"

namespace impinge {

namespace {

constexpr double kFar = 4.0;  // sizes: single precision has 6e-8 of a coordinate

Aabb box_round(std::span<const Vec3> points) {
  Aabb box;
  for (const Vec3& x : points) box.include(x);
  return box;
}

/// Vertices in the frame of the body's centre of mass.
TriangleMesh surface_of(const Shape& shape) {
  return shape.mesh() != nullptr ? shape.mesh()->shown().mesh : shape.drawn();
}

Vec3 center_in_file(const BodyRecord& body) { return body.file_pose.apply_inverse(body.pose.position); }

}  // namespace

bool is_shown_apart(const Shape& shape) { return shape.mesh() != nullptr && shape.mesh()->full != nullptr; }

std::vector<ExportBody> export_bodies(const StepRecord& start, const std::vector<std::string>& given) {
  std::map<const Shape*, std::shared_ptr<const TriangleMesh>> of_shapes;
  const std::vector<Color> colors = body_colors(start, given);
  std::vector<ExportBody> bodies;
  for (std::size_t i = 0; i < start.bodies.size(); ++i) {
    const BodyRecord& body = start.bodies[i];
    if (body.shape == nullptr || body.shape->as<Plane>() != nullptr) continue;
    ExportBody& out = bodies.emplace_back();
    out.body = BodyIndex(i);
    out.name = body.name;
    out.kind = body.kind;
    out.color = colors[i];
    out.start = body.file_pose;
    if (out.is_deformable()) {
      TriangleMesh surface = surface_of(*body.shape);
      surface.vertices.assign(body.vertices.begin(), body.vertices.end());
      out.origin = far_origin(box_round(surface.vertices));
      out.surface = std::make_shared<const TriangleMesh>(std::move(surface));
      continue;
    }
    std::shared_ptr<const TriangleMesh>& shared = of_shapes[body.shape];
    if (shared == nullptr) {
      TriangleMesh surface = surface_of(*body.shape);
      const Vec3 center = center_in_file(body);
      for (Vec3& x : surface.vertices) x += center;
      shared = std::make_shared<const TriangleMesh>(std::move(surface));
    }
    out.surface = shared;
    out.origin = far_origin(box_round(shared->vertices));
  }
  return bodies;
}

const BodyRecord* there(const ExportBody& body, const StepRecord& record) {
  const auto i = static_cast<std::size_t>(body.body.value());
  return i < record.bodies.size() && !record.bodies[i].deleted ? &record.bodies[i] : nullptr;
}

std::vector<Vec3> world_surface(const ExportBody& body, const StepRecord& record) {
  const BodyRecord& now = record.bodies[static_cast<std::size_t>(body.body.value())];
  if (!now.vertices.empty() && !is_shown_apart(*now.shape)) return {now.vertices.begin(), now.vertices.end()};
  std::vector<Vec3> vertices = body.surface->vertices;
  for (Vec3& x : vertices) x = now.file_pose.apply(x);
  return vertices;
}

std::vector<Vec3> local_surface(const ExportBody& body, const StepRecord& record) {
  if (!body.is_deformable()) return start_surface(body);
  std::vector<Vec3> vertices = world_surface(body, record);
  for (Vec3& x : vertices) x -= body.origin;
  return vertices;
}

Pose local_pose(const ExportBody& body, const StepRecord& record) {
  if (body.is_deformable()) return {Mat3::Identity(), body.origin};
  const Pose& pose = record.bodies[static_cast<std::size_t>(body.body.value())].file_pose;
  return {pose.rotation, pose.apply(body.origin)};
}

std::vector<Vec3> start_surface(const ExportBody& body) {
  std::vector<Vec3> vertices = body.surface->vertices;
  for (Vec3& x : vertices) x -= body.origin;
  return vertices;
}

Pose start_pose(const ExportBody& body) {
  if (body.is_deformable()) return {Mat3::Identity(), body.origin};
  return {body.start.rotation, body.start.apply(body.origin)};
}

Vec3 far_origin(const Aabb& box) {
  if (box.is_empty() || box.center().norm() <= kFar * box.extent().norm()) return Vec3::Zero();
  return box.center();
}

Quat quaternion_of(const Mat3& rotation, const std::optional<Quat>& before) {
  Quat q = Quat(rotation).normalized();
  const bool flip = before ? q.dot(*before) < 0.0 : q.w() < 0.0;
  if (flip) q.coeffs() = -q.coeffs();
  return q;
}

Aabb bounds_of(const std::vector<ExportBody>& bodies, const StepRecord& record) {
  Aabb box;
  for (const ExportBody& body : bodies)
    for (const Vec3& x : world_surface(body, record)) box.include(x);
  return box;
}

Vec3 linear_color(const Color& color) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return {linear(color.r), linear(color.g), linear(color.b)};
}

}  // namespace impinge
