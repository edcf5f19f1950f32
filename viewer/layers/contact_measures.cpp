#include "viewer/layers/contact_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace impinge {
namespace {

constexpr double kLeastOverlap = 1e-6;  // of a body's size

/// Of the body's material at a point of its triangle; of a deformable body what the nodes that carry it have.
Vec3 velocity_at(const BodyRecord& body, TriangleIndex triangle, const Vec3& point) {
  if (body.deformable == nullptr) return body.velocity + body.angular_velocity.cross(point - body.pose.position);
  const SurfaceMesh* mesh = body.shape->mesh();
  if (mesh == nullptr || triangle.is_none()) return body.velocity;
  const auto& t = mesh->mesh.triangles[static_cast<std::size_t>(triangle.value())];
  std::array<Vec3, 3> corner, speed;
  const Embedding& embedding = body.deformable->embedding;
  for (int k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(t[k]);
    corner[k] = body.vertices[v];
    speed[k] = Vec3::Zero();
    const Tet& tet = body.deformable->fem.rest().tets[static_cast<std::size_t>(embedding.tet[v])];
    for (int n = 0; n < 4; ++n) speed[k] += embedding.weight[v][n] * body.deformable->velocity.segment<3>(3 * tet[n]);
  }
  const Vec3 across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double area = across.squaredNorm();
  if (!(area > 0.0)) return speed[0];
  Vec3 velocity = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    velocity += across.dot((corner[(k + 1) % 3] - point).cross(corner[(k + 2) % 3] - point)) / area * speed[k];
  return velocity;
}

}  // namespace

double slip_speed(const StepRecord& record, const ContactRecord& contact) {
  const auto body = [&](BodyIndex b) -> const BodyRecord& {
    return record.bodies[static_cast<std::size_t>(b.value())];
  };
  const Vec3 v = velocity_at(body(contact.body_a), contact.triangle_a, contact.point_a) -
                 velocity_at(body(contact.body_b), contact.triangle_b, contact.point_b);
  return (v - contact.normal * contact.normal.dot(v)).norm();
}

double measure_of(const StepRecord& record, const ContactRecord& contact, ContactMeasure what) {
  switch (what) {
    case ContactMeasure::overlap:
      return std::max(0.0, -contact.gap);
    case ContactMeasure::impulse:
      return contact.lambda.x();
    case ContactMeasure::residual:
      return contact.residual;
    default:
      return slip_speed(record, contact);
  }
}

double least_shown(const StepRecord& record, ContactMeasure what) {
  double largest = 0.0;
  for (const BodyRecord& body : record.bodies) {
    const bool is_bounded = !body.bounds.is_empty() && body.bounds.extent().allFinite();
    if (body.kind != BodyKind::fixed && is_bounded) largest = std::max(largest, body.bounds.extent().norm());
  }
  return what == ContactMeasure::overlap ? std::max(kLeastShown, kLeastOverlap * largest) : kLeastShown;
}

ColorBar bar_of(ContactMeasure what, const ColorScale& scale, ColorMap map) {
  struct Words {
    const char *title, *unit;
  };
  constexpr Words kWords[] = {{"overlap", "m"}, {"normal impulse", "N s"}, {"slip", "m/s"}, {"residual", ""}};
  const Words& words = kWords[static_cast<std::size_t>(what)];
  return make_color_bar(words.title, words.unit, scale, map);
}

}  // namespace impinge
