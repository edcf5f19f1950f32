#include "viewer/bundle/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/world/figures.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30;

/// The deepest folder that holds all of them.
fs::path common_folder(const std::vector<fs::path>& files) {
  fs::path common = files.front().parent_path();
  for (const fs::path& file : files)
    while (!common.empty() && common.has_relative_path() && *file.lexically_relative(common).begin() == "..")
      common = common.parent_path();
  return common;
}

/// A bundle has no pictures to compare with.
std::string without_picture(const std::string& line) {
  static const std::string kNone;
  const std::vector<PlacedText> words = split_words({line, &kNone, 1, 1});
  const bool is_picture = words.size() > 1 && words[0].text == "expect" && words[1].text == "image";
  return is_picture ? "# " + line : line;
}

}  // namespace

ParameterSet values_of(const ParameterSet& rows) {
  ParameterSet values;
  for (const Parameter& row : rows.all()) {
    Parameter copy = row;
    copy.get = [value = row.get()] { return value; };
    copy.set = nullptr;
    values.add(std::move(copy));
  }
  return values;
}

std::vector<double> without_times(std::vector<double> row, bool judged) {
  for (const Figure& figure : figures())
    if (figure.kind == FigureKind::time) row[figure_index(figure.name, judged)] = 0.0;
  return row;
}

BundleFiles::BundleFiles(const std::vector<SurfaceFile>& surfaces) {
  for (const SurfaceFile& file : surfaces) names_[file.name] = add(file);
}

std::string BundleFiles::add(const SurfaceFile& file) {
  std::vector<fs::path> paths;
  for (const fs::path& path : file.paths) paths.push_back(absolute_path(path).lexically_normal());
  const auto [place, is_new] = places_.try_emplace(paths.front());
  if (!is_new) return place->second;
  const fs::path from = common_folder(paths);
  // one that stands alone keeps its name; files that name one another keep how they lie to one another
  std::string folder = "meshes";
  if (paths.size() > 1 || parts_.contains(folder + "/" + paths.front().filename().string()))
    folder = fmt::format("meshes/{}", places_.size());
  for (const fs::path& path : paths) {
    const std::string part = folder + "/" + path.lexically_relative(from).generic_string();
    std::string bytes = read_file(path, kLargestFile);
    if (paths.size() == 1 && hash_bytes(bytes) != file.hash)
      throw InputError(path.string() +
                       ": has changed since the scene was read; the same bytes are wanted; restore it, or start again");
    parts_[part] = std::move(bytes);
    if (path == paths.front()) place->second = part;
  }
  return place->second;
}

void BundleFiles::rename(TomlNode& node) const {
  for (TomlNode& item : node.items) rename(item);
  for (TomlEntry& entry : node.entries) {
    const auto name = names_.find(entry.value.string);
    if (entry.value.kind == TomlNode::text && (entry.key == "surface" || entry.key == "volume") && name != names_.end())
      entry.value.string = name->second;
    rename(entry.value);
  }
}

Scene BundleFiles::renamed(Scene scene) const {
  for (TomlNode& body : scene.bodies) rename(body);
  for (SurfaceFile& file : scene.surfaces) file.name = names_.at(file.name);
  scene.allow_outside_files = false;
  return scene;
}

std::map<std::string, std::string> bundled_scene(const Session& session, const ParameterSet& start,
                                                 const std::vector<std::string>& by_hand, int last_frame) {
  const BundleFiles files(session.scene().surfaces);
  std::map<std::string, std::string> parts = files.parts();
  RunRecord run = session.run_record();
  run.scene = fs::path(run.scene).filename().string();
  run.folder = ".";
  if (!run.start.empty()) {
    parts["start.bin"] = read_file(run.start, kLargestFile);
    run.start = std::string("start.bin");
  }
  run.frames = last_frame;
  run.script_file = fs::path(run.script_file).filename().string();
  for (std::string& line : run.script) line = without_picture(line);
  std::erase(run.script, "");
  run.script.insert(run.script.begin(), by_hand.begin(), by_hand.end());
  if (run.script_file.empty() && !run.script.empty()) run.script_file = "recording.script";
  parts["run.toml"] = format_run(files.renamed(session.scene()), start, run);
  return parts;
}

}  // namespace impinge
