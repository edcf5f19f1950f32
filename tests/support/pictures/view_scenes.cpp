#include "tests/support/pictures/view_scenes.hpp"
#include "tests/support/geometry/indices.hpp"

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>

#include "engine/core/error.hpp"
#include "engine/geometry/tets/tet_cage.hpp"
#include "tests/support/geometry/meshes.hpp"
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
  r.groups = {indices<BodyIndex>({0, ball, crate}), indices<BodyIndex>({stone, wheel})};
  for (std::size_t g = 0; g < r.groups.size(); ++g)
    for (const int body : r.groups[g])
      if (body != 0) r.bodies[static_cast<std::size_t>(body)].group = GroupIndex(g);
  scene->touch(0, ball, {-0.55 + shift, 0.0, 0.45}, -Vec3::UnitY(), ContactState::slip, -0.002).lambda = {0.16, 0.05,
                                                                                                          0.0};
  scene->touch(0, crate, {0.05 + shift, 0.0, 0.3}, -Vec3::UnitY(), ContactState::stick).lambda = {0.08, 0.0, 0.01};
  scene->touch(0, crate, {0.25 + shift, 0.0, 0.55}, -Vec3::UnitY(), ContactState::stick).lambda = {0.09, 0.0, 0.0};
  scene->touch(paddle, ball, {-0.8 + shift, 0.25, 0.45}, -Vec3::UnitX(), ContactState::open, 0.1);
  scene->touch(stone, wheel, {-0.1 + shift, 0.4, -0.35}, -Vec3::UnitX(), ContactState::slip, 0.06).lambda = {0.05, 0.01,
                                                                                                             0.0};
  r.broad_pairs = {body_pair(0, ball, 0.0), body_pair(0, crate, 0.0), body_pair(paddle, ball, 0.0),
                   body_pair(stone, wheel, 0.0)};
  for (int t = 0; t < 40; ++t) r.triangle_pairs.push_back(triangle_pair(stone, wheel, 9 * t, 5 * t, t % 2 == 0));
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

/// A lump in a cage, pressed on a slab by a ball and bulging; its top is held at the back and moved at the front.
std::unique_ptr<HandMadeRecord> make_soft_record() {
  auto scene = std::make_unique<HandMadeRecord>();
  const MeshPointer lump = surface(scaled_to(bumpy_sphere(3), 1.2));
  const TetCage cage = make_tet_cage(lump->mesh, {.cells = 5, .rays_per_cell = 8});
  Embedding embedding = cage.embedding;
  std::vector<int> held;
  for (std::size_t i = 0; i < cage.mesh.vertices.size(); ++i)
    if (cage.mesh.vertices[i].x() < -0.48) held.push_back(static_cast<int>(i));
  const auto pressed = [](const Vec3& p) {
    const double dent = 0.22 * std::exp(-6.0 * ((p.x() - 0.1) * (p.x() - 0.1) + p.z() * p.z())) * (p.y() + 0.6);
    const double wide = 1.0 + 0.14 * std::exp(-8.0 * p.y() * p.y());
    return Vec3(wide * p.x() + 0.15 * p.y() * p.y(), 0.5 + 0.86 * p.y() - dent, wide * p.z());
  };
  scene->add("slab", BodyKind::fixed, Box{{1.5, 0.05, 1.1}}, {0, -0.05, 0});
  const int ball = scene->add("ball", BodyKind::scripted, Sphere{0.2}, {0.15, 0.93, 0.05});
  const int body = scene->add_soft("lump", lump, cage.mesh, embedding, pressed, held);
  DeformableBody& soft = scene->last_soft();
  for (int i = 0; i < soft.nodes(); ++i)
    soft.velocity.segment<3>(3 * i) = Vec3(0.3, -2.0, 0.0) * (soft.position[3 * i + 1] - 0.1);
  for (const int i : held)
    if (soft.position[3 * i + 2] > 0.0) soft.set_held_velocity(i, {-1.2, 0.6, 0.0});
  const MeshPointer box_surface = surface(box({0.15, 0.15, 0.15}, {2, 2, 2}));
  TetMesh block = make_tet_box({0.3, 0.3, 0.3}, 2, 2, 2);
  for (Vec3& v : block.vertices) v -= Vec3::Constant(0.15);
  Embedding in_block = embed(block, box_surface->mesh.vertices);
  in_block.weight[0] = {1.2, -0.1, -0.05, -0.05};
  in_block.outside = 1;
  const int crate = scene->add_soft("block", box_surface, block, in_block, [](const Vec3& p) {
    return Vec3(p.x() + 1.0 + 0.5 * p.y(), 0.9 * p.y() + 0.135, p.z() + 0.55);
  });
  scene->touch(0, body, {0.1, 0.0, 0.2}, -Vec3::UnitY(), ContactState::stick).lambda = {900.0, 20.0, 0.0};
  scene->touch(ball, body, {0.15, 0.73, 0.05}, Vec3::UnitY(), ContactState::slip).lambda = {600.0, 90.0, 0.0};
  StepRecord& r = scene->record();
  r.attachments.push_back(
      {"string", BodyIndex(body), BodyIndex(crate), {0.66, 0.45, 0.15}, {0.95, 0.27, 0.5}, Vec3::Zero()});
  r.groups = {indices<BodyIndex>({ball, body}), indices<BodyIndex>({crate})};
  r.bodies[static_cast<std::size_t>(body)].group = GroupIndex(0);
  r.stats.frame = 12;
  r.stats.time = 0.2;
  r.stats.elastic = 3.25;
  return scene;
}

}  // namespace

const StepRecord& soft_record() {
  static const std::unique_ptr<HandMadeRecord> scene = make_soft_record();
  return scene->record();
}

const StepRecord& sample_record() {
  static const std::unique_ptr<HandMadeRecord> scene = make_record(0.0);
  return scene->record();
}

const StepRecord& other_record() {
  static const std::unique_ptr<HandMadeRecord> scene = make_record(0.12);
  return scene->record();
}

void set(ViewSettings& settings, const std::string& path, const std::string& value) {
  ParameterSet rows;
  settings.bind(rows);
  const Parameter* row = rows.find(path);
  if (row == nullptr) throw InternalError("no row " + path);
  row->set(parse_value(*row, value));
}

ViewSettings settings_with(const std::vector<std::string>& layers) {
  ViewSettings settings = make_view_settings();
  for (LayerSwitch& layer : settings.layers) layer.on = false;
  for (const std::string& name : layers) settings.switch_layer(name, true);
  settings.show_figures = settings.show_legend = false;
  settings.camera.look_at({1.4, 1.7, 3.2}, {0.0, 0.2, 0.0});
  settings.camera.fov_deg = 36.0;
  settings.camera_given = true;
  settings.backdrop = BackdropStyle::flat;
  return settings;
}

std::vector<std::string> all_layers() {
  std::vector<std::string> names;
  for (const Layer& layer : layers()) names.emplace_back(layer.name);
  return names;
}

bool updating() {
  const char* word = std::getenv("IMPINGE_UPDATE_BASELINES");
  return word != nullptr && std::string(word) == "1";
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
