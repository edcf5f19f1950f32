#include "viewer/sweep/file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kKeys = {"version", "scene",        "script",  "set",    "vary",   "zip",
                                        "filter",  "reference",    "frames",  "size",   "images", "jobs",
                                        "repeat",  "coarse_first", "columns", "window", "judge"};

const TomlNode* value_of(const TomlNode& table, const char* key) {
  const TomlEntry* entry = table.find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

int whole(const TomlNode& node, const char* what, int low, int high) {
  if (node.kind != TomlNode::integer || node.whole < low || node.whole > high)
    refuse(node.place, fmt::format("sweep.{} is {}", what, format_toml(node)),
           fmt::format("a whole number from {} to {} is wanted", low, high), "change it");
  return static_cast<int>(node.whole);
}

// a text or a list of texts
std::vector<SweepSetting> texts(const TomlNode& node, const char* what) {
  std::vector<SweepSetting> list;
  if (node.kind == TomlNode::text) return {{node.string, node.place}};
  if (node.kind != TomlNode::array)
    refuse(node.place, fmt::format("sweep.{} is {}", what, toml_kind_name(node)), "a text or a list of texts is wanted",
           "change it");
  for (const TomlNode& item : node.items) list.push_back({scene_text(item, fmt::format("sweep.{}", what)), item.place});
  return list;
}

std::string as_value(const TomlNode& node) { return node.kind == TomlNode::text ? node.string : format_toml(node); }

// `simulation.substeps = [1, 2]` and the like, at any depth, as PATH=SPEC
void add_axes(const TomlNode& table, const std::string& prefix, std::vector<SweepSetting>& axes) {
  for (const TomlEntry& entry : table.entries) {
    const std::string path = prefix.empty() ? entry.key : prefix + "." + entry.key;
    const TomlNode& node = entry.value;
    if (node.kind == TomlNode::table) {
      add_axes(node, path, axes);
      continue;
    }
    SweepSetting axis{path + "=", node.place};
    if (node.kind == TomlNode::array) {
      if (node.items.empty())
        refuse(node.place, path + " has no values", "a list of values, or \"lo:hi:n\" or \"log(lo,hi,n)\" is wanted",
               "name some");
      for (const TomlNode& item : node.items)
        axis.text += (axis.values.empty() ? "" : ",") + as_value(item), axis.values.push_back(as_value(item));
    } else {
      axis.text += as_value(node);
    }
    axes.push_back(axis);
  }
}

// "file:line:column" in the order of the file: a table's dotted keys may stand apart
std::pair<long, long> position(const std::string& place) {
  const std::size_t column = place.rfind(':'), line = place.rfind(':', column - 1);
  return {std::strtol(place.c_str() + line + 1, nullptr, 10), std::strtol(place.c_str() + column + 1, nullptr, 10)};
}

// NAME = "EXPR" pairs, or texts NAME=EXPR
std::vector<SweepSetting> columns(const TomlNode& node) {
  if (node.kind != TomlNode::table) return texts(node, "columns");
  std::vector<SweepSetting> list;
  for (const TomlEntry& entry : node.entries) {
    // the place that makes an offset into "NAME=EXPR" one into the file's text
    const std::string& place = entry.value.place;
    const long column = position(place).second - static_cast<long>(entry.key.size()) - 1;
    list.push_back({entry.key + "=" + scene_text(entry.value, "sweep.columns." + entry.key),
                    fmt::format("{}:{}", place.substr(0, place.rfind(':')), column)});
  }
  return list;
}

// as on the command line: alone, or by sub-step
void take_judge(const TomlNode& node, RunOptions& run) {
  if (node.kind != TomlNode::text) {
    run.judge = scene_flag(node, "sweep.judge");
    return;
  }
  if (node.string != "substeps")
    refuse(node.place, fmt::format("sweep.judge is '{}'", node.string), "true, false or \"substeps\" is wanted",
           "change it");
  run.judge = run.judge_substeps = true;
}

std::string quoted(const std::vector<std::string>& list) {
  std::string out = "[";
  for (const std::string& text : list) out += (out.size() > 1 ? ", " : "") + toml_string(text);
  return out + "]";
}

std::vector<std::string> plain(const std::vector<SweepSetting>& settings) {
  std::vector<std::string> list;
  list.reserve(settings.size());
  for (const SweepSetting& setting : settings) list.push_back(setting.text);
  return list;
}

}  // namespace

