#include "viewer/controller/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/archive.hpp"
#include "engine/core/utf8.hpp"
#include "engine/frozen/frozen_step.hpp"
#include "engine/io/paths.hpp"
#include "engine/world/figures.hpp"
#include "viewer/controller/snapshot_file.hpp"
#include "viewer/draw/body_color.hpp"
#include "viewer/preflight/preflight.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr int kDefaultLastFrame = 240;

// for run.toml, which may be read from anywhere
std::string from_anywhere(const fs::path& path) { return absolute_path(path).lexically_normal().string(); }

void put_text(ByteWriter& out, const std::string& text) {
  out.put<std::uint64_t>(text.size());
  for (const char c : text) out.put(c);
}

std::string get_text(ByteReader& in) {
  std::string text;
  for (auto n = in.get<std::uint64_t>(); n > 0; --n) text += in.get<char>();
  return text;
}

void put_value(ByteWriter& out, const ParameterValue& value) {
  struct Writer {
    ByteWriter& out;
    void operator()(bool v) const { out.put(v); }
    void operator()(std::int64_t v) const { out.put(v); }
    void operator()(double v) const { out.put(v); }
    void operator()(const std::string& v) const { put_text(out, v); }
    void operator()(const Vec3& v) const { out.put(v); }
    void operator()(const std::vector<std::string>& v) const {
      out.put<std::uint64_t>(v.size());
      for (const std::string& text : v) put_text(out, text);
    }
  };
  std::visit(Writer{out}, value);
}

// what a snapshot holds of a number that is left open
constexpr double kOpen = -1.0;

ParameterValue written(const Parameter& row) {
  const ParameterValue value = row.get();
  return !row.word.empty() && value == ParameterValue(row.word) ? ParameterValue(kOpen) : value;
}

// of the kind that `like` has
ParameterValue get_value(ByteReader& in, const ParameterValue& like) {
  struct Reader {
    ByteReader& in;
    ParameterValue operator()(bool) const { return in.get<bool>(); }
    ParameterValue operator()(std::int64_t) const { return in.get<std::int64_t>(); }
    ParameterValue operator()(double) const { return in.get<double>(); }
    ParameterValue operator()(const std::string&) const { return get_text(in); }
    ParameterValue operator()(const Vec3&) const { return in.get_vec3(); }
    ParameterValue operator()(const std::vector<std::string>&) const {
      std::vector<std::string> texts;
      for (auto n = in.get<std::uint64_t>(); n > 0; --n) texts.push_back(get_text(in));
      return texts;
    }
  };
  return std::visit(Reader{in}, like);
}

}  // namespace

Session::Session(const fs::path& scene_file, const std::vector<std::string>& overrides, const fs::path& script_file,
                 const SessionOptions& options) {
  // run.toml names them: what it can't hold must not get as far as frame 0
  check_utf8_name(absolute_path(scene_file).string());
  if (!script_file.empty()) check_utf8_name(absolute_path(script_file).string());
  world_.parameters.bind(rows_);
  view_.bind(rows_);
  bind_silence(rows_, silenced_);
  bind_own_columns(rows_, column_texts_);
  scene_ = load_scene(scene_file, overrides, world_, rows_);
  judge_substeps_ = options.judge_substeps || (scene_.run && scene_.run->judge_substeps);
  judge_ = options.judge || judge_substeps_ || (scene_.run && scene_.run->judge);
  script_folder_ = script_file.parent_path();
  if (!script_file.empty()) {
    script_name_ = script_file.string();
    script_lines_ = options.script_lines ? *options.script_lines : read_lines(script_file);
  } else if (scene_.run) {
    script_name_ = scene_.run->script_file;
    script_lines_ = scene_.run->script;
    script_folder_ = fs::path(script_name_).parent_path();
  }
  pictures_may_be_missing_ = options.pictures_may_be_missing;
  added_.read(script_name_, script_lines_, scene_, world_, rows_);
  read_script();
  // what a debugger has recorded, or a run written down, is done again as it was
  if (!script_file.empty() && !options.script_lines) script_.check_bodies_are_there();
  read_columns();
  start();
  try {
    view_.settle(world_.record(), options.width, options.height);
  } catch (const SettingsError& error) {
    throw placed(error);
  }
}

void Session::read_script() {
  script_ = Script(script_name_, script_folder_, script_lines_, rows_, condition_words(), pictures_may_be_missing_);
}

bool Session::list_added(std::vector<Addition> by_hand) {
  if (!added_.list(std::move(by_hand), scene_, world_, rows_)) return false;
  read_script();  // bodies that it speaks of may have changed places
  read_columns();
  return true;
}

