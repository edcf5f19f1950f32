#include "engine/io/scene/scene_attachments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/io/scene/scene_body.hpp"

namespace impinge {
namespace {

const RigidBody& body_named(const TomlNode& node, const std::string& what, std::span<const RigidBody> bodies) {
  const std::string& name = scene_text(node, what);
  std::vector<std::string> names;
  for (const RigidBody& body : bodies) {
    if (body.name == name) return body;
    names.push_back(body.name);
  }
  const std::string near = nearest_word(name, names);
  refuse(node.place, fmt::format("{} names the body {}, which is not there", what, toml_string(name)),
         names.empty() ? "the scene has no bodies" : fmt::format("bodies: {}", fmt::join(names, ", ")),
         near.empty() ? "name one of them" : fmt::format("did you mean '{}'?", near));
}

}  // namespace

AttachmentDescription read_attachment(const TomlNode& table, int index, std::span<const RigidBody> bodies) {
  scene_table(table, "attachment");
  check_keys(table, "attachment", {"name", "body_a", "body_b", "point"});
  AttachmentDescription a;
  a.name = fmt::format("attachment_{}", index);
  if (const TomlEntry* name = table.find("name")) {
    a.name = scene_text(name->value, "attachment.name");
    if (!is_body_name(a.name))
      refuse(name->value.place, fmt::format("{} as an attachment's name", toml_string(a.name)),
             "letters, digits, _ and - are allowed, a letter or _ first", "rename it");
  }
  const TomlEntry *first = table.find("body_a"), *second = table.find("body_b"), *point = table.find("point");
  if (first == nullptr)
    refuse(table.place, fmt::format("{} has no body_a", a.name), "the name of a body is wanted",
           "add body_a = \"...\"");
  const RigidBody& body_a = body_named(first->value, a.name + ".body_a", bodies);
  a.body_a = body_a.name;
  bool moves = body_a.has_freedom();
  if (second != nullptr) {
    const RigidBody& body_b = body_named(second->value, a.name + ".body_b", bodies);
    a.body_b = body_b.name;
    moves |= body_b.has_freedom();
  }
  if (a.body_a == a.body_b)
    refuse(second->value.place, fmt::format("{} joins '{}' with itself", a.name, a.body_a),
           "two bodies, or one and the world (no body_b)", "name another");
  if (!moves)
    refuse(table.place, fmt::format("{} joins nothing that can move", a.name),
           "a dynamic or deformable body is wanted at one end", "name one");
  if (point == nullptr)
    refuse(table.place, fmt::format("{} has no point", a.name),
           "point = [x, y, z] in metres, where both are at the start", "add it");
  a.point = scene_vector(point->value, "attachment.point", {-1e6, 1e6});
  return a;
}

}  // namespace impinge
