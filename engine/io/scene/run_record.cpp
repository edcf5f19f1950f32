#include "engine/io/scene/run_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/core/archive.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

const std::vector<std::string> kRunKeys = {"version", "scene",  "folder",   "script_file",    "script",
                                           "frames",  "images", "ids",      "contacts",       "judge",
                                           "export",  "size",   "surfaces", "judge_substeps", "start"};

std::string table_of(std::string_view path) { return std::string(path.substr(0, path.rfind('.'))); }

// long lists on lines of their own, in tables too: the length of a line is limited
std::string format_lines(const TomlNode& node) {
  if (node.kind == TomlNode::table && !node.entries.empty()) {
    std::vector<std::string> parts;
    for (const TomlEntry& entry : node.entries)
      parts.push_back(fmt::format("{} = {}", entry.key, format_lines(entry.value)));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
  }
  if (node.kind != TomlNode::array || node.items.size() <= 4) return format_toml(node);
  std::string out = "[\n";
  for (const TomlNode& item : node.items) out += fmt::format("  {},\n", format_lines(item));
  return out + "]";
}

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

}  // namespace

RunRecord read_run_record(const TomlNode& table) {
  check_keys(scene_table(table, "run"), "run", kRunKeys);
  const auto need = [&](const char* key) -> const TomlNode& {
    const TomlEntry* entry = table.find(key);
    if (entry == nullptr)
      refuse(table.place, fmt::format("[run] has no {}", key), "run.toml as a run wrote it is wanted",
             "run the scene again");
    return entry->value;
  };
  RunRecord run;
  run.version = scene_text(need("version"), "run.version");
  run.scene = scene_text(need("scene"), "run.scene");
  run.folder = scene_text(need("folder"), "run.folder");
  run.script_file = scene_text(need("script_file"), "run.script_file");
  for (const TomlNode& line : need("script").items) run.script.push_back(scene_text(line, "run.script"));
  if (const TomlEntry* start = table.find("start")) run.start = scene_text(start->value, "run.start");
  run.frames = static_cast<int>(scene_real(need("frames"), "run.frames", {0, 1e9}));
  run.images = scene_flag(need("images"), "run.images");
  if (const TomlEntry* ids = table.find("ids")) run.ids = scene_flag(ids->value, "run.ids");
  run.contacts = scene_flag(need("contacts"), "run.contacts");
  run.judge = scene_flag(need("judge"), "run.judge");
  if (const TomlEntry* substeps = table.find("judge_substeps"))
    run.judge_substeps = scene_flag(substeps->value, "run.judge_substeps");
  run.export_ply = scene_text(need("export"), "run.export") == "ply";
  const TomlNode& size = need("size");
  if (size.items.size() != 2)
    refuse(size.place, "run.size is no pair", "[width, height] is wanted", "run the scene again");
  run.width = static_cast<int>(scene_real(size.items[0], "run.size", {1, 16384}));
  run.height = static_cast<int>(scene_real(size.items[1], "run.size", {1, 16384}));
  return run;
}

void check_surface_hashes(const TomlNode& table, const std::vector<SurfaceFile>& surfaces) {
  const TomlEntry* list = table.find("surfaces");
  if (list == nullptr) return;
  for (const TomlNode& node : list->value.items) {
    const TomlEntry *name = node.find("file"), *hash = node.find("hash");
    if (name == nullptr || hash == nullptr)
      refuse(node.place, "a surface without file or hash", "both are wanted", "run the scene again");
    for (const SurfaceFile& file : surfaces)
      if (file.name == name->value.string && hex64(file.hash) != hash->value.string)
        refuse(hash->value.place, fmt::format("surface {} has changed since the run", toml_string(file.name)),
               "the same bytes are wanted", "restore the file, or run the scene again");
  }
}

std::string format_run(const Scene& scene, const ParameterSet& rows, const RunRecord& run) {
  std::string out = "# the resolved scene of a run: `impinge run` and `impinge replay` take it\n\n[run]\n";
  out += fmt::format("version = {}\nscene = {}\nfolder = {}\nscript_file = {}\n", toml_string(run.version),
                     toml_string(run.scene), toml_string(run.folder), toml_string(run.script_file));
  if (!run.start.empty()) out += fmt::format("start = {}\n", toml_string(run.start));
  out += "script = [\n";
  for (const std::string& line : run.script) out += fmt::format("  {},\n", toml_string(line));
  out += fmt::format(
      "]\nframes = {}\nimages = {}\n{}contacts = {}\njudge = {}\n{}export = \"{}\"\nsize = [{}, {}]\nsurfaces = [\n",
      run.frames, run.images, run.ids ? "ids = true\n" : "", run.contacts, run.judge,
      run.judge_substeps ? "judge_substeps = true\n" : "", run.export_ply ? "ply" : "", run.width, run.height);
  for (const SurfaceFile& file : scene.surfaces)
    out += fmt::format("  {{ file = {}, hash = \"{}\" }},\n", toml_string(file.name), hex64(file.hash));
  out += "]\n";
  if (scene.allow_outside_files) out += "\n[scene]\nallow_outside_files = true\n";

  // TOML opens a table once, so the rows of one stand together
  std::vector<std::pair<std::string, std::string>> tables;
  for (const Parameter& row : rows.all()) {
    if (row.path.rfind("body.", 0) == 0) continue;  // in the bodies below
    const std::string name = table_of(row.path);
    auto table = std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.first == name; });
    if (table == tables.end()) table = tables.insert(tables.end(), {name, ""});
    table->second += fmt::format("{} = {}\n", row.path.substr(name.size() + 1), format_lines(toml_node(row.get())));
  }
  for (const auto& [name, lines] : tables) out += fmt::format("\n[{}]\n{}", name, lines);
  for (const TomlNode& body : scene.bodies) {
    out += "\n[[body]]\n";
    for (const TomlEntry& entry : body.entries) out += fmt::format("{} = {}\n", entry.key, format_lines(entry.value));
  }
  for (const TomlNode& attachment : scene.attachments) {
    out += "\n[[attachment]]\n";
    for (const TomlEntry& entry : attachment.entries)
      out += fmt::format("{} = {}\n", entry.key, format_lines(entry.value));
  }
  return out;
}

std::vector<SettingDifference> setting_differences(const TomlNode& run_a, const TomlNode& run_b) {
  Settings a, b;
  flatten(run_a, "", a);
  flatten(run_b, "", b);
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

}  // namespace impinge
