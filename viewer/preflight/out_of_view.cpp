// Bodies that move and are not in the picture, and do not fly into it by themselves, or are too small to be seen in it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/scripted_body.hpp"
#include "viewer/draw/box_in_picture.hpp"
#include "viewer/preflight/view_warning.hpp"

namespace impinge {
namespace {

constexpr double kLeastPixels = 1.0;
constexpr int kFrames = 240;  // that a run has unless somebody says otherwise

BoxInPicture seen(const Aabb& box, const ViewAtStart& view) {
  return box_in_picture(box, view.settings.camera, view.width, view.height);
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
      const BoxInPicture at_first = seen(box, start);
      BoxInPicture s = at_first;
      Vec3 last = Vec3::Zero();
      for (int frame = 1; frame <= kFrames && !s.is_in; ++frame) {
        const Vec3 way = way_of(body, frame * p.frame_time, p.gravity);
        s = seen({box.min + last.cwiseMin(way), box.max + last.cwiseMax(way)}, start);  // it may fly by within a frame
        last = way;
      }
      const std::string remedy = "leave out view.camera, which then is fitted to the scene, or turn it";
      if (!s.is_in)
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
