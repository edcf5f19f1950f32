#include "engine/io/scene/scene_sizes.hpp"

#include <fmt/format.h>

#include "engine/bodies/body_keys.hpp"
#include "engine/geometry/aabb.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {
namespace {

constexpr double kLeastSize = 1e-6, kMostSize = 1e6;
constexpr const char* kSizes = "[1e-6, 1e6] m";
constexpr const char* kMasses = "[1e-15, 1e15] kg";

bool is_size(double value) { return value >= kLeastSize && value <= kMostSize; }
bool is_mass(double value) {
  const Range range = body_key("mass").range;
  return value >= range.low && value <= range.high;
}

}  // namespace

double scene_size(const TomlNode& node, const std::string& what, double scale) {
  if (!node.is_number()) scene_real(node, what, {});  // which refuses it
  const double value = node.as_number(), size = value * scale;
  if (!is_size(size))
    refuse(node.place,
           fmt::format("{} is {}{}", what, shortest(value),
                       scale == 1.0 ? "" : fmt::format(", {} with the scale {}", shortest(size), shortest(scale))),
           fmt::format("a length greater than 0, in {}, is allowed", kSizes), "change it");
  return size;
}

double scene_mass(const TomlNode& node, const std::string& what) {
  if (!node.is_number()) scene_real(node, what, {});
  const double value = node.as_number();
  if (!is_mass(value))
    refuse(node.place, fmt::format("{} is {}", what, shortest(value)),
           fmt::format("a mass greater than 0, in {}, is allowed", kMasses), "change it");
  return value;
}

void check_extent(const TomlNode& node, const std::string& what, const std::vector<Vec3>& vertices, double scale) {
  Aabb box;
  for (const Vec3& x : vertices) box.include(x);
  const Vec3 extent = box.extent();
  for (int k = 0; k < 3; ++k)
    if (!is_size(extent[k]))
      refuse(node.place,
             fmt::format("{} = {} is {} m long in {}{}", what, format_toml(node), shortest(extent[k]), "xyz"[k],
                         scale == 1.0 ? "" : fmt::format(" with the scale {}", shortest(scale))),
             fmt::format("lengths in {} are allowed", kSizes), "change its scale");
}

void check_mass(const TomlNode& table, const Body& body) {
  if (!body.has_freedom() || is_mass(body.mass)) return;
  const TomlEntry* material = table.find("material");
  const TomlEntry* density = material == nullptr ? nullptr : material->value.find("density");
  const std::string allowed = fmt::format("a mass in {} is allowed", kMasses);
  const std::string found = fmt::format("the mass of body.{} is {} kg by its density", body.name, shortest(body.mass));
  if (density != nullptr) refuse(density->value.place, found, allowed, "change the density or the size");
  refuse(table.place, found, allowed, "change the size, or give it a density or a mass");
}

}  // namespace impinge
