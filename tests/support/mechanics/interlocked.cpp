#include "tests/support/mechanics/interlocked.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "engine/core/profile.hpp"
#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/step/step_watcher.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/machine_parts.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {
namespace {

// metres
constexpr double kLinkPlay = 0.002;
constexpr double kPinRadius = 0.01, kPinPlay = 1e-4, kArmLength = 0.2, kArmWidth = 0.04, kArmThickness = 0.02,
                 kArmGap = 5e-4;
constexpr double kRollerPitch = 0.0127, kRollerPin = 0.002, kRollerPlay = 7.5e-5, kRollerWidth = 0.01,
                 kRollerThickness = 0.004, kRollerPlate = 0.0015, kRollerGap = 5e-5;
constexpr int kRollerSides = 32;
constexpr double kStoneThickness = 0.1, kStoneWidth = 0.2, kStoneGap = 5e-4, kSpan = 2.0, kRise = 1.2;

/// Throws std::runtime_error if the mesh bounds no solid.
MeshPointer solid(TriangleMesh mesh) {
  if (const std::optional<std::string> wrong = check_mesh(mesh, make_topology(mesh))) throw std::runtime_error(*wrong);
  return surface(std::move(mesh));
}

/// Through two arms beside each other, a head at either end.
TriangleMesh pin() {
  const double r = kPinRadius, head = 1.5 * kPinRadius, inner = kArmThickness + kArmGap, outer = inner + 0.5 * r;
  return turned(
      {{0, -outer}, {head, -outer}, {head, -inner}, {r, -inner}, {r, inner}, {head, inner}, {head, outer}, {0, outer}},
      64);
}

/// A bar with a hole at either end.
TriangleMesh with_holes(const Bar& bar, double hole, double thickness) {
  const double z = 0.5 * thickness;
  return bar_of_loops(bar, {{hole, -z}, {{}, -z}, {{}, z}, {hole, z}});
}

/// Two plates and the pins between them, one solid.
TriangleMesh with_pins(const Bar& bar, double pin, double inner, double outer) {
  return bar_of_loops(
      bar,
      {{0.0, -outer}, {{}, -outer}, {{}, -inner}, {pin, -inner}, {pin, inner}, {{}, inner}, {{}, outer}, {0.0, outer}});
}

void add_chain(World& world, int links) {
  const MeshPointer mesh = solid(torus(kLinkMajor, kLinkMinor, 24, 12));
  for (int i = 0; i < links; ++i) {
    BodyDescription link = dynamic_body("link " + std::to_string(i), mesh, Vec3::Zero());
    link.position = Vec3(i * (2.0 * (kLinkMajor - kLinkMinor) - kLinkPlay), 0.0, 0.0);
    link.rotation = Vec3(90.0 * (i % 2), 0.0, 0.0);
    link.kind = i == 0 ? BodyKind::fixed : BodyKind::dynamic;
    link.density = i == links - 1 ? 78000.0 : 7800.0;
    world.add_body(link);
  }
}

/// Arms in a row, every second one behind the others, a pin through each joint; the first pin is held.
void add_arms(World& world, int arms) {
  const MeshPointer of_arm = solid(with_holes({kArmLength, kArmWidth}, kPinRadius + kPinPlay, kArmThickness)),
                    of_pin = solid(pin());
  const double depth = 0.5 * (kArmThickness + 0.5 * kArmGap);
  for (int i = 0; i <= arms; ++i) {
    BodyDescription p = dynamic_body("pin " + std::to_string(i), of_pin, Vec3(i * kArmLength, 0.0, 0.0));
    p.kind = i == 0 ? BodyKind::fixed : BodyKind::dynamic;
    world.add_body(p);
    if (i == arms) break;
    world.add_body(dynamic_body("arm " + std::to_string(i), of_arm,
                                Vec3((i + 0.5) * kArmLength, 0.0, i % 2 == 0 ? depth : -depth)));
  }
}

/// A roller chain along x, its pins along z: bars with holes, and between two of them plates whose pins go through; the
/// first bar is held.
void add_rollers(World& world, int links) {
  const Bar bar{kRollerPitch, kRollerWidth, true, kRollerSides};
  const double inner = 0.5 * kRollerThickness + kRollerGap;
  const MeshPointer of_bar = solid(with_holes(bar, kRollerPin + kRollerPlay, kRollerThickness)),
                    of_plates = solid(with_pins(bar, kRollerPin, inner, inner + kRollerPlate));
  for (int i = 0; i < links; ++i) {
    BodyDescription link =
        dynamic_body("link " + std::to_string(i), i % 2 == 0 ? of_bar : of_plates, Vec3(i * kRollerPitch, 0.0, 0.0));
    link.kind = i == 0 ? BodyKind::fixed : BodyKind::dynamic;
    link.density = 7800.0;
    world.add_body(link);
  }
}

void add_bolt(World& world) {
  BodyDescription held = dynamic_body("nut", solid(nut(2)), Vec3::Zero());
  held.kind = BodyKind::fixed;
  held.rotation = Vec3(-90.0, 0.0, 0.0);  // z upwards
  world.add_body(held);
  BodyDescription free = dynamic_body("bolt", solid(bolt(5)), Vec3(0.0, -2.0 * kPitch, 0.0));
  free.rotation = held.rotation;
  free.density = 8050.0;
  world.add_body(free);
}

/// Along a catenary, which carries its own weight without bending; stones stand a gap apart on two that are held.
void add_arch(World& world, int stones) {
  // y = kRise - a (cosh(x / a) - 1), and y(kSpan / 2) = 0
  double low = 0.1, high = 10.0;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (a * (std::cosh(0.5 * kSpan / a) - 1.0) > kRise ? low : high) = a;
  }
  const double a = low, half = a * std::sinh(0.5 * kSpan / a);  // of its length
  const auto at = [&](double s) {
    return Vec3(a * std::asinh(s / a), kRise - a * (std::hypot(1.0, s / a) - 1.0), 0.0);
  };
  const auto across = [&](double s) { return Vec3(s / a, 1.0, 0.0).normalized(); };
  const auto stone = [&](double s0, double s1) {
    TriangleMesh m = box(Vec3::Ones());
    for (Vec3& v : m.vertices) {
      const double s = v.x() < 0.0 ? s0 : s1;
      v = at(s) + 0.5 * kStoneThickness * v.y() * across(s) + Vec3(0.0, 0.0, 0.5 * kStoneWidth * v.z());
    }
    return m;
  };
  const double length = 2.0 * half / stones;
  for (int i = -1; i <= stones; ++i) {
    const double s = -half + i * length;
    BodyDescription d = dynamic_body("stone " + std::to_string(i + 1),
                                     solid(stone(s + 0.5 * kStoneGap, s + length - 0.5 * kStoneGap)), Vec3::Zero());
    d.density = 2400.0;
    if (i < 0 || i == stones) d.kind = BodyKind::fixed;
    world.add_body(d);
  }
}

