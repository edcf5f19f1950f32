#include "viewer/sweep/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/core/error.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

constexpr double kPerturbation = 1e-9;  // of the scene's size
const std::vector<std::string> kTimeStepPaths = {"simulation.frame_time", "simulation.substeps"};

// the last value that a list of changes gives a path, or what the scene says, or zero
Vec3 vector_at(const std::string& path, const std::vector<std::string>& changes, const TomlNode* given) {
  for (std::size_t i = changes.size(); i-- > 0;)
    if (changes[i].rfind(path + "=", 0) == 0)
      return scene_vector(parse_toml_value(changes[i].substr(path.size() + 1), changes[i]), path, {-1e15, 1e15});
  return given == nullptr ? Vec3(Vec3::Zero()) : scene_vector(*given, path, {-1e15, 1e15});
}

double moving_size(const Session& session) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const Body& body : session.world().bodies()) {
    if (!body.has_freedom()) continue;
    low = low.cwiseMin(body.bounds().min);
    high = high.cwiseMax(body.bounds().max);
  }
  return low.x() > high.x() ? 0.0 : (high - low).norm();
}

}  // namespace

std::vector<std::string> with_settings(std::vector<std::string> changes, const std::vector<std::string>& settings) {
  for (const std::string& text : settings) {
    const std::string path = text.substr(0, text.find('=') + 1);
    std::erase_if(changes, [&](const std::string& change) { return change.rfind(path, 0) == 0; });
    changes.push_back(text);
  }
  return changes;
}

bool chooses_method(const Parameter& row) {
  for (const char* table : {"response.", "lcp.", "broad_phase.", "narrow_phase."})
    if (row.path.rfind(table, 0) == 0) return true;
  return row.kind == ParameterKind::choice &&
         (row.path.rfind("simulation.", 0) == 0 || row.path.rfind("contact.", 0) == 0);
}

std::vector<std::string> scene_methods(const std::vector<SweepAxis>& axes, const std::vector<std::string>& settings,
                                       const Session& session) {
  std::vector<std::string> methods;
  for (const SweepAxis& axis : axes) {
    const Parameter* row = session.rows().find(axis.path);
    if (row == nullptr || !chooses_method(*row)) continue;
    const bool is_named = std::any_of(settings.begin(), settings.end(), [&](const std::string& setting) {
      return setting.rfind(axis.path + "=", 0) == 0;
    });
    if (!is_named) methods.push_back(axis.path + "=" + format_value(row->get()));
  }
  return methods;
}

bool is_time_step_path(const std::string& path) { return path == kTimeStepPaths[0] || path == kTimeStepPaths[1]; }

std::vector<std::size_t> finest_rows(const std::string& place, const std::vector<SweepAxis>& axes,
                                     const std::vector<SweepRow>& rows, bool zip, const Session& session) {
  const auto& simulation = session.world().parameters.simulation;
  bool is_varied = false;
  for (const SweepAxis& axis : axes) is_varied |= is_time_step_path(axis.path);
  if (!is_varied)
    refuse(place, "no time step is varied",
           fmt::format("'finest' is the job with the smallest {} / {}", kTimeStepPaths[0], kTimeStepPaths[1]),
           "vary one of them, or write --reference PATH=VALUE");
  std::vector<double> steps;
  std::map<std::string, std::size_t> finest;  // by what the time step leaves alone
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double frame_time = simulation.frame_time, substeps = simulation.substeps;
    std::string key;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string& value = rows[i].values[k];
      if (axes[k].path == kTimeStepPaths[0])
        frame_time = std::strtod(value.c_str(), nullptr);
      else if (axes[k].path == kTimeStepPaths[1])
        substeps = std::strtod(value.c_str(), nullptr);
      else if (!zip || !is_numeric(axes[k]))
        key += value + '\n';
    }
    steps.push_back(frame_time / substeps);
    keys.push_back(key);
    const auto [it, is_new] = finest.emplace(key, i);
    if (!is_new && steps[i] < steps[it->second]) it->second = i;
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t best = finest.at(keys[i]);
    if (i != best && steps[i] <= steps[best] * (1.0 + 1e-12))
      refuse(place,
             fmt::format("two jobs share the smallest time step, {:.6g} s ({} and {})", steps[best],
                         fmt::join(rows[best].values, ", "), fmt::join(rows[i].values, ", ")),
             "one finest job is wanted", "change the values, or write --reference PATH=VALUE");
    result.push_back(best);
  }
  return result;
}

std::vector<std::string> perturbed_settings(const std::vector<std::string>& changes, const Session& session) {
  std::vector<const TomlNode*> moving;
  for (const TomlNode& body : session.scene().bodies) {
    const TomlEntry* kind = body.find("kind");
    if (kind != nullptr && body.find("name") != nullptr &&
        (kind->value.string == "dynamic" || kind->value.string == "deformable"))
      moving.push_back(&body);
  }
  const double size = moving_size(session);
  std::vector<std::string> settings;
  for (std::size_t k = 0; k < moving.size(); ++k) {
    // directions evenly over the sphere, along a spiral by the golden angle
    const double z = 1.0 - 2.0 * (static_cast<double>(k) + 0.5) / static_cast<double>(moving.size());
    const double angle = (static_cast<double>(k) + 0.5) * std::numbers::pi * (3.0 - std::sqrt(5.0)),
                 radius = std::sqrt(1.0 - z * z);
    const Vec3 direction(radius * std::cos(angle), radius * std::sin(angle), z);
    const TomlNode& body = *moving[k];
    const char* key = body.find("fixed") != nullptr ? "velocity" : "position";
    const std::string path = fmt::format("body.{}.{}", body.find("name")->value.string, key);
    const TomlEntry* given = body.find(key);
    const Vec3 value =
        vector_at(path, changes, given == nullptr ? nullptr : &given->value) + kPerturbation * size * direction;
    settings.push_back(
        fmt::format("{}=[{}, {}, {}]", path, shortest(value.x()), shortest(value.y()), shortest(value.z())));
  }
  return with_settings(changes, settings);
}

}  // namespace impinge
