#include "viewer/controller/frame_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "engine/core/archive.hpp"
#include "engine/shapes/primitives.hpp"
#include "viewer/draw/body_color.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/layers/view_bodies.hpp"
#include "viewer/layers/view_text.hpp"

namespace impinge {

namespace {

// moving bodies that are drawn, or what there is
Aabb bounds_of(const StepRecord& record, const BodySet& hidden) {
  Aabb moving, all;
  for (const BodyRecord& body : record.bodies) {
    if (body.shape->as<Plane>() != nullptr) continue;
    if (hidden.has(BodyIndex(static_cast<int>(&body - record.bodies.data())))) continue;
    all.include(body.bounds);
    if (body.kind != BodyKind::fixed) moving.include(body.bounds);
  }
  return moving.is_empty() ? all : moving;
}

// of the bodies with such names; planes have no ends
Aabb bounds_of(const StepRecord& record, const std::vector<std::string>& names) {
  Aabb box;
  for (const BodyRecord& body : record.bodies)
    if (!body.deleted && body.shape->as<Plane>() == nullptr &&
        std::find(names.begin(), names.end(), body.name) != names.end())
      box.include(body.bounds);
  return box;
}

std::vector<std::string> all_but(const StepRecord& record, const std::vector<std::string>& names) {
  std::vector<std::string> others;
  for (const BodyRecord& body : record.bodies)
    if (std::find(names.begin(), names.end(), body.name) == names.end()) others.emplace_back(body.name);
  return others;
}

void add(std::vector<std::string>& list, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

// none: all
void take_away(std::vector<std::string>& list, const std::vector<std::string>& names) {
  std::erase_if(list, [&](const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  });
}

bool changes_what_happens(const Command& command) {
  const auto* set = std::get_if<SetCommand>(&command);
  return set != nullptr ? !set->path.starts_with("view.") : std::holds_alternative<Act>(command);
}

/// What tells a caption itself is none.
bool is_about_captions(const Command& command) {
  const auto* set = std::get_if<SetCommand>(&command);
  return set != nullptr && set->path.starts_with("view.caption.");
}

/// Of the last `frames` frames, the latest last; of one parameter (of a ramp, say) only the latest.
std::vector<std::string> caption_lines(const Script& script, int frame, int frames, CaptionLines which) {
  std::vector<std::string> lines, paths;  // the latest first
  if (which == CaptionLines::none) return lines;
  for (int at = frame; at > frame - frames && at >= 0; --at) {
    std::vector<Command> commands = script.commands_at(at);
    std::reverse(commands.begin(), commands.end());
    for (const Command& command : commands) {
      if (is_about_captions(command) || (which == CaptionLines::changes && !changes_what_happens(command))) continue;
      if (const auto* set = std::get_if<SetCommand>(&command)) {
        if (std::find(paths.begin(), paths.end(), set->path) != paths.end()) continue;
        paths.push_back(set->path);
      }
      lines.push_back(format_command(command));
    }
  }
  std::reverse(lines.begin(), lines.end());
  return lines;
}

}  // namespace

FrameView::FrameView() : settings_(make_view_settings()) {}

void FrameView::settle(const StepRecord& record, int width, int height) {
  width_ = width;
  height_ = height;
  check_names(record, settings_);
  settle_camera(settings_, record, static_cast<double>(width) / height);
}

void FrameView::move_camera(const CameraCommand& command, const StepRecord& record) {
  Camera& camera = settings_.camera;
  switch (command.verb) {
    case CameraCommand::eye:
      camera.eye = command.value;
      break;
    case CameraCommand::target:
      camera.target = command.value;
      break;
    case CameraCommand::orbit:
      camera.orbit(command.value.x(), command.value.y());
      break;
    case CameraCommand::pan:
      camera.pan(command.value.x(), command.value.y());
      break;
    case CameraCommand::zoom:
      camera.zoom(command.value.x());
      break;
    case CameraCommand::fov:
      camera.fov_deg = command.value.x();
      break;
    case CameraCommand::fit:
      fit(bounds_of(record, not_drawn(record, settings_)), record);
      break;
  }
  settings_.camera_given = true;
}

void FrameView::fit(const Aabb& box, const StepRecord& record) {
  if (box.is_empty()) return;
  const Vec3 origin = camera_origin(record, settings_);
  Camera& camera = settings_.camera;
  camera.fit(box, static_cast<double>(width_) / height_);
  camera.eye -= origin;
  camera.target -= origin;
  settings_.camera_given = true;
}

void FrameView::show(const BodiesCommand& command, const StepRecord& record) {
  switch (command.verb) {
    case BodiesCommand::hide:
      add(settings_.hidden, command.names);
      break;
    case BodiesCommand::isolate:
      settings_.hidden = all_but(record, command.names);
      break;
    case BodiesCommand::show:
      take_away(settings_.hidden, command.names);
      break;
    case BodiesCommand::lock:
      add(settings_.locked, command.names);
      break;
    case BodiesCommand::unlock:
      take_away(settings_.locked, command.names);
      break;
    case BodiesCommand::color:
      give_color(settings_.colors, command.names, command.rgb);
      break;
    case BodiesCommand::frame:
      fit(bounds_of(record, command.names), record);
      break;
    case BodiesCommand::follow: {
      // what is seen now stays as it is
      const Camera now = camera_in_world(record, settings_);
      settings_.followed = command.names.empty() ? "" : command.names.front();
      const Vec3 origin = camera_origin(record, settings_);
      settings_.camera.eye = now.eye - origin;
      settings_.camera.target = now.target - origin;
      settings_.camera_given = true;
    }
  }
}

void FrameView::write_below(const Script& script, int frame, double frames_per_second) {
  const double frames = std::min(std::ceil(settings_.caption_time * frames_per_second), 1e6);
  settings_.lines_shown = caption_lines(script, frame, static_cast<int>(frames), settings_.caption_lines);
}

void FrameView::open(const std::string& scene_name, bool ids) {
  scene_name_ = scene_name;
  with_ids_ = ids;
  try {
    painter_ = std::make_unique<FramePainter>(width_, height_);
  } catch (const InternalError& error) {
    throw InputError(
        fmt::format("pictures of {}x{}: {}; smaller ones are wanted; change --size", width_, height_, error.what()));
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format(
        "pictures: {}; OpenGL through OSMesa is wanted; install libosmesa6, or add --no-images", error.what()));
  }
}

double FrameView::draw(const StepRecord& record, std::span<const Command> commands,
                       const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  Image image;
  IdImage ids;
  if (with_ids_)
    painter_->paint(record, settings_, image, ids);
  else
    painter_->paint(record, settings_, image);
  const double milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

  std::vector<std::string> lines;
  for (const Command& command : commands) lines.push_back(format_command(command));
  PngText text = {{"impinge:scene", scene_name_},
                  {"impinge:frame", std::to_string(record.stats.frame)},
                  {"impinge:commands", fmt::format("{}", fmt::join(lines, "\n"))},
                  {"impinge:state_hash", hex64(record.stats.state_hash)},
                  {"impinge:renderer", painter_->renderer_name()},
                  {"impinge:view", view_text(settings_)}};
  if (const std::string colors = painter_->colors(); !colors.empty()) text.emplace_back("impinge:colors", colors);
  if (with_ids_) {
    keep_visible_objects(ids);
    if (id_pictures_ == nullptr) id_pictures_ = std::make_unique<PngSequence>(folder / "ids");
    id_pictures_->add(record.stats.frame, id_picture(ids), id_text(ids));
  }
  if (pictures_ == nullptr) pictures_ = std::make_unique<PngSequence>(folder / "frames");
  pictures_->add(record.stats.frame, std::move(image), std::move(text));
  return milliseconds;
}

void FrameView::finish() {
  for (std::unique_ptr<PngSequence>* sequence : {&pictures_, &id_pictures_}) {
    if (*sequence == nullptr) continue;
    (*sequence)->finish();
    sequence->reset();  // a finished sequence takes no more
  }
}

std::string picture_difference(const std::filesystem::path& picture, const std::filesystem::path& baseline,
                               int tolerance) {
  DifferenceSettings settings;
  settings.tolerance = tolerance;
  const Difference difference = compare(read_png(baseline), read_png(picture), settings);
  return difference.same ? "" : difference.reason;
}

}  // namespace impinge
