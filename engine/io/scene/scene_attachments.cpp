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

constexpr const char* kWherePoint =
    "write point = [x, y, z], one place in world coordinates, where both are at the start";

enum class Word { point, slide };

Word read_link_kind(const TomlNode& table, const std::string& name) {
  const TomlEntry* kind = table.find("kind");
  if (kind == nullptr) return Word::point;
  const std::string& word = scene_text(kind->value, "attachment.kind");
  if (word == "point") return Word::point;
  if (word == "slide") return Word::slide;
  const std::string near = nearest_word(word, {"point", "slide"});
  refuse(kind->value.place, fmt::format("{}.kind is {}", name, toml_string(word)), "\"point\" or \"slide\"",
         near.empty() ? "write one of them" : fmt::format("did you mean '{}'?", near));
}

Vec3 read_axis(const TomlEntry& entry, const std::string& name) {
  const Vec3 axis = scene_vector(entry.value, "attachment." + entry.key, {-1e6, 1e6});
  if (axis.norm() > 0.0) return axis;
  refuse(entry.value.place, fmt::format("{}.{} has no length", name, entry.key),
         "[x, y, z], of any length but 0, in world coordinates at the start", "give it one");
}

/// What a slide says of where it slides: one of three keys.
void read_slide(const TomlNode& table, AttachmentDescription& a) {
  constexpr const char* kWays =
      "direction = [x, y, z] (along a line), normal = [x, y, z] (in a plane) or on = "
      "\"surface\" (of body_b)";
  const TomlEntry* given = nullptr;
  for (const TomlEntry& entry : table.entries) {
    if (entry.key != "direction" && entry.key != "normal" && entry.key != "on") continue;
    if (given != nullptr)
      refuse(entry.place, fmt::format("{} has {} beside {}", a.name, entry.key, given->key),
             fmt::format("one of {}", kWays), "keep the one that is meant");
    given = &entry;
  }
  if (given == nullptr)
    refuse(table.find("kind")->value.place, fmt::format("{} slides, but nothing says along what", a.name),
           fmt::format("one of {}", kWays), "add it");
  if (given->key != "on") {
    a.kind = given->key == "normal" ? AttachmentKind::plane : AttachmentKind::line;
    a.axis = read_axis(*given, a.name);
    return;
  }
  const std::string& on = scene_text(given->value, "attachment.on");
  if (on != "surface")
    refuse(given->value.place, fmt::format("{}.on is {}", a.name, toml_string(on)), "\"surface\", that of body_b",
           "write on = \"surface\"");
  if (a.body_b.empty())
    refuse(given->place, fmt::format("{} slides on a surface, but has no body_b", a.name),
           "the world has no surface; the name of a body is wanted", "add body_b = \"...\"");
  a.kind = AttachmentKind::surface;
}

void refuse_slide_keys(const TomlNode& table, const std::string& name) {
  for (const TomlEntry& entry : table.entries)
    if (entry.key == "direction" || entry.key == "normal" || entry.key == "on")
      refuse(entry.place, fmt::format("{} has {}, but its kind is \"point\"", name, entry.key),
             "direction, normal and on are for kind = \"slide\"", "add kind = \"slide\", or remove it");
}

}  // namespace

AttachmentDescription read_attachment(const TomlNode& table, int index, const Bodies& bodies) {
  scene_table(table, "attachment");
  check_keys(
      table, "attachment", {"name", "kind", "body_a", "body_b", "point", "direction", "normal", "on", "collide"},
      {{"anchor", kWherePoint}, {"position", kWherePoint}, {"anchor_a", kWherePoint}, {"anchor_b", kWherePoint}});
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
  const Word kind = read_link_kind(table, a.name);
  if (point == nullptr)
    refuse(table.place, fmt::format("{} has no point", a.name),
           "point = [x, y, z] in metres, where both are at the start", "add it");
  a.point = scene_vector(point->value, "attachment.point", {-1e6, 1e6});
  if (kind == Word::slide)
    read_slide(table, a);
  else
    refuse_slide_keys(table, a.name);
  if (const TomlEntry* collide = table.find("collide")) {
    a.collide = scene_flag(collide->value, "attachment.collide");
    if (second == nullptr)
      refuse(collide->place, fmt::format("{} has collide, but no body_b", a.name),
             "whether its two bodies touch; the world has no surface", "remove it");
  }
  return a;
}

}  // namespace impinge
