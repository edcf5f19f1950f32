#include "tests/support/mechanics/bullets.hpp"
#include "engine/io/meshes/mesh_file.hpp"

#include <algorithm>

#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/geometry/sample_shapes.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {
namespace {

constexpr double kSize = 0.1;  // of movers, metres
constexpr double kPlate = 2e-3, kFoil = 1e-4, kWall = 10e-3, kPost = 10e-3, kRod = 20e-3;

TriangleMesh grid_plate(double side, double thickness, double edge) {
  const int cells = std::max(1, static_cast<int>(std::lround(side / edge)));
  return box(Vec3(0.5 * side, 0.5 * thickness, 0.5 * side), {cells, 1, cells});
}

SharedShape mesh_shape(TriangleMesh mesh) { return SharedShape(surface(std::move(mesh))); }

std::string bunny_file() { return shared_file("hard-cases/meshes/bunny01.off"); }

/// The twelve corners of an icosahedron, not regular: a hull without symmetry.
std::vector<Vec3> hull_points() {
  Random random(7);
  std::vector<Vec3> points;
  for (const Vec3& x : icosphere(0, 0.5 * kSize).vertices)
    points.push_back(x.cwiseProduct(Vec3(1.0, random.in(0.6, 0.9), random.in(0.6, 0.9))));
  return points;
}

SharedShape mover_shape(const std::string& name) {
  if (name == "box") return Box{Vec3::Constant(0.5 * kSize)};
  if (name == "cube") return mesh_shape(box(Vec3::Constant(0.5 * kSize)));
  if (name == "icosphere") return mesh_shape(icosphere(3, 0.5 * kSize));
  if (name == "bunny") return mesh_shape(read_mesh(bunny_file()));
  if (name == "hull") return made_hull(hull_points());
  if (name == "rod_box") return Box{Vec3(0.5, 0.5 * kRod, 0.5 * kRod)};
  if (name == "rod_mesh") return mesh_shape(box(Vec3(0.5, 0.5 * kRod, 0.5 * kRod), {50, 1, 1}));
  throw std::runtime_error("no mover is named " + name);
}

struct Scene {
  double thickness = 0.0;
  double half_side = 0.0;  // of a plate
  bool is_shell = false, is_rod = false;
};

Scene build(const Shot& shot, World& world) {
  Random random(shot.seed);
  Scene scene;
  const double h = 1.0 / 60.0 / shot.substeps;
  world.parameters.simulation.frame_time = h;
  world.parameters.simulation.substeps = 1;
  world.parameters.simulation.gravity.setZero();
  world.parameters.simulation.sleeping = false;
  world.parameters.narrow_phase.continuous = shot.continuous;
  if (!shot.response.empty()) world.parameters.response.method = shot.response;

  BodyDescription target;
  target.name = "target";
  target.kind = BodyKind::fixed;
  BodyDescription mover = dynamic_body("mover", mover_shape(shot.mover), Vec3::Zero());
  scene.is_rod = shot.mover.starts_with("rod");
  if (scene.is_rod) {
    scene.thickness = kPost;
    const double angle = random.in(0.3, 1.3), reach = random.in(0.15, 0.45);
    target.shape = shot.target == "post_mesh" ? mesh_shape(box(Vec3(0.5 * kPost, 0.15, 0.5 * kPost), {1, 10, 1}))
                                              : SharedShape(Box{Vec3(0.5 * kPost, 0.15, 0.5 * kPost)});
    target.position = reach * Vec3(std::cos(angle), 0.0, -std::sin(angle));  // a turn about +y brings x to -z
    target.rotation = Vec3(0.0, random.in(0.0, 90.0), 0.0);
    mover.angular_velocity = Vec3(0.0, shot.speed, 0.0);
  } else if (shot.target == "shell") {
    scene.is_shell = true;
    scene.thickness = kWall;
    TriangleMesh mesh = icosphere(3, 0.2);
    append(mesh, inside_out(icosphere(3, 0.2 - kWall)));
    target.shape = mesh_shape(std::move(mesh));
    target.kind = BodyKind::dynamic;
    mover.velocity = shot.speed * random.direction();
    mover.position = 0.02 * random.vector();
    mover.rotation = 180.0 * random.vector();
  } else {
    const double edge = shot.target == "plate_20" ? 0.02 : shot.target == "plate_1m" ? 1.0 : 0.05;
    const double side = edge == 0.02 ? 0.6 : 1.0;
    scene.thickness = shot.target == "foil" ? kFoil : kPlate;
    scene.half_side = 0.5 * side;
    target.shape = mesh_shape(grid_plate(side, scene.thickness, edge));
    const bool is_moving = shot.target == "moving_plate";
    const double own = is_moving ? 0.5 * shot.speed : shot.speed;
    if (is_moving) target.kind = BodyKind::dynamic, target.velocity = Vec3(0.0, 0.5 * shot.speed, 0.0);
    mover.velocity = Vec3(0.0, -own, 0.0);
    mover.position = Vec3(0.05 * random.sym(), 0.1 + random.u() * shot.speed * h, 0.05 * random.sym());
    mover.rotation = 180.0 * random.vector();
  }
  world.add_body(target);
  world.add_body(mover);
  return scene;
}

}  // namespace

bool can_shoot(const std::string& mover) { return mover != "bunny" || !bunny_file().empty(); }

ShotResult shoot(const Shot& shot) {
  World world;
  const Scene scene = build(shot, world);
  ShotResult result;
  result.thickness = scene.thickness;
  try {
    world.start();
    const double h = world.parameters.simulation.time_step();
    const double kinetic = world.record().stats.kinetic;
    const double flight = scene.is_rod ? 1.3 / shot.speed : scene.is_shell ? 0.2 / shot.speed : 0.1 / shot.speed + h;
    const int frames = std::min(400, static_cast<int>(flight / h) + 6);
    bool has_left = false;  // over an edge of a plate that spins, or unseen: behind it by going round
    for (int i = 0; i < frames; ++i) {
      world.step();
      const FrameStats& s = world.record().stats;
      result.ms += s.times.step_ms / frames;
      result.worst_ms = std::max(result.worst_ms, s.times.step_ms);
      result.unsafe += s.unsafe_motions;
      result.unconverged += s.unconverged;
      result.energy = std::max(result.energy, s.kinetic / kinetic);
      result.has_hit |= std::abs(s.kinetic - kinetic) > 1e-9 * kinetic;
      result.shown = std::max(result.shown, s.max_penetration);
      result.overlap = std::max(result.overlap, judge_overlap(world.bodies()).deepest);
      const Vec3 mover = world.bodies()[1].pose.position, target = world.bodies()[0].pose.position;
      const Vec3 between = world.bodies()[0].pose.rotation.transpose() * (mover - target);
      has_left |= std::max(std::abs(between.x()), std::abs(between.z())) > scene.half_side + kSize;
      if (scene.is_shell)
        result.has_passed |= between.norm() > 0.2;
      else if (!scene.is_rod && !has_left)
        result.has_passed |= between.y() < 0.0 && std::abs(between.x()) < 0.3 && std::abs(between.z()) < 0.3;
      has_left |= h * world.bodies()[0].twist().angular.norm() > 0.5;
    }
    if (scene.is_rod) result.has_passed = !result.has_hit;
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

}  // namespace impinge::test
