// Bodies that move and are not in the picture, and do not fly into it by themselves, or are too small to be seen in it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/scripted_body.hpp"
#include "viewer/preflight/view_warning.hpp"

namespace impinge {
namespace {

constexpr double kLeastPixels = 1.0;
constexpr int kFrames = 240;  // that a run has unless somebody says otherwise

struct Seen {
  bool in_picture = false, is_behind = false;  // behind: the eye, all of it
  double pixels = 0.0;                         // of the box round it, the longer side
};

/// Of a box in the world. Of one that lies across the eye's plane nobody says that it is outside.
Seen seen(const Aabb& box, const ViewAtStart& view) {
  Vec2 low = Vec2::Constant(INFINITY), high = Vec2::Constant(-INFINITY);
  int in_front = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
    const std::optional<Vec3> at = view.settings.camera.project(x, view.width, view.height);
    if (!at) continue;
    ++in_front;
    low = low.cwiseMin(at->head<2>()), high = high.cwiseMax(at->head<2>());
  }
  if (in_front == 0) return {false, true, 0.0};
  if (in_front < 8) return {true, false, static_cast<double>(view.height)};
  const bool meets = high.x() > 0.0 && low.x() < view.width && high.y() > 0.0 && low.y() < view.height;
  return {meets, false, (high - low).maxCoeff()};
}

/// Where a body is after some time if it meets nothing: on its parabola, or where it is driven.
Vec3 way_of(const Body& body, double time, const Vec3& gravity) {
  if (const auto* scripted = body.as<ScriptedBody>(); scripted != nullptr && !scripted->motion.is_empty())
    return scripted->motion.at(time).position - scripted->motion.at(0.0).position;
  if (!body.has_freedom()) return Vec3::Zero();
  return time * body.twist().linear + 0.5 * time * time * gravity;
}

class OutOfView : public ViewWarning {
 public:
  std::vector<Finding> look(const ViewAtStart& start) const override {
    if (!start.camera_given || start.settings.camera_fit == CameraFit::all) return {};
    const Parameters::Simulation& p = start.world.parameters.simulation;
    std::vector<Finding> found;
    for (const Body& body : start.world.bodies()) {
      const Aabb box = body.bounds();
      if (body.absent || body.kind() == BodyKind::fixed || box.is_empty() || !box.extent().allFinite()) continue;
      const Seen at_first = seen(box, start);
      Seen s = at_first;
      Vec3 last = Vec3::Zero();
      for (int frame = 1; frame <= kFrames && !s.in_picture; ++frame) {
        const Vec3 way = way_of(body, frame * p.frame_time, p.gravity);
        s = seen({box.min + last.cwiseMin(way), box.max + last.cwiseMax(way)}, start);  // it may fly by within a frame
        last = way;
      }
      const std::string remedy = "leave out view.camera, which then is fitted to the scene, or turn it";
      if (!s.in_picture)
        found.push_back({fmt::format("'{}' is {} the picture, and nothing brings it there", body.name,
                                     at_first.is_behind ? "behind the camera, out of" : "outside of"),
                         remedy});
      else if (s.pixels < kLeastPixels)
        found.push_back({fmt::format("'{}' covers {:.2g} pixels of the picture", body.name, s.pixels), remedy});
    }
    return found;
  }
};

}  // namespace

Entry<ViewWarning> out_of_view_warning() {
  return entry<ViewWarning, OutOfView>("out-of-view", "a body that moves is not in the picture, nor on its way there");
}

}  // namespace impinge
