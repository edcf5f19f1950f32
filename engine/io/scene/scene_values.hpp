// Values of a scene's tree as numbers and vectors in their ranges; every refusal is one located message.
#pragma once

#include <initializer_list>
#include <optional>

#include "engine/core/parameter.hpp"
#include "engine/io/scene/toml.hpp"

namespace impinge {

/// Of a place, metres, and of an angle, degrees.
inline constexpr Range kLength{-1e6, 1e6}, kAngle{-1e6, 1e6};

/// Throws InputError `place: found; allowed; remedy`.
[[noreturn]] void refuse(const std::string& place, const std::string& found, const std::string& allowed,
                         const std::string& remedy);

/// `what` names the key in messages, such as "body.crate.mass".
double scene_real(const TomlNode& node, const std::string& what, Range range);
/// The same, or none where it is the word, which is not empty.
std::optional<double> scene_real_or(std::string_view word, const TomlNode& node, const std::string& what, Range range);
/// A real number that must be greater than zero.
double scene_positive(const TomlNode& node, const std::string& what, double high);
Vec3 scene_vector(const TomlNode& node, const std::string& what, Range range);
bool scene_flag(const TomlNode& node, const std::string& what);
const std::string& scene_text(const TomlNode& node, const std::string& what);
/// The node itself if it is a table.
const TomlNode& scene_table(const TomlNode& node, const std::string& what);

/// What somebody writes who knows another program, and what to do instead.
struct OtherKey {
  std::string_view key, remedy;
};
/// Refuses the first key of the table that is not among `allowed`, with the remedy of `others`, or naming the nearest.
void check_keys(const TomlNode& table, const std::string& what, const std::vector<std::string>& allowed,
                std::initializer_list<OtherKey> others = {});

/// The node as a value for a parameter row: checked kind, range and names.
ParameterValue scene_value(const Parameter& row, const TomlNode& node);

/// The value as a node, for writing.
TomlNode toml_node(const ParameterValue& value);

}  // namespace impinge