/// Notes how deep bodies overlap at the end of every sub-step, and how long it took to see that.
class Judge final : public StepWatcher {
 public:
  void finished(const Bodies& bodies, int) override {
    const StageTimer timer(ms);
    const OverlapVerdict verdict = judge_overlap(bodies);
    deepest = std::max(deepest, verdict.deepest);
    by_vertices = std::max(by_vertices, verdict.penetration);
  }
  double deepest = 0.0, by_vertices = 0.0, ms = 0.0;
};

}  // namespace

void assemble(const Assembly& what, World& world) {
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = what.substeps;
  world.parameters.contact.friction = what.name == "arch" ? 0.5 : 0.0;
  world.parameters.contact.restitution = 0.0;
  if (what.name == "chain") return add_chain(world, what.count);
  if (what.name == "arms") return add_arms(world, what.count);
  if (what.name == "rollers") return add_rollers(world, what.count);
  if (what.name == "bolt") return add_bolt(world);
  if (what.name == "arch") return add_arch(world, what.count);
  throw std::runtime_error("no assembly: " + what.name);
}

AssemblyResult run(const Assembly& what, bool every_substep, int second_looks) {
  World world;
  assemble(what, world);
  world.parameters.contact.second_looks = second_looks;
  world.start();
  AssemblyResult result;
  result.thickness = what.name == "chain"     ? 2.0 * kLinkMinor
                     : what.name == "arms"    ? 2.0 * kPinRadius
                     : what.name == "rollers" ? 2.0 * kRollerPin
                     : what.name == "bolt"    ? kThreadDepth
                                              : kStoneThickness;
  const BodyIndex last(world.bodies().size().value() - (what.name == "arch" ? 2 : 1));
  const Vec3 place = world.bodies()[last].pose.position;
  Judge judge;
  if (every_substep) world.watch(&judge);
  double first = 0.0, highest = 0.0;
  std::vector<double> ms;
  const int frames = static_cast<int>(std::lround(what.seconds / 0.01));
  for (int frame = 0; frame < frames; ++frame) {
    judge.ms = 0.0;
    ms.push_back(0.0);
    {
      const StageTimer timer(ms.back());
      world.step();
    }
    ms.back() -= judge.ms;
    if (!every_substep) judge.finished(world.bodies(), 0);
    const FrameStats& stats = world.record().stats;
    const double energy = stats.kinetic + stats.potential;
    if (frame == 0) first = energy, highest = stats.potential;
    result.gain = std::max(result.gain, energy - first);
    result.fall = std::max(result.fall, highest - stats.potential);
    result.unconverged += stats.unconverged;
    result.unsafe += stats.unsafe_motions;
    std::map<std::pair<int, int>, int> of_pair;
    for (const ContactRecord& c : world.record().contacts)
      result.contacts = std::max(result.contacts, ++of_pair[{c.body_a.value(), c.body_b.value()}]);
    result.reach = std::max(result.reach, (world.bodies()[last].pose.position - place).norm());
  }
  result.overlap = judge.deepest, result.by_vertices = judge.by_vertices;
  result.dearest_frame = static_cast<int>(std::max_element(ms.begin(), ms.end()) - ms.begin()) + 1;
  result.dearest_ms = *std::max_element(ms.begin(), ms.end());
  std::nth_element(ms.begin(), ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2), ms.end());
  result.median_ms = ms[ms.size() / 2];
  return result;
}

}  // namespace impinge::test