std::string Session::place_of_columns() const {
  const auto given = scene_.places.find("record.columns");
  return given == scene_.places.end() ? scene_.path.string() : given->second;
}

/// The table's head is written before the first line of a script counts.
void Session::read_columns() {
  own_columns_ = OwnColumns(column_texts_, condition_words(), place_of_columns());
  for (const Command& command : script_.commands_at(0))
    if (const auto* set = std::get_if<SetCommand>(&command); set != nullptr && set->path == "record.columns")
      throw InputError(
          set->place +
          ": record.columns in a script; the columns of a run are its scene's; write it into the scene, or "
          "--set record.columns=[...]");
}

std::vector<double> Session::own_values(std::span<const double> figures) {
  return own_columns_.values(figures, world_.record(), world_.bodies());
}

void Session::start() {
  try {
    world_.start();
    last_set_.clear();
  } catch (const SettingsError& error) {
    throw placed(error);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", scene_.path.string(), error.what()));
  }
  if (!begins_later()) return;
  try {
    restore_snapshot(scene_.run->start, *this);
  } catch (const InputError& error) {
    const std::string reason = error.what();
    throw InputError(fmt::format(
        "{}: begins with a state that can't be read ({}); one of its bodies and this version, {}, is wanted; "
        "open it with version {}",
        scene_.path.string(), reason.substr(0, reason.find(';')), IMPINGE_VERSION, scene_.run->version));
  }
  frame_ = -1;
  world_.start_restored();
}

InputError Session::placed(const SettingsError& error) const {
  const auto is_of_it = [&](const auto& given) {
    return std::find(error.paths.begin(), error.paths.end(), given.first) != error.paths.end();
  };
  std::string place = scene_.path.string();
  // what came last is what does not go with the rest: a line, else an override, else the first that the file has
  if (const auto line = std::find_if(last_set_.rbegin(), last_set_.rend(), is_of_it); line != last_set_.rend()) {
    place = line->second;
  } else {
    for (auto path = error.paths.rbegin(); path != error.paths.rend(); ++path)
      if (const auto given = scene_.places.find(*path); given != scene_.places.end()) place = given->second;
    for (const auto& given : scene_.places)
      if (is_of_it(given) && given.second.starts_with("--set ")) place = given.second;
  }
  return InputError(fmt::format("{}: {}", place, error.what()));
}

void Session::take_parameters() {
  try {
    world_.parameters_changed();
    last_set_.clear();
  } catch (const SettingsError& error) {
    throw placed(error);
  }
}

std::vector<Command> Session::advance(FrozenStep* frozen) {
  std::vector<Command> commands = script_.commands_at(frame_ + 1);
  for (const Command& command : commands) apply(command);
  if (frame_ < 0) {
    if (!commands.empty()) start();             // the constructor started the world without them
    if (!commands.empty() && begins_later()) {  // whose state has its own parameters
      for (const Command& command : commands) apply(command);
      take_parameters();
      world_.start_restored();
    }
  } else {
    if (!commands.empty() || changed_) take_parameters();
    changed_ = false;
    if (frozen != nullptr) {
      *frozen = world_.step_and_freeze();
      frozen->scene = scene_.path.filename().string();
    } else {
      world_.step();
    }
  }
  ++frame_;
  write_below();
  return commands;
}

void Session::write_below() { view_.write_below(script_, frame_, 1.0 / world_.parameters.simulation.frame_time); }

void Session::change(const Command& command) {
  apply(command);
  changed_ = true;
}

void Session::apply(const Command& command) {
  if (const auto* set = std::get_if<SetCommand>(&command)) {
    rows_.find(set->path)->set(set->value);
    if (!set->place.empty()) last_set_.emplace_back(set->path, set->place);
  } else if (const auto* layer = std::get_if<LayerCommand>(&command)) {
    const Parameter& row = *rows_.find("view.layers");
    auto names = std::get<std::vector<std::string>>(row.get());
    for (const auto& [name, on] : layer->changes) {
      std::erase(names, name);
      if (on) names.push_back(name);
    }
    row.set(names);
  } else if (const auto* camera = std::get_if<CameraCommand>(&command)) {
    view_.move_camera(*camera, world_.record());
  } else if (const auto* act = std::get_if<Act>(&command)) {
    if (act->verb == Act::add) add_body(*act);
    world_.act(*act);
  } else {
    view_.show(std::get<BodiesCommand>(command), world_.record());
  }
}

