#include "viewer/controller/frame_view.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace {

constexpr double kDegree = M_PI / 180.0;

Aabb bounds_of(const World& world) {
  Aabb box;
  for (const RigidBody& body : world.bodies())
    if (!std::holds_alternative<Plane>(body.shape)) box.include(body.bounds());
  return box;
}

}  // namespace

FrameView::FrameView() = default;
FrameView::~FrameView() = default;

void FrameView::bind(ParameterSet& rows) {
  rows.add("view.camera.eye", eye_, {-1e9, 1e9}, "m", "Where the camera is.");
  rows.add("view.camera.target", target_, {-1e9, 1e9}, "m", "What it looks at.");
  rows.add("view.camera.fov", fov_, {1.0, 170.0}, "deg", "Vertical angle of view.");
  Parameter layers;
  layers.path = "view.layers";
  layers.kind = ParameterKind::text_list;
  layers.names = {"meshes", "aabbs", "contacts", "normals", "contact_forces"};
  layers.doc = "Layers that are drawn.";
  layers.initial = layers_;
  layers.get = [this] { return ParameterValue(layers_); };
  layers.set = [this](const ParameterValue& value) { layers_ = std::get<std::vector<std::string>>(value); };
  rows.add(std::move(layers));
}

void FrameView::open(int, int, const std::string&) { throw InputError("this program draws no pictures; add --no-images"); }
double FrameView::draw(const StepRecord&, std::span<const Command>, const std::filesystem::path&) { return 0.0; }
void FrameView::finish() {}

std::string picture_difference(const std::filesystem::path& picture, const std::filesystem::path& baseline, int tolerance) {
  DifferenceSettings settings;
  settings.tolerance = tolerance;
  const Difference difference = compare(read_png(baseline), read_png(picture), settings);
  return difference.same ? "" : difference.reason;
}

void FrameView::move_camera(const CameraCommand& command, const World& world) {
  Vec3 back = eye_ - target_;
  switch (command.verb) {
    case CameraCommand::eye: eye_ = command.value; break;
    case CameraCommand::target: target_ = command.value; break;
    case CameraCommand::fov: fov_ = command.value.x(); break;
    case CameraCommand::zoom: eye_ = target_ + back / command.value.x(); break;
    case CameraCommand::orbit: {
      const double yaw = std::atan2(back.x(), back.z()) + command.value.x() * kDegree, distance = back.norm();
      const double pitch = std::clamp(std::asin(back.y() / distance) + command.value.y() * kDegree, -89.0 * kDegree, 89.0 * kDegree);
      eye_ = target_ + distance * Vec3(std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw));
      break;
    }
    case CameraCommand::pan: {
      const Vec3 right = Vec3::UnitY().cross(back).normalized(), up = back.cross(right).normalized();
      const Vec3 shift = command.value.x() * right + command.value.y() * up;
      eye_ += shift, target_ += shift;
      break;
    }
    case CameraCommand::fit: {
      const Aabb box = bounds_of(world);
      if (box.is_empty()) break;
      const double distance = 0.5 * box.extent().norm() / std::sin(0.5 * fov_ * kDegree);
      target_ = box.center();
      eye_ = target_ + distance * back.normalized();
      break;
    }
  }
}

}  // namespace impinge
