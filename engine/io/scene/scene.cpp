#include "engine/io/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/core/error.hpp"
#include "engine/core/interrupt.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/former_paths.hpp"
#include "engine/io/scene/run_record.hpp"
#include "engine/io/scene/scene_attachments.hpp"
#include "engine/io/scene/scene_body.hpp"
#include "engine/io/scene/scene_copies.hpp"
#include "engine/io/scene/scene_overrides.hpp"
#include "engine/io/scene/scene_sizes.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

bool has_rows_below(const ParameterSet& rows, const std::string& path) {
  const std::string prefix = path + ".";
  return std::any_of(rows.all().begin(), rows.all().end(),
                     [&](const Parameter& row) { return row.path.rfind(prefix, 0) == 0; });
}

[[noreturn]] void refuse_key(const ParameterSet& rows, const TomlEntry& entry, const std::string& path) {
  const bool are_tables = entry.value.kind == TomlNode::array && !entry.value.items.empty() &&
                          entry.value.items.front().kind == TomlNode::table;
  if ((entry.value.kind == TomlNode::table || are_tables) && path.find('.') == std::string::npos) {
    std::vector<std::string> tables = {"body", "attachment", "scene", "sweep"};
    for (const Parameter& row : rows.all()) {
      const std::string table = row.path.substr(0, row.path.find('.'));
      if (std::find(tables.begin(), tables.end(), table) == tables.end()) tables.push_back(table);
    }
    const std::string near = path == "bodies" ? "body" : nearest_word(path, tables);
    refuse(entry.place, fmt::format("unknown table '{}'", path), fmt::format("allowed: {}", fmt::join(tables, ", ")),
           near.empty() ? "remove it" : fmt::format("did you mean '{}'?", near));
  }
  const std::string near = rows.nearest(path);
  refuse(entry.place, fmt::format("unknown key '{}'", path), "`impinge list parameters` shows what there is",
         near.empty() ? "remove it" : fmt::format("did you mean '{}'?", near));
}

// read by other means than rows; [sweep] is `impinge sweep`'s
constexpr std::string_view kOtherTables[] = {"body", "attachment", "run", "scene", "sweep"};

// dotted paths of a table's values; a row takes its value, anything else must be a table that has rows below it
void read_parameters(const TomlNode& table, const std::string& prefix, const ParameterSet& rows, Scene& scene) {
  for (const TomlEntry& entry : table.entries) {
    if (prefix.empty() &&
        std::find(std::begin(kOtherTables), std::end(kOtherTables), entry.key) != std::end(kOtherTables))
      continue;
    const std::string path = prefix.empty() ? entry.key : prefix + "." + entry.key;
    if (const Parameter* row = rows.find(path)) {
      const ParameterValue value = scene_value(*row, entry.value);
      try {
        row->set(value);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", entry.value.place, error.what()));
      }
      scene.given.push_back(path);
      scene.places[path] = entry.value.place;
    } else if (entry.value.kind == TomlNode::table && has_rows_below(rows, path)) {
      read_parameters(entry.value, path, rows, scene);
    } else if (has_rows_below(rows, path)) {
      refuse(entry.value.place, fmt::format("{} is {}", path, toml_kind_name(entry.value)), "a table is wanted",
             "write its keys in a table");
    } else {
      refuse_key(rows, entry, path);
    }
  }
}

void read_bodies(TomlNode& list, Scene& scene, SurfaceFiles& surfaces, World& world) {
  if (list.kind != TomlNode::array)
    refuse(list.place, fmt::format("body is {}", toml_kind_name(list)), "[[body]] tables are wanted", "write [[body]]");
  std::set<std::string> names;
  scene.bodies.reserve(list.items.size());
  for (TomlNode& table : list.items) {
    check_interrupt();
    const BodyDescription body = read_body(table, surfaces);
    if (!names.insert(body.name).second)
      refuse(table.find("name")->value.place, fmt::format("a second body named '{}'", body.name), "names must differ",
             "rename one of them");
    const Body* added = nullptr;
    try {
      added = &world.add_body(body);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: body.{}: {}", table.place, body.name, error.what()));
    }
    check_mass(table, *added);
    scene.bodies.push_back(std::move(table));
  }
}

void read_attachments(TomlNode& list, Scene& scene, World& world) {
  if (list.kind != TomlNode::array)
    refuse(list.place, fmt::format("attachment is {}", toml_kind_name(list)), "[[attachment]] tables are wanted",
           "write [[attachment]]");
  std::set<std::string> names;
  for (TomlNode& table : list.items) {
    const AttachmentDescription attachment =
        read_attachment(table, static_cast<int>(scene.attachments.size()), world.bodies());
    const bool is_named = table.find("name") != nullptr;
    if (names.contains(attachment.name))
      refuse(table.place, fmt::format("a second attachment named '{}'", attachment.name), "names must differ",
             "rename one of them");
    if (is_named) names.insert(attachment.name);
    try {
      world.add_attachment(attachment);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", table.place, error.what()));
    }
    scene.attachments.push_back(std::move(table));
  }
}

}  // namespace

bool Scene::has(std::string_view parameter) const {
  return std::find(given.begin(), given.end(), parameter) != given.end();
}

Scene load_scene(const fs::path& path, const std::vector<std::string>& overrides, World& world, ParameterSet& rows) {
  const std::string name = path.string();
  TomlNode root = parse_toml(name, read_file(path, std::uint64_t{1} << 30));
  Scene scene;
  scene.former_paths = rename_former_paths(root, rows);
  expand_copies(root);
  apply_overrides(root, renamed_overrides(overrides, rows, scene.former_paths));
  scene.path = path;
  scene.folder = path.parent_path();
  if (const TomlEntry* run = root.find("run")) {
    scene.run = read_run_record(run->value);
    for (std::string* place :
         {&scene.run->folder, &scene.run->start})  // a run that names neighbours can be carried about
      if (!place->empty() && fs::path(*place).is_relative())
        *place = absolute_path(path.parent_path() / *place).lexically_normal().string();
    scene.folder = scene.run->folder;
  }
  if (const TomlEntry* sweep = root.find("sweep"); sweep != nullptr && sweep->value.find("scene") != nullptr)
    refuse(sweep->value.find("scene")->place, "a sweep of another scene", "a scene is wanted here",
           "run it by impinge sweep");
  read_parameters(root, "", rows, scene);
  if (const TomlEntry* table = root.find("scene")) {
    check_keys(scene_table(table->value, "scene"), "scene", {"allow_outside_files"});
    if (const TomlEntry* allow = table->value.find("allow_outside_files"))
      scene.allow_outside_files = scene_flag(allow->value, "scene.allow_outside_files");
  }
  scene.files = std::make_shared<SurfaceFiles>(scene.folder, scene.allow_outside_files);
  SurfaceFiles& surfaces = *scene.files;
  if (TomlEntry* bodies = root.find("body")) read_bodies(bodies->value, scene, surfaces, world);
  if (TomlEntry* attachments = root.find("attachment")) read_attachments(attachments->value, scene, world);
  scene.surfaces = surfaces.files();
  if (const TomlEntry* run = root.find("run")) check_surface_hashes(run->value, scene.surfaces);
  world.bind_bodies(rows);
  return scene;
}

}  // namespace impinge
