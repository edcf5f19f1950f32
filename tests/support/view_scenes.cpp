#include "tests/support/view_scenes.hpp"

#include <cmath>
#include <map>
#include <memory>

#include "tests/support/meshes.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/frame_painter.hpp"

namespace impinge::test {
namespace {

std::unique_ptr<HandMadeRecord> make_record(double shift) {
  auto scene = std::make_unique<HandMadeRecord>();
  static const MeshPointer bumpy = surface(scaled_to(bumpy_sphere(3), 0.7)), ring = surface(torus(0.32, 0.12, 24, 12));
  scene->add("slab", BodyKind::fixed, Box{{1.7, 0.05, 1.2}}, {0, -0.05, 0});
  scene->add("wall_back", BodyKind::fixed, Box{{1.5, 0.3, 0.04}}, {0, 0.3, -1.0});
  scene->add("wall_front", BodyKind::fixed, Box{{1.5, 0.3, 0.04}}, {0, 0.3, 1.0});
  const int paddle = scene->add("paddle", BodyKind::scripted, Box{{0.05, 0.25, 0.3}}, {-1.2 + shift, 0.25, 0.3});
  const int ball = scene->add("ball", BodyKind::dynamic, Sphere{0.25}, {-0.55 + shift, 0.25, 0.45});
  const Mat3 turned = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
  const int crate = scene->add("crate", BodyKind::dynamic, Box{{0.25, 0.2, 0.3}}, {0.15 + shift, 0.2, 0.4}, turned);
  scene->add("pill", BodyKind::dynamic, Capsule{0.12, 0.2}, {0.85, 0.32 + shift, 0.45},
             Eigen::AngleAxisd(0.6, Vec3::UnitZ()).toRotationMatrix());
  const int stone = scene->add("stone", BodyKind::dynamic, bumpy, {-0.4 + shift, 0.36, -0.4});
  const int wheel = scene->add("wheel", BodyKind::dynamic, ring, {0.25 + shift, 0.43, -0.4},
                               Eigen::AngleAxisd(1.2, Vec3::UnitX()).toRotationMatrix());
  StepRecord& r = scene->record();
  r.bodies[static_cast<std::size_t>(crate)].asleep = true;
  r.stats.asleep = 1;
  r.bodies[static_cast<std::size_t>(ball)].velocity = {1.5, 0.4, 0.0};
  r.bodies[static_cast<std::size_t>(wheel)].angular_velocity = {0.0, 4.0, 6.0};
  r.groups = {{0, ball, crate}, {stone, wheel}};
  for (std::size_t g = 0; g < r.groups.size(); ++g)
    for (const int body : r.groups[g])
      if (body != 0) r.bodies[static_cast<std::size_t>(body)].group = static_cast<int>(g);
  scene->touch(0, ball, {-0.55 + shift, 0.0, 0.45}, -Vec3::UnitY(), ContactState::slip, -0.002).lambda = {0.16, 0.05,
                                                                                                          0.0};
  scene->touch(0, crate, {0.05 + shift, 0.0, 0.3}, -Vec3::UnitY(), ContactState::stick).lambda = {0.08, 0.0, 0.01};
  scene->touch(0, crate, {0.25 + shift, 0.0, 0.55}, -Vec3::UnitY(), ContactState::stick).lambda = {0.09, 0.0, 0.0};
  scene->touch(paddle, ball, {-0.8 + shift, 0.25, 0.45}, -Vec3::UnitX(), ContactState::open, 0.1);
  scene->touch(stone, wheel, {-0.1 + shift, 0.4, -0.35}, -Vec3::UnitX(), ContactState::slip, 0.06).lambda = {0.05, 0.01,
                                                                                                             0.0};
  r.broad_pairs = {{0, ball}, {0, crate}, {paddle, ball}, {stone, wheel}};
  for (int t = 0; t < 40; ++t) r.triangle_pairs.push_back({stone, wheel, 9 * t, 5 * t, t % 2 == 0});
  r.stats.frame = shift == 0.0 ? 7 : 8;
  r.stats.time = r.stats.frame / 60.0;
  r.stats.broad_pairs = static_cast<std::int64_t>(r.broad_pairs.size());
  r.stats.triangle_pairs = static_cast<std::int64_t>(r.triangle_pairs.size());
  r.stats.groups = 2;
  r.stats.max_penetration = 0.002;
  r.stats.lcp_iterations = 1234;
  r.stats.residual = 3.2e-7;
  return scene;
}

}  // namespace

const StepRecord& sample_record() {
  static const std::unique_ptr<HandMadeRecord> scene = make_record(0.0);
  return scene->record();
}

const StepRecord& other_record() {
  static const std::unique_ptr<HandMadeRecord> scene = make_record(0.12);
  return scene->record();
}

ViewSettings settings_with(const std::vector<std::string>& layers) {
  ViewSettings settings = make_view_settings();
  for (LayerSwitch& layer : settings.layers) layer.on = false;
  for (const std::string& name : layers) settings.switch_layer(name, true);
  settings.show_figures = settings.show_legend = false;
  settings.camera.look_at({1.4, 1.7, 3.2}, {0.0, 0.2, 0.0});
  settings.camera.fov_deg = 36.0;
  settings.camera_given = true;
  settings.backdrop = "flat";
  return settings;
}

Image painted(const StepRecord& record, const ViewSettings& settings, int width, int height) {
  // never destroyed: OSMesa tears itself down at exit before statics of ours would be
  static auto& painters = *new std::map<std::pair<int, int>, std::unique_ptr<FramePainter>>;
  std::unique_ptr<FramePainter>& painter = painters[{width, height}];
  if (!painter) painter = std::make_unique<FramePainter>(width, height);
  Image image;
  painter->paint(record, settings, image);
  return image;
}

}  // namespace impinge::test
