#include "engine/world/attachments.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {
namespace {

// in heights of the nearest tetrahedron: farther out, a small strain of it would be a large motion of the point
constexpr double kMostOutside = 1.0;

AttachmentEnd make_end(const AttachmentDescription& d, const std::string& name, std::span<const RigidBody> bodies,
                       const BodyNames& names) {
  AttachmentEnd end;
  end.local = d.point;
  if (name.empty()) return end;
  end.body = names.find(name);
  if (end.body < 0) {
    const std::string near = nearest_word(name, names.all());
    throw InputError(fmt::format("attachment '{}' names the body '{}', which is not there{}", d.name, name,
                                 near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  const RigidBody& body = bodies[end.body];
  if (!body.soft) {
    end.local = body.pose.apply_inverse(d.point);
    return end;
  }
  TetMesh now = body.soft->fem.fem.rest();
  for (int i = 0; i < body.soft->fem.nodes(); ++i) now.vertices[i] = body.soft->fem.position.segment<3>(3 * i);
  const Embedding place = embed(now, std::span(&d.point, 1));
  if (place.farthest > kMostOutside)
    throw InputError(
        fmt::format("attachment '{}' has its point {:.2g} tetrahedron heights outside of the deformable body '{}'; a "
                    "point in it, or close to its surface, is wanted; "
                    "move the point",
                    d.name, place.farthest, name));
  end.tet = place.tet[0];
  end.weight = place.weight[0];
  return end;
}

}  // namespace

Vec3 AttachmentEnd::position(std::span<const RigidBody> bodies) const {
  if (body < 0) return local;
  const RigidBody& b = bodies[body];
  if (!b.soft) return b.pose.apply(local);
  Vec3 x = Vec3::Zero();
  const Tet& nodes = b.soft->fem.fem.rest().tets[tet];
  for (int k = 0; k < 4; ++k) x += weight[k] * b.soft->fem.position.segment<3>(3 * nodes[k]);
  return x;
}

Attachment make_attachment(const AttachmentDescription& d, std::span<const RigidBody> bodies, const BodyNames& names) {
  Attachment attachment{d.name, make_end(d, d.body_a, bodies, names), make_end(d, d.body_b, bodies, names)};
  const auto moves = [&](const AttachmentEnd& end) { return end.body >= 0 && bodies[end.body].has_freedom(); };
  if (!moves(attachment.a) && !moves(attachment.b))
    throw InputError(fmt::format(
        "attachment '{}' joins nothing that can move; a dynamic or deformable body is wanted at one end", d.name));
  return attachment;
}

}  // namespace impinge
