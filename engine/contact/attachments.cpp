#include "engine/contact/attachments.hpp"

#include <fmt/format.h>

#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"

namespace impinge {
namespace {

AttachmentEnd make_end(const AttachmentDescription& d, const std::string& name, const Bodies& bodies) {
  AttachmentEnd end;
  end.point.local = d.point;
  if (name.empty()) return end;
  end.body = bodies.find(name);
  if (end.body.is_none()) {
    const std::string near = nearest_word(name, bodies.names());
    throw InputError(fmt::format("attachment '{}' names the body '{}', which is not there{}", d.name, name,
                                 near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  try {
    end.point = bodies[end.body].inner_point(d.point);
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("attachment '{}' has its point {}; a point in it, or close to its surface, is wanted; "
                    "move the point",
                    d.name, error.what()));
  }
  return end;
}

}  // namespace

Vec3 AttachmentEnd::position(const Bodies& bodies) const {
  return body.is_none() ? point.local : bodies[body].position_of(point);
}

Attachment make_attachment(const AttachmentDescription& d, const Bodies& bodies) {
  Attachment attachment{d.name, make_end(d, d.body_a, bodies), make_end(d, d.body_b, bodies)};
  const auto moves = [&](const AttachmentEnd& end) { return !end.body.is_none() && bodies[end.body].has_freedom(); };
  if (!moves(attachment.a) && !moves(attachment.b))
    throw InputError(fmt::format(
        "attachment '{}' joins nothing that can move; a dynamic or deformable body is wanted at one end", d.name));
  return attachment;
}

}  // namespace impinge
