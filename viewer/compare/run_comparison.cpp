#include "viewer/compare/run_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/former_paths.hpp"
#include "engine/io/scene/toml.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/present/png_sequence.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostOfTable = std::uint64_t{64} << 30;

TomlNode settings_of(const RecordedRun& run) {
  const fs::path file = run.folder() / "run.toml";
  TomlNode root = parse_toml(file.string(), read_file(file, kMostOfTable));
  rename_former_paths(root, run.session().rows());
  return root;
}

}  // namespace

std::vector<SettingDifference> setting_differences(const RecordedRun& a, const RecordedRun& b) {
  return setting_differences(settings_of(a), settings_of(b));
}

std::vector<std::string> bodies_of_one(const StepRecord& a, const StepRecord& b) {
  std::vector<std::string> names;
  const auto add = [&](const StepRecord& from, const StepRecord& other, const char* side) {
    for (const BodyRecord& body : from.bodies)
      if (std::none_of(other.bodies.begin(), other.bodies.end(),
                       [&](const BodyRecord& o) { return o.name == body.name; }))
        names.push_back(fmt::format("{} (only in {})", body.name, side));
  };
  add(a, b, "A");
  add(b, a, "B");
  return names;
}

}  // namespace impinge