/// A copy takes what can be set of its pattern as it is now, but for where that is and how it moves.
void Session::add_body(const Act& act) {
  const World& world = world_;
  if (!world.bodies()[world.bodies().find(act.body)].absent) return;
  constexpr std::string_view kState[] = {"position", "rotation", "velocity", "angular_velocity", "fixed_"};
  const std::string like = "body." + act.like + ".";
  for (const Parameter& row : rows_.all()) {
    if (!row.path.starts_with(like) || !row.set || !row.live) continue;
    const std::string_view key = std::string_view(row.path).substr(like.size());
    if (std::any_of(std::begin(kState), std::end(kState), [&](std::string_view k) { return key.starts_with(k); }))
      continue;
    const Parameter& own = *rows_.find(fmt::format("body.{}.{}", act.body, key));
    if (const ParameterValue value = row.get(); own.get() != value) own.set(value);
  }
}

int Session::default_last_frame() const {
  return scene_.run ? scene_.run->frames : std::max(kDefaultLastFrame, script_.last_frame());
}

std::string Session::note_of_former_paths() const {
  std::vector<std::string> used = scene_.former_paths;
  used.insert(used.end(), script_.former_paths().begin(), script_.former_paths().end());
  return rows_.note_of_former(used);
}

RunRecord Session::run_record() const {
  RunRecord run;
  if (scene_.run) run = *scene_.run;
  run.version = IMPINGE_VERSION;
  run.scene = scene_.run ? scene_.run->scene : from_anywhere(scene_.path);
  run.folder = scene_.run ? scene_.run->folder : from_anywhere(scene_.folder);
  run.script_file = script_name_.empty() ? "" : from_anywhere(script_name_);
  run.script = script_lines_;
  run.judge = judge_;
  run.judge_substeps = judge_substeps_;
  return run;
}

fs::path Session::scene_file() const { return scene_.run ? fs::path(scene_.run->scene) : scene_.path; }

ExportJob Session::export_job() const {
  ExportJob job;
  job.name = export_name(scene_file());
  job.frame_time = world_.parameters.simulation.frame_time;
  job.colors = view_.settings().colors;
  if (frame_ >= 0) return job;
  // frame 0 is not made yet, and exports have one colour for all frames
  for (const Command& command : script_.commands_at(0)) {
    if (const auto* bodies = std::get_if<BodiesCommand>(&command);
        bodies != nullptr && bodies->verb == BodiesCommand::color)
      give_color(job.colors, bodies->names, bodies->rgb);
    if (const auto* set = std::get_if<SetCommand>(&command); set != nullptr && set->path == "view.colors")
      job.colors = std::get<std::vector<std::string>>(set->value);
  }
  return job;
}

void Session::save(ByteWriter& out) const {
  out.put(frame_);
  const std::size_t rows = rows_present();
  out.put<std::uint64_t>(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const Parameter& row = rows_.all()[i];
    put_text(out, row.path);
    put_value(out, written(row));
  }
  world_.save(out);
}

void Session::restore(ByteReader& in) {
  const int frame = in.get<int>();
  const auto rows = in.get<std::uint64_t>();
  if (rows > rows_.all().size())
    throw InputError("snapshot: it belongs to another scene or version; remove it and run again");
  for (std::uint64_t i = 0; i < rows; ++i) {
    const Parameter& row = rows_.all()[i];
    if (get_text(in) != row.path)
      throw InputError("snapshot: it belongs to another scene or version; remove it and run again");
    ParameterValue value;
    if (row.word.empty()) {
      value = get_value(in, row.initial);
    } else {
      const double number = in.get<double>();
      value = number == kOpen ? ParameterValue(row.word) : ParameterValue(number);
    }
    if (row.set) row.set(value);  // else it is fixed with the scene
  }
  // after the rows: setting a body's row derives state from it, and the snapshot's bits must stand
  world_.restore(in);
  if (rows != rows_present())
    throw InputError("snapshot: it belongs to another scene or version; remove it and run again");
  frame_ = frame;
  changed_ = false;
  last_set_.clear();
  write_below();
}

void Session::take_over(Session& from) {
  for (const Parameter& row : rows_.all())
    if (const Parameter* given = from.rows_.find(row.path); row.set && given != nullptr) row.set(given->get());
  const std::vector<std::string> names = world_.bodies().names(), theirs = from.bodies().names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto their = std::find(theirs.begin(), theirs.end(), names[i]);
    if (their == theirs.end()) continue;
    ByteWriter state;
    from.bodies()[BodyIndex(their - theirs.begin())].save(state);
    ByteReader in(state.bytes());
    Body& body = world_.bodies()[BodyIndex(i)];
    if (body.absent && !from.bodies()[BodyIndex(their - theirs.begin())].absent) {
      Act act;
      act.verb = Act::add, act.body = names[i];
      world_.act(act);
    }
    body.restore(in);
    body.asleep = false, body.island = {};  // islands are numbered by bodies, and some of those may be gone
    body.update_world_vertices();
  }
  world_.start_restored();
}

}  // namespace impinge
