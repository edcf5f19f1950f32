#include "viewer/export/surface_fields.hpp"

#include <cmath>
#include <limits>

#include "engine/contact/contact_frame.hpp"
#include "engine/geometry/distance.hpp"
#include "engine/geometry/nearest_triangle.hpp"

namespace impinge {

Vec3 world_impulse(const ContactRecord& contact) { return contact_axes(contact.normal).transpose() * contact.lambda; }

int ContactFields::triangle_at(const ExportBody& body, const BodyRecord& now, const Vec3& point) {
  const TriangleMesh& surface = *body.surface;
  const auto tree = trees_.try_emplace(body.surface.get(), BoxTree()).first;
  if (tree->second.is_empty()) tree->second = BoxTree(triangle_boxes(surface.triangles, surface.vertices));
  return nearest_triangle(tree->second, surface.triangles, surface.vertices, now.file_pose.apply_inverse(point))
      .triangle;
}

std::vector<ContactField> ContactFields::find(const std::vector<ExportBody>& bodies,
                                              const std::vector<std::vector<Vec3>>& vertices,
                                              const StepRecord& record) {
  std::vector<ContactField> fields(bodies.size());
  std::vector<int> place(record.bodies.size(), -1);  // of a body among `bodies`
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    fields[i].impulse.assign(vertices[i].size(), Vec3::Zero());
    fields[i].gap.assign(vertices[i].size(), std::numeric_limits<double>::quiet_NaN());
    if (there(bodies[i], record) != nullptr)
      place[static_cast<std::size_t>(bodies[i].body.value())] = static_cast<int>(i);
  }
  const auto put = [&](BodyIndex of, TriangleIndex named, const Vec3& point, const Vec3& impulse, double gap) {
    const int at = place[static_cast<std::size_t>(of.value())];
    if (at < 0) return;
    const auto i = static_cast<std::size_t>(at);
    const BodyRecord& now = record.bodies[static_cast<std::size_t>(of.value())];
    const bool is_own = !named.is_none() && !is_shown_apart(*now.shape);
    const int triangle = is_own ? named.value() : triangle_at(bodies[i], now, point);
    if (triangle < 0) return;
    const Triangle& corners = bodies[i].surface->triangles[static_cast<std::size_t>(triangle)];
    const auto corner = [&](std::size_t k) { return vertices[i][static_cast<std::size_t>(corners[k])]; };
    const Vec3 weights = nearest_weights(point, {corner(0), corner(1), corner(2)});
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(corners[k]);
      fields[i].impulse[v] += weights[static_cast<Eigen::Index>(k)] * impulse;
      fields[i].gap[v] = std::fmin(fields[i].gap[v], gap);  // a number wins over none
    }
  };
  for (const ContactRecord& c : record.contacts) {
    const Vec3 impulse = world_impulse(c);
    put(c.body_a, c.triangle_a, c.point_a, impulse, c.gap);
    put(c.body_b, c.triangle_b, c.point_b, -impulse, c.gap);
  }
  return fields;
}

}  // namespace impinge
