#include "engine/io/scene/scene_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/utf8.hpp"

namespace impinge {

namespace {

std::string found(const TomlNode& node) {
  return fmt::format("{} ({})", shortened(format_toml(node), 57), toml_kind_name(node));
}

/// `--set simulation.gravity=0,0,-9.8`: a list that came as a text.
bool lacks_brackets(const TomlNode& node) {
  return node.kind == TomlNode::text && find_comma(node.string) != std::string::npos &&
         node.string.find_first_of("[]") == std::string::npos;
}
std::string in_brackets(const TomlNode& node) { return fmt::format("put it in brackets: [{}]", node.string); }

std::string interval(Range range) { return fmt::format("[{}, {}]", shortest(range.low), shortest(range.high)); }

}  // namespace

void refuse(const std::string& place, const std::string& found, const std::string& allowed, const std::string& remedy) {
  throw InputError(fmt::format("{}: {}; {}; {}", place, found, allowed, remedy));
}

double scene_real(const TomlNode& node, const std::string& what, Range range) {
  if (!node.is_number())
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "a real number is wanted", "write a number");
  const double value = node.as_number();
  // also catches NaN, infinity and numbers too large for TOML's parser, which come as the largest double
  if (!(value >= range.low && value <= range.high))
    refuse(node.place, fmt::format("{} is {}", what, shortest(value)), "a number in " + interval(range) + " is allowed",
           "change it");
  return value;
}

std::optional<double> scene_real_or(std::string_view word, const TomlNode& node, const std::string& what, Range range) {
  if (node.kind == TomlNode::text && node.string == word) return std::nullopt;
  if (!node.is_number())
    refuse(node.place, fmt::format("{} is {}", what, found(node)),
           fmt::format("a real number or \"{}\" is wanted", word), "write one of them");
  return scene_real(node, what, range);
}

double scene_positive(const TomlNode& node, const std::string& what, double high) {
  if (!node.is_number())
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "a positive real number is wanted",
           "write a number");
  const double value = node.as_number();
  if (!(value > 0.0 && value <= high))
    refuse(node.place, fmt::format("{} is {}", what, shortest(value)),
           fmt::format("a number greater than 0 and at most {} is allowed", shortest(high)), "change it");
  return value;
}

Vec3 scene_vector(const TomlNode& node, const std::string& what, Range range) {
  if (node.kind != TomlNode::array)
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "a vector [x, y, z] is wanted",
           lacks_brackets(node) ? in_brackets(node) : "write three numbers");
  if (node.items.size() != 3)
    refuse(node.place, fmt::format("{} has {} numbers", what, node.items.size()), "a vector [x, y, z] is wanted",
           "write three numbers");
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = scene_real(node.items[i], what, range);
  return v;
}

bool scene_flag(const TomlNode& node, const std::string& what) {
  if (node.kind != TomlNode::boolean)
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "true or false is wanted", "write one of them");
  return node.flag;
}

const std::string& scene_text(const TomlNode& node, const std::string& what) {
  if (node.kind != TomlNode::text)
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "a text is wanted", "put it in quotes");
  return node.string;
}

const TomlNode& scene_table(const TomlNode& node, const std::string& what) {
  if (node.kind != TomlNode::table)
    refuse(node.place, fmt::format("{} is {}", what, found(node)), "a table { ... } is wanted",
           "write its keys in braces");
  return node;
}

void check_keys(const TomlNode& table, const std::string& what, const std::vector<std::string>& allowed,
                std::initializer_list<OtherKey> others) {
  for (const TomlEntry& entry : table.entries) {
    if (std::find(allowed.begin(), allowed.end(), entry.key) != allowed.end()) continue;
    const std::string near = nearest_word(entry.key, allowed);
    const auto* other =
        std::find_if(others.begin(), others.end(), [&](const OtherKey& o) { return o.key == entry.key; });
    refuse(entry.place, fmt::format("unknown key '{}' in {}", entry.key, what),
           fmt::format("allowed: {}", fmt::join(allowed, ", ")),
           other != others.end() ? std::string(other->remedy)
           : near.empty()        ? "remove it"
                                 : fmt::format("did you mean '{}'?", near));
  }
}

ParameterValue scene_value(const Parameter& row, const TomlNode& node) {
  ParameterValue value;
  const auto wrong = [&] {
    refuse(node.place, fmt::format("{} is {}", row.path, found(node)), "allowed: " + describe_allowed(row),
           "change its type");
  };
  switch (node.kind) {
    case TomlNode::boolean:
      value = node.flag;
      break;
    case TomlNode::integer:
      value = node.whole;
      break;
    case TomlNode::real:
      value = node.number;
      break;
    case TomlNode::text:
      value = node.string;
      break;
    case TomlNode::array:
      if (row.kind == ParameterKind::vector3) {
        value = scene_vector(node, row.path, row.range);
      } else if (row.kind == ParameterKind::text_list) {
        std::vector<std::string> texts;
        for (const TomlNode& item : node.items) texts.push_back(scene_text(item, row.path));
        value = std::move(texts);
      } else {
        wrong();
      }
      break;
    default:
      wrong();
  }
  if (lacks_brackets(node) && (row.kind == ParameterKind::vector3 || row.kind == ParameterKind::text_list))
    refuse(node.place, fmt::format("{} is {}", row.path, found(node)), "allowed: " + describe_allowed(row),
           in_brackets(node));
  // a bare word given to `--set` for a row of texts: `--set view.layers=meshes`
  if (row.kind == ParameterKind::text_list && node.kind == TomlNode::text)
    value = std::vector<std::string>{node.string};
  if (row.kind == ParameterKind::text && node.is_number() && node.place.rfind("--set", 0) == 0)
    value = format_toml(node);
  try {
    return checked_value(row, std::move(value));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; change it", node.place, error.what()));
  }
}

TomlNode toml_node(const ParameterValue& value) {
  TomlNode node;
  if (const auto* flag = std::get_if<bool>(&value)) node.kind = TomlNode::boolean, node.flag = *flag;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) node.kind = TomlNode::integer, node.whole = *whole;
  if (const auto* number = std::get_if<double>(&value)) node.kind = TomlNode::real, node.number = *number;
  if (const auto* text = std::get_if<std::string>(&value)) node.kind = TomlNode::text, node.string = *text;
  if (const auto* vector = std::get_if<Vec3>(&value)) {
    node.kind = TomlNode::array;
    for (int i = 0; i < 3; ++i) node.items.push_back(toml_node((*vector)[i]));
  }
  if (const auto* texts = std::get_if<std::vector<std::string>>(&value)) {
    node.kind = TomlNode::array;
    for (const std::string& text : *texts) node.items.push_back(toml_node(text));
  }
  return node;
}

}  // namespace impinge