void read_sweep_file(SweepOptions& sweep, RunOptions& run) {
  const fs::path file = run.scene;
  if (!is_file(file)) return;  // the scene's own loading says so
  const TomlNode root = parse_toml(file.string(), read_file(file, std::uint64_t{1} << 30));
  const TomlEntry* entry = root.find("sweep");
  if (entry == nullptr) return;
  const TomlNode& table = scene_table(entry->value, "sweep");
  check_keys(table, "sweep", kKeys);
  const auto beside = [&](const std::string& name) { return (file.parent_path() / name).lexically_normal(); };
  if (const TomlNode* node = value_of(table, "scene")) {
    for (const TomlEntry& other : root.entries)
      if (other.key != "sweep")
        refuse(other.place, fmt::format("'{}' beside a [sweep] that names its scene", other.key),
               "either the sweep of this scene or a file with [sweep] alone is wanted", "take out one of them");
    run.scene = beside(scene_text(*node, "sweep.scene"));
    if (!is_file(run.scene))
      refuse(node->place, fmt::format("there is no scene {}", run.scene.string()),
             "a scene file, relative to this one, is wanted", "check the path");
  }
  if (const TomlNode* node = value_of(table, "script");
      node != nullptr && run.script.empty() && !scene_text(*node, "sweep.script").empty())
    run.script = beside(node->string);
  if (const TomlNode* node = value_of(table, "set")) {
    const std::vector<SweepSetting> list = texts(*node, "set");
    std::vector<std::string> first = plain(list);
    first.insert(first.end(), run.overrides.begin(), run.overrides.end());  // later ones win
    run.overrides = first;
  }
  if (const TomlNode* node = value_of(table, "vary"); node != nullptr && sweep.vary.empty()) {
    if (node->kind == TomlNode::table) {
      add_axes(*node, "", sweep.vary);
      std::stable_sort(sweep.vary.begin(), sweep.vary.end(), [](const SweepSetting& l, const SweepSetting& r) {
        return position(l.place) < position(r.place);
      });
    } else {
      sweep.vary = texts(*node, "vary");
    }
  }
  if (const TomlNode* node = value_of(table, "zip")) sweep.zip = scene_flag(*node, "sweep.zip") || sweep.zip;
  if (const TomlNode* node = value_of(table, "coarse_first"))
    sweep.coarse_first = scene_flag(*node, "sweep.coarse_first") || sweep.coarse_first;
  if (const TomlNode* node = value_of(table, "filter"); node != nullptr && sweep.filter.text.empty())
    sweep.filter = {scene_text(*node, "sweep.filter"), node->place};
  if (const TomlNode* node = value_of(table, "reference"); node != nullptr && sweep.reference.empty())
    sweep.reference = texts(*node, "reference");
  if (const TomlNode* node = value_of(table, "columns"); node != nullptr && sweep.columns.empty())
    sweep.columns = columns(*node);
  if (const TomlNode* node = value_of(table, "window"); node != nullptr && sweep.window.text.empty())
    sweep.window = {as_value(*node), node->place};
  if (const TomlNode* node = value_of(table, "jobs"); node != nullptr && sweep.jobs == 0)
    sweep.jobs = whole(*node, "jobs", 1, 4096);
  if (const TomlNode* node = value_of(table, "repeat"); node != nullptr && sweep.repeat == 0)
    sweep.repeat = whole(*node, "repeat", 1, 1000);
  if (const TomlNode* node = value_of(table, "frames"); node != nullptr && !run.frames)
    run.frames = whole(*node, "frames", 0, 100'000'000);
  if (const TomlNode* node = value_of(table, "images")) run.images = scene_flag(*node, "sweep.images") && run.images;
  if (const TomlNode* node = value_of(table, "judge"); node != nullptr && !run.judge) take_judge(*node, run);
  if (const TomlNode* node = value_of(table, "size"); node != nullptr && !sweep.size_given) {
    if (node->kind != TomlNode::array || node->items.size() != 2)
      refuse(node->place, fmt::format("sweep.size is {}", format_toml(*node)), "[width, height] is wanted",
             "change it");
    run.width = whole(node->items[0], "size", 16, 8192);
    run.height = whole(node->items[1], "size", 16, 8192);
  }
}

std::string format_sweep_file(const SweepOptions& sweep, const RunOptions& o) {
  std::string out =
      "# a sweep; the same impinge sweep goes on with it, and this file as its scene repeats it\n[sweep]\n";
  out += fmt::format("version = \"{}\"\nscene = {}\nscript = {}\nset = {}\nvary = {}\nzip = {}\n", IMPINGE_VERSION,
                     toml_string(o.scene.string()), toml_string(o.script.string()), quoted(o.overrides),
                     quoted(plain(sweep.vary)), sweep.zip);
  out += fmt::format("filter = {}\nreference = {}\nframes = {}\nsize = [{}, {}]\nimages = {}\n",
                     toml_string(sweep.filter.text), quoted(plain(sweep.reference)), o.frames.value_or(0), o.width,
                     o.height, o.images);
  if (o.judge) out += fmt::format("judge = {}\n", o.judge_substeps ? "\"substeps\"" : "true");
  return out;
}

}  // namespace impinge
