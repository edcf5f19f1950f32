#include "viewer/shrink/small_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/geometry/rotation.hpp"
#include "engine/io/scene/scene_values.hpp"
#include "viewer/bundle/scene.hpp"
#include "viewer/draw/body_color.hpp"

namespace impinge {

namespace {

const std::string kScript = "script";

std::vector<PlacedText> words_of(const std::string& line) {
  return split_words({std::string_view(line).substr(0, line.find('#')), &kScript, 1, 1});
}

/// Whether it changes a state or what is seen.
bool is_command(const std::string& line) {
  const std::vector<PlacedText> words = words_of(line);
  return !words.empty() && (words[0].text == "at" || words[0].text == "from");
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string text_of(const TomlNode& table, const char* key) {
  const TomlEntry* entry = table.find(key);
  return entry == nullptr ? "" : entry->value.string;
}

void set_key(TomlNode& table, const std::string& key, TomlNode value) {
  if (TomlEntry* entry = table.find(key))
    entry->value = std::move(value);
  else
    table.entries.push_back({key, "", std::move(value)});
}

TomlNode key_frame(double time, const Pose& pose) {
  TomlNode key;
  set_key(key, "time", toml_node(ParameterValue(time)));
  set_key(key, "position", toml_node(ParameterValue(pose.position)));
  set_key(key, "rotation", toml_node(ParameterValue(degrees_from_rotation(pose.rotation))));
  return key;
}

/// From where it is on; what it does later, sooner by `time`.
TomlNode motion_from(const TomlNode& motion, double time, const Pose& pose) {
  TomlNode later = motion;
  later.items = {key_frame(0.0, pose)};
  for (const TomlNode& key : motion.items) {
    const TomlEntry* at = key.find("time");
    if (at == nullptr || at->value.as_number() <= time) continue;
    later.items.push_back(key);
    set_key(later.items.back(), "time", toml_node(ParameterValue(at->value.as_number() - time)));
  }
  return later;
}

/// What takes a body from one place to another, in world coordinates.
Pose motion_between(const Pose& from, const Pose& to) {
  Pose motion;
  motion.rotation = to.rotation * from.rotation.transpose();
  motion.position = to.position - motion.rotation * from.position;
  return motion;
}

/// Its point goes with body_a, along what it slides with body_b; what the world holds stays.
void move_attachment(TomlNode& attachment, const std::map<std::string, Pose>& moved) {
  const auto vector_of = [](const TomlNode& node) {
    return Vec3(node.items[0].as_number(), node.items[1].as_number(), node.items[2].as_number());
  };
  const Pose& a = moved.at(text_of(attachment, "body_a"));
  TomlNode& point = attachment.find("point")->value;
  point = toml_node(ParameterValue(Vec3(a.rotation * vector_of(point) + a.position)));
  const auto b = moved.find(text_of(attachment, "body_b"));
  if (b == moved.end()) return;
  for (const char* key : {"direction", "normal"})
    if (TomlEntry* along = attachment.find(key))
      along->value = toml_node(ParameterValue(Vec3(b->second.rotation * vector_of(along->value))));
}

/// In which it still has something to say.
int last_frame_of(const std::string& line) {
  const std::vector<PlacedText> words = words_of(line);
  return std::stoi(std::string(words[words[0].text == "at" ? 1 : 3].text));
}

/// Whether it adds a body.
bool is_addition(const std::string& line) {
  const std::vector<PlacedText> words = words_of(line);
  return words.size() > 3 && words[0].text == "at" && words[2].text == "add";
}

/// Whether what it does to a body is in the poses and velocities that bodies have after the frame.
bool is_in_motion(const std::string& line, int frame) {
  const std::vector<PlacedText> words = words_of(line);
  return words[0].text == "at" && (words[2].text == "push" || words[2].text == "move") && last_frame_of(line) <= frame;
}

/// A line by frame, so many frames sooner; "" where a ramp is cut in two.
std::string sooner(const std::string& line, int frames) {
  const std::vector<PlacedText> words = words_of(line);
  const auto rest = [&](std::size_t n) {
    return std::string(words[n].text.data(), words.back().text.data() + words.back().text.size());
  };
  const auto frame = [&](std::size_t n) { return std::stoi(std::string(words[n].text)) - frames; };
  if (words[0].text == "at") return fmt::format("at {} {}", std::max(0, frame(1)), rest(2));
  const int first = frame(1), last = frame(3);
  if (first > 0) return fmt::format("from {} to {} {}", first, last, rest(4));
  if (last > 0) return "";
  const std::size_t values = (words.size() - 6) / 2;  // the ramp's end is what is left of it
  return fmt::format("at 0 set {} {}", words[5].text, rest(6 + values));
}

}  // namespace

SmallScene::SmallScene(const Session& session)
    : scene(session.scene()), run(session.run_record()), rows(values_of(session.rows())) {
  std::erase_if(run.script, [](const std::string& line) { return !is_command(line); });
}

std::string SmallScene::run_toml() const {
  RunRecord moved = run;
  moved.folder = std::string(".");
  return format_run(scene, rows, moved);
}

std::vector<std::string> SmallScene::bodies() const {
  std::vector<std::string> names;
  for (const TomlNode& body : scene.bodies) names.push_back(text_of(body, "name"));
  return names;
}

SmallScene SmallScene::with_bodies(const std::vector<std::string>& names) const {
  std::set<std::string> others;
  for (const std::string& name : bodies())
    if (!is_among(names, name)) others.insert(name);
  return without(others);
}

std::vector<std::string> SmallScene::added() const {
  std::vector<std::string> names;
  for (const std::string& line : run.script)
    if (is_addition(line)) names.emplace_back(words_of(line)[3].text);
  return names;
}

std::vector<std::string> SmallScene::additions_at_start() const {
  std::vector<std::string> lines;
  std::copy_if(run.script.begin(), run.script.end(), std::back_inserter(lines),
               [](const std::string& line) { return is_addition(line) && last_frame_of(line) == 0; });
  return lines;
}

SmallScene SmallScene::without(const std::set<std::string>& others) const {
  SmallScene less = *this;
  less.gone.insert(others.begin(), others.end());
  const auto is_gone = [&](const std::string& name) { return less.gone.contains(name); };
  std::erase_if(less.scene.bodies, [&](const TomlNode& body) { return is_gone(text_of(body, "name")); });
  std::erase_if(less.scene.attachments,
                [&](const TomlNode& a) { return is_gone(text_of(a, "body_a")) || is_gone(text_of(a, "body_b")); });
  // a body that a line adds goes with what it is a copy of
  for (std::size_t before = 0; before != less.gone.size();) {
    before = less.gone.size();
    for (const std::string& line : less.run.script)
      if (is_addition(line) && names_one_of(line, less.gone)) less.gone.emplace(words_of(line)[3].text);
  }
  std::erase_if(less.run.script, [&](const std::string& line) { return names_one_of(line, less.gone); });
  // the view may name some
  ParameterSet rows_left;
  for (const Parameter& row : rows.all()) {
    Parameter copy = row;
    ParameterValue value = row.get();
    if (row.path == "view.hidden" || row.path == "view.locked")
      std::erase_if(std::get<std::vector<std::string>>(value), is_gone);
    if (row.path == "record.columns")
      std::erase_if(std::get<std::vector<std::string>>(value),
                    [&](const std::string& column) { return names_one_of(column, less.gone); });
    if (row.path == "view.colors")
      std::erase_if(std::get<std::vector<std::string>>(value),
                    [&](const std::string& entry) { return is_gone(std::string(name_in(entry))); });
    if (row.path == "view.camera.follow" && is_gone(std::get<std::string>(value))) value = std::string();
    copy.get = [value = std::move(value)] { return value; };
    rows_left.add(std::move(copy));
  }
  less.rows = std::move(rows_left);
  return less;
}

SmallScene SmallScene::with_attachments(const std::vector<std::size_t>& places) const {
  SmallScene less = *this;
  less.scene.attachments.clear();
  for (const std::size_t place : places) less.scene.attachments.push_back(scene.attachments[place]);
  return less;
}

SmallScene SmallScene::with_lines(const std::vector<std::string>& lines) const {
  SmallScene less = *this;
  less.run.script = lines;
  return less;
}

std::optional<SmallScene> SmallScene::begun_at(int frame, const StepRecord& record,
                                               const std::vector<Pose>& start) const {
  if (record.bodies.size() > scene.bodies.size()) return std::nullopt;  // it has bodies that the scene only copies
  SmallScene later = *this;
  std::map<std::string, Pose> moved;  // by body, from the start on
  for (std::size_t i = 0; i < record.bodies.size(); ++i) {
    const BodyRecord& body = record.bodies[i];
    TomlNode& table = later.scene.bodies[i];
    if (body.kind == BodyKind::deformable) return std::nullopt;
    moved[std::string(body.name)] = motion_between(start[i], body.file_pose);
    if (body.kind == BodyKind::scripted) {
      TomlNode& motion = table.find("motion")->value;
      motion = motion_from(motion, record.stats.time, body.file_pose);
    }
    if (body.kind != BodyKind::dynamic) continue;
    set_key(table, "position", toml_node(ParameterValue(body.file_pose.position)));
    set_key(table, "rotation", toml_node(ParameterValue(degrees_from_rotation(body.file_pose.rotation))));
    set_key(table, "velocity", toml_node(ParameterValue(body.velocity)));
    set_key(table, "angular_velocity", toml_node(ParameterValue(body.angular_velocity)));
  }
  for (TomlNode& attachment : later.scene.attachments) move_attachment(attachment, moved);
  std::erase_if(later.run.script, [&](const std::string& line) { return is_in_motion(line, frame); });
  for (std::string& line : later.run.script) {
    line = sooner(line, frame);
    if (line.empty()) return std::nullopt;
  }
  return later;
}

std::optional<SmallScene> SmallScene::begun_with(int frame, const std::string& state) const {
  SmallScene later = *this;
  later.run.start = state;
  later.run.script.clear();
  // what the state has of bodies that were added is no more than that
  std::vector<std::string> added;
  std::copy_if(run.script.begin(), run.script.end(), std::back_inserter(added),
               [&](const std::string& line) { return is_addition(line) && last_frame_of(line) <= frame; });
  std::stable_sort(added.begin(), added.end(),
                   [](const std::string& l, const std::string& r) { return last_frame_of(l) < last_frame_of(r); });
  for (const std::string& line : added) later.run.script.push_back(sooner(line, frame));
  for (const std::string& line : run.script) {
    const std::string moved = sooner(line, frame);
    if (moved.empty()) return std::nullopt;
    if (last_frame_of(line) > frame) later.run.script.push_back(moved);  // else the state has it
  }
  return later;
}

SmallScene SmallScene::begun_anew(double time, const StepRecord& record, const std::string& state) const {
  SmallScene later = *this;
  later.run.start = state;
  for (const BodyRecord& body : record.bodies) {
    if (body.kind != BodyKind::scripted) continue;
    for (TomlNode& table : later.scene.bodies) {
      if (text_of(table, "name") != body.name) continue;
      TomlNode& motion = table.find("motion")->value;
      motion = motion_from(motion, time, body.file_pose);
    }
  }
  return later;
}

SmallScene SmallScene::with_surface(const std::string& name, const std::string& other) const {
  SmallScene changed = *this;
  const std::function<void(TomlNode&)> change = [&](TomlNode& node) {
    for (TomlNode& item : node.items) change(item);
    for (TomlEntry& entry : node.entries) {
      if (entry.key == "surface" && entry.value.kind == TomlNode::text && entry.value.string == name)
        entry.value.string = other;
      change(entry.value);
    }
  };
  for (TomlNode& body : changed.scene.bodies) change(body);
  return changed;
}

}  // namespace impinge
