#include "engine/io/meshes/mesh_unit.hpp"

#include <utility>

namespace impinge {
namespace {

constexpr std::pair<std::string_view, double> kUnits[] = {
    {"m", 1.0},   {"mm", 1e-3},     {"cm", 1e-2},     {"dm", 0.1},      {"km", 1e3},
    {"um", 1e-6}, {"inch", 0.0254}, {"foot", 0.3048}, {"yard", 0.9144}, {"mile", 1609.344},
};

constexpr double kOddLength = 50.0, kOddShort = 5e-3;  // metres

}  // namespace

std::optional<double> metres_of(std::string_view unit) {
  for (const auto& [name, metres] : kUnits)
    if (name == unit) return metres;
  return std::nullopt;
}

std::string unit_names() {
  std::string names;
  for (const auto& [name, metres] : kUnits) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

std::string unit_question(double longest) {
  if (longest > kOddLength) return "is it in millimetres or centimetres? unit = \"mm\" or \"cm\" then";
  if (longest < kOddShort && longest > 0.0) return "is it in kilometres or inches? unit = \"km\" or \"inch\" then";
  return "";
}

}  // namespace impinge
