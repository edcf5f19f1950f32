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

using Settings = std::vector<std::pair<std::string, std::string>>;

bool is_named_list(const TomlNode& node) {
  return node.kind == TomlNode::array && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const TomlNode& item) { return item.kind == TomlNode::table && item.find("name") != nullptr; });
}

// every value of a document by its path; bodies by their names
void flatten(const TomlNode& table, const std::string& prefix, Settings& out) {
  for (const TomlEntry& entry : table.entries) {
    const std::string path = prefix + entry.key;
    if (is_named_list(entry.value)) {
      for (const TomlNode& item : entry.value.items)
        flatten(item, path + "." + item.find("name")->value.string + ".", out);
    } else if (path == "run.script") {
      // by what they say, not by their number; what says nothing counts for nothing
      for (const TomlNode& line : entry.value.items)
        if (const std::size_t begin = line.string.find_first_not_of(" \t");
            begin != std::string::npos && line.string[begin] != '#')
          out.emplace_back("script: " + line.string.substr(begin), "there");
    } else if (entry.value.kind == TomlNode::table) {
      flatten(entry.value, path + ".", out);
    } else {
      out.emplace_back(path, format_toml(entry.value));
    }
  }
}

Settings settings_of(const RecordedRun& run) {
  const fs::path file = run.folder() / "run.toml";
  TomlNode root = parse_toml(file.string(), read_file(file, kMostOfTable));
  rename_former_paths(root, run.session().rows());
  Settings settings;
  flatten(root, "", settings);
  return settings;
}

}  // namespace

std::vector<SettingDifference> setting_differences(const RecordedRun& run_a, const RecordedRun& run_b) {
  const Settings a = settings_of(run_a), b = settings_of(run_b);
  const std::map<std::string, std::string> in_a(a.begin(), a.end()), in_b(b.begin(), b.end());
  std::vector<SettingDifference> differences;
  for (const auto& [path, value] : a) {
    const auto it = in_b.find(path);
    if (it == in_b.end())
      differences.push_back({path, value, ""});
    else if (it->second != value)
      differences.push_back({path, value, it->second});
  }
  for (const auto& [path, value] : b)
    if (!in_a.contains(path)) differences.push_back({path, "", value});
  return differences;
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
