#include "engine/io/scene_attachments.hpp"

#include <fmt/format.h>

namespace impinge {

AttachmentDescription read_attachment(const TomlNode& table, int index) {
  scene_table(table, "attachment");
  check_keys(table, "attachment", {"name", "body_a", "body_b", "point"});
  AttachmentDescription a;
  a.name = fmt::format("attachment_{}", index);
  if (const TomlEntry* name = table.find("name")) a.name = scene_text(name->value, "attachment.name");
  const TomlEntry *first = table.find("body_a"), *second = table.find("body_b"), *point = table.find("point");
  if (first == nullptr) refuse(table.place, fmt::format("{} has no body_a", a.name), "the name of a body is wanted", "add body_a = \"...\"");
  a.body_a = scene_text(first->value, "attachment.body_a");
  if (second != nullptr) a.body_b = scene_text(second->value, "attachment.body_b");
  if (a.body_a == a.body_b) refuse(second->value.place, fmt::format("{} joins '{}' with itself", a.name, a.body_a), "two bodies, or one and the world (no body_b)", "name another");
  if (point == nullptr) refuse(table.place, fmt::format("{} has no point", a.name), "point = [x, y, z] in metres, where both are at the start", "add it");
  a.point = scene_vector(point->value, "attachment.point", {-1e6, 1e6});
  return a;
}

}  // namespace impinge
