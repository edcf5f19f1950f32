#include "viewer/controller/frame_view.hpp"

#include "engine/core/archive.hpp"
#include "engine/core/error.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/frame_painter.hpp"
#include "viewer/present/png_sequence.hpp"

namespace impinge {
namespace {

Aabb bounds_of(const World& world) {
  Aabb box;
  for (const RigidBody& body : world.bodies())
    if (!std::holds_alternative<Plane>(body.shape)) box.include(body.bounds());
  return box;
}

}  // namespace

FrameView::FrameView() : settings_(make_view_settings()) {}
FrameView::~FrameView() = default;

void FrameView::bind(ParameterSet& rows) { settings_.bind(rows); }

void FrameView::open(int width, int height, const std::string& scene_name) {
  width_ = width;
  height_ = height;
  scene_name_ = scene_name;
  try {
    painter_ = std::make_unique<FramePainter>(width, height);
  } catch (const InternalError& error) {
    throw InputError(std::string("pictures: ") + error.what() + "; choose a smaller --size");
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("pictures: ") + error.what() + "; install libosmesa6, or add --no-images");
  }
}

double FrameView::draw(const StepRecord& record, std::span<const Command> commands, const std::filesystem::path& path) {
  double milliseconds = 0.0;
  Image image;
  {
    const StageTimer timer(milliseconds);
    if (!settings_.camera_given) settle_camera(settings_, record, static_cast<double>(width_) / height_);
    painter_->paint(record, settings_, image);
  }
  std::string lines;
  for (const Command& command : commands) lines += (lines.empty() ? "" : "\n") + format_command(command);
  if (!sequence_) sequence_ = std::make_unique<PngSequence>(path.parent_path());
  sequence_->add(record.stats.frame, std::move(image),
                 {{"impinge:scene", scene_name_},
                  {"impinge:frame", std::to_string(record.stats.frame)},
                  {"impinge:commands", lines},
                  {"impinge:state_hash", hex64(record.stats.state_hash)},
                  {"impinge:renderer", painter_->renderer_name()}});
  return milliseconds;
}

void FrameView::finish() {
  if (!sequence_) return;
  sequence_->finish();
  sequence_.reset();
}

std::string picture_difference(const std::filesystem::path& picture, const std::filesystem::path& baseline, int tolerance) {
  DifferenceSettings settings;
  settings.tolerance = tolerance;
  const Difference difference = compare(read_png(baseline), read_png(picture), settings);
  return difference.same ? "" : difference.reason;
}

void FrameView::move_camera(const CameraCommand& command, const World& world) {
  // a command that turns or moves what nobody gave starts from the camera that is fitted to the scene
  const double aspect = static_cast<double>(width_) / height_;
  if (!settings_.camera_given) settle_camera(settings_, world.record(), aspect);
  settings_.camera_given = true;
  Camera& camera = settings_.camera;
  switch (command.verb) {
    case CameraCommand::eye: camera.eye = command.value; break;
    case CameraCommand::target: camera.target = command.value; break;
    case CameraCommand::fov: camera.fov_deg = command.value.x(); break;
    case CameraCommand::zoom: camera.zoom(command.value.x()); break;
    case CameraCommand::orbit: camera.orbit(command.value.x(), command.value.y()); break;
    case CameraCommand::pan: camera.pan(command.value.x(), command.value.y()); break;
    case CameraCommand::fit: camera.fit(bounds_of(world), aspect); break;
  }
}

}  // namespace impinge
