#include "engine/io/scene/scene_attachments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/io/scene/scene_body.hpp"

namespace impinge {
namespace {

const Body& body_named(const TomlNode& node, const std::string& what, const Bodies& bodies) {
  const std::string& name = scene_text(node, what);
  if (const BodyIndex i = bodies.find(name); !i.is_none()) return bodies[i];
  const std::vector<std::string> names = bodies.names();
  const std::string near = nearest_word(name, names);
  refuse(node.place, fmt::format("{} names the body {}, which is not there", what, toml_string(name)),
         bodies.is_empty() ? "the scene has no bodies" : "bodies: " + some_of(names),
         near.empty() ? "name one of them" : fmt::format("did you mean '{}'?", near));
}

}  // namespace

AttachmentDescription read_attachment(const TomlNode& table, int index, const Bodies& bodies) {
  scene_table(table, "attachment");
  check_keys(table, "attachment", {"name", "body_a", "body_b", "point"});
  AttachmentDescription a;
  a.name = fmt::format("attachment_{}", index);
  if (const TomlEntry* name = table.find("name")) {
    a.name = scene_text(name->value, "attachment.name");
    check_name(name->value, a.name, "an attachment");
  }
  const TomlEntry *first = table.find("body_a"), *second = table.find("body_b"), *point = table.find("point");
  if (first == nullptr)
    refuse(table.place, fmt::format("{} has no body_a", a.name), "the name of a body is wanted",
           "add body_a = \"...\"");
  const Body& body_a = body_named(first->value, a.name + ".body_a", bodies);
  a.body_a = body_a.name;
  bool moves = body_a.has_freedom();
  if (second != nullptr) {
    const Body& body_b = body_named(second->value, a.name + ".body_b", bodies);
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
