#include "engine/io/scene/scene_motion.hpp"

#include <fmt/format.h>

namespace impinge {
namespace {

// beyond these a number is a slip, not a quantity
constexpr Range kTime{0.0, 1e9};

}  // namespace

std::vector<MotionKey> read_motion(const TomlNode& node, const std::string& what, const Vec3& position,
                                   const Vec3& rotation) {
  if (node.kind != TomlNode::array || node.items.empty())
    refuse(node.place,
           node.kind == TomlNode::array ? what + " has no key frames"
                                        : fmt::format("{} is {}", what, toml_kind_name(node)),
           "[ { time = s, position = [x, y, z], rotation = [x, y, z] }, ... ] is wanted", "add at least one");
  std::vector<MotionKey> keys;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string name = fmt::format("{}[{}]", what, i);
    const TomlNode& table = scene_table(node.items[i], name);
    check_keys(table, name, {"time", "position", "rotation"});
    const TomlEntry* time = table.find("time");
    if (time == nullptr) refuse(table.place, name + " has no time", "time = seconds is wanted", "add it");
    MotionKey key{scene_real(time->value, name + ".time", kTime), position, rotation};
    if (const TomlEntry* entry = table.find("position"))
      key.position = scene_vector(entry->value, name + ".position", kLength);
    if (const TomlEntry* entry = table.find("rotation"))
      key.rotation = scene_vector(entry->value, name + ".rotation", kAngle);
    if (!keys.empty() && !(key.time > keys.back().time))
      refuse(time->value.place,
             fmt::format("{}.time is {} after {}", name, shortest(key.time), shortest(keys.back().time)),
             "times must increase", "sort the key frames");
    keys.push_back(key);
  }
  return keys;
}

}  // namespace impinge
