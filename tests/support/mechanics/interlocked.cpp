#include "tests/support/mechanics/interlocked.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <stdexcept>

#include "engine/geometry/surface/mesh_checks.hpp"
#include "engine/step/step_watcher.hpp"
#include "engine/world/judge.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {
namespace {

constexpr double kTwoPi = 2.0 * M_PI;

// metres
constexpr double kLinkPlay = 0.002;
constexpr int kSides = 64;
constexpr double kPinRadius = 0.01, kPinPlay = 1e-4, kArmLength = 0.2, kArmWidth = 0.04, kArmThickness = 0.02,
                 kArmGap = 5e-4;
constexpr double kThreadRadius = 0.02, kThreadDepth = 0.004, kPitch = 0.012, kThreadPlay = 3e-4;
constexpr double kStoneThickness = 0.1, kStoneWidth = 0.2, kStoneGap = 5e-4, kSpan = 2.0, kRise = 1.2;

/// Throws std::runtime_error if the mesh bounds no solid.
MeshPointer solid(TriangleMesh mesh) {
  if (const std::optional<std::string> wrong = check_mesh(mesh, make_topology(mesh))) throw std::runtime_error(*wrong);
  return surface(std::move(mesh));
}

void add_quad(TriangleMesh& m, int a, int b, int c, int d) {
  m.triangles.insert(m.triangles.end(), {{a, b, c}, {a, c, d}});
}

/// A profile (radius, z) turned about z; it begins and ends on the axis and runs upwards.
TriangleMesh turned(const std::vector<std::pair<double, double>>& profile, int sides) {
  TriangleMesh m;
  m.vertices.emplace_back(0.0, 0.0, profile.front().second);
  for (std::size_t k = 1; k + 1 < profile.size(); ++k)
    for (int i = 0; i < sides; ++i) {
      const double u = kTwoPi * i / sides, r = profile[k].first;
      m.vertices.emplace_back(r * std::cos(u), r * std::sin(u), profile[k].second);
    }
  m.vertices.emplace_back(0.0, 0.0, profile.back().second);
  const int rings = static_cast<int>(profile.size()) - 2, last = static_cast<int>(m.vertices.size()) - 1;
  const auto at = [&](int ring, int i) { return 1 + ring * sides + i % sides; };
  for (int i = 0; i < sides; ++i) {
    m.triangles.push_back({0, at(0, i + 1), at(0, i)});
    for (int r = 0; r + 1 < rings; ++r) add_quad(m, at(r, i), at(r, i + 1), at(r + 1, i + 1), at(r + 1, i));
    m.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  return m;
}

/// Through two arms beside each other, a head at either end.
TriangleMesh pin() {
  const double r = kPinRadius, head = 1.5 * kPinRadius, inner = kArmThickness + kArmGap, outer = inner + 0.5 * r;
  return turned(
      {{0, -outer}, {head, -outer}, {head, -inner}, {r, -inner}, {r, inner}, {head, inner}, {head, outer}, {0, outer}},
      kSides);
}

/// A bar along x in the plane z = 0, with a hole at either end: two halves, each a ring from its hole to its outline.
TriangleMesh arm() {
  TriangleMesh m;
  const double c = 0.5 * kArmLength, hole = kPinRadius + kPinPlay, w = 0.5 * kArmWidth, end = c + w;
  for (const double side : {-1.0, 1.0}) {
    const int first = static_cast<int>(m.vertices.size());
    std::vector<char> seam;
    for (int i = 0; i < kSides; ++i) {
      const double u = kTwoPi * i / kSides, x = std::cos(u), y = std::sin(u);
      const double to_y = std::abs(y) > 1e-12 ? w / std::abs(y) : INFINITY;
      const double to_x = x > 1e-12    ? c / x
                          : x < -1e-12 ? (end - c) / -x
                                       : INFINITY;  // the seam is at +c from the hole
      const double t = std::min(to_x, to_y);
      seam.push_back(x > 0.0 && to_x <= to_y ? 1 : 0);
      const double out_x = seam.back() != 0 ? 0.0 : side * (c - t * x);
      for (const double z : {-0.5 * kArmThickness, 0.5 * kArmThickness}) {
        m.vertices.emplace_back(side * (c - hole * x), hole * y, z);
        m.vertices.emplace_back(out_x, t * y, z);
      }
    }
    // of each side: hole below, outline below, hole above, outline above
    const auto at = [&](int i, int k) { return first + 4 * (i % kSides) + k; };
    const auto quad = [&](int p, int q, int r, int s) {
      if (side < 0.0) std::swap(q, s);  // mirrored
      add_quad(m, p, q, r, s);
    };
    for (int i = 0; i < kSides; ++i) {
      quad(at(i, 0), at(i, 1), at(i + 1, 1), at(i + 1, 0));
      quad(at(i, 2), at(i + 1, 2), at(i + 1, 3), at(i, 3));
      quad(at(i, 0), at(i + 1, 0), at(i + 1, 2), at(i, 2));
      if (seam[i] == 0 || seam[(i + 1) % kSides] == 0) quad(at(i, 1), at(i, 3), at(i + 1, 3), at(i + 1, 1));
    }
  }
  return weld(m).mesh;
}

/// Rows that climb with the angle: a surface over (angle, row) that goes on from the end of one turn in the row a pitch
/// above.
class Thread {
 public:
  static constexpr int kRows = 8;  // of a pitch
  explicit Thread(int turns) : rows_((turns + 1) * kRows + 1), turns_(turns) {}

  /// `radius_of` takes the place in the pitch, 0 to 1.
  template <class Radius>
  void add(TriangleMesh& m, bool is_inward, Radius&& radius_of) {
    first_.push_back(static_cast<int>(m.vertices.size()));
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < kSides; ++i) {
        const double u = kTwoPi * i / kSides, r = radius_of(j % kRows / static_cast<double>(kRows));
        m.vertices.emplace_back(r * std::cos(u), r * std::sin(u),
                                kPitch * (static_cast<double>(j) / kRows + u / kTwoPi));
      }
    const int n = static_cast<int>(first_.size()) - 1;
    for (int j = 0; j + 1 < rows_; ++j)
      for (int i = 0; i < kSides; ++i) {
        if (i + 1 == kSides && j + 1 + kRows >= rows_) continue;
        const int a = at(n, i, j), b = at(n, i + 1, j), c = at(n, i + 1, j + 1), d = at(n, i, j + 1);
        if (is_inward)
          add_quad(m, a, d, c, b);
        else
          add_quad(m, a, b, c, d);
      }
  }
  /// The vertices round the lower and the upper end, each beginning and ending with its step down.
  std::vector<int> lower(int n) const {
    std::vector<int> loop;
    for (int i = 0; i < kSides; ++i) loop.push_back(at(n, i, 0));
    for (int j = kRows; j > 0; --j) loop.push_back(at(n, 0, j));
    return loop;
  }
  std::vector<int> upper(int n) const {
    std::vector<int> loop;
    for (int i = 0; i < kSides; ++i) loop.push_back(at(n, i, rows_ - 1));
    for (int j = rows_ - 2; j >= rows_ - 1 - kRows; --j) loop.push_back(at(n, kSides - 1, j));
    return loop;
  }
  double height() const { return kPitch * (static_cast<double>(rows_ - 1) / kRows + 1.0); }

 private:
  int at(int n, int i, int j) const { return first_[n] + (i < kSides ? j : j + kRows) * kSides + i % kSides; }

  int rows_, turns_;
  std::vector<int> first_;
};

double thread_at(double place) { return kThreadDepth * (1.0 - 2.0 * std::abs(place - 0.5)); }

TriangleMesh bolt(int turns) {
  TriangleMesh m;
  Thread thread(turns);
  thread.add(m, false, [](double p) { return kThreadRadius + thread_at(p); });
  m.vertices.emplace_back(0.0, 0.0, 0.5 * kPitch);
  m.vertices.emplace_back(0.0, 0.0, thread.height() - 0.5 * kPitch);
  const int low = static_cast<int>(m.vertices.size()) - 2, high = low + 1;
  const std::vector<int> down = thread.lower(0), up = thread.upper(0);
  for (std::size_t k = 0; k < down.size(); ++k) m.triangles.push_back({low, down[(k + 1) % down.size()], down[k]});
  for (std::size_t k = 0; k < up.size(); ++k) m.triangles.push_back({high, up[k], up[(k + 1) % up.size()]});
  return m;
}

TriangleMesh nut(int turns) {
  TriangleMesh m;
  Thread thread(turns);
  thread.add(m, true, [](double p) { return kThreadRadius + kThreadPlay + thread_at(p); });
  thread.add(m, false, [](double) { return 2.0 * kThreadRadius; });
  const auto close = [&](const std::vector<int>& inner, const std::vector<int>& outer, bool is_lower) {
    for (std::size_t k = 0; k < inner.size(); ++k) {
      const std::size_t l = (k + 1) % inner.size();
      if (is_lower)
        add_quad(m, inner[k], inner[l], outer[l], outer[k]);
      else
        add_quad(m, inner[k], outer[k], outer[l], inner[l]);
    }
  };
  close(thread.lower(0), thread.lower(1), true);
  close(thread.upper(0), thread.upper(1), false);
  return m;
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
  const MeshPointer of_arm = solid(arm()), of_pin = solid(pin());
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

/// Notes how deep bodies overlap at the end of every sub-step.
class Judge final : public StepWatcher {
 public:
  void finished(const Bodies& bodies, int) override { deepest = std::max(deepest, judge_overlap(bodies).penetration); }
  double deepest = 0.0;
};

}  // namespace

void assemble(const Assembly& what, World& world) {
  world.parameters.simulation.frame_time = 0.01;
  world.parameters.simulation.substeps = what.substeps;
  world.parameters.contact.friction = what.name == "arch" ? 0.5 : 0.0;
  world.parameters.contact.restitution = 0.0;
  if (what.name == "chain") return add_chain(world, what.count);
  if (what.name == "arms") return add_arms(world, what.count);
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
  result.thickness = what.name == "chain"  ? 2.0 * kLinkMinor
                     : what.name == "arms" ? 2.0 * kPinRadius
                     : what.name == "bolt" ? kThreadDepth
                                           : kStoneThickness;
  const BodyIndex last(world.bodies().size().value() - (what.name == "arch" ? 2 : 1));
  const Vec3 place = world.bodies()[last].pose.position;
  Judge judge;
  if (every_substep) world.watch(&judge);
  double first = 0.0, highest = 0.0;
  std::vector<double> ms;
  const int frames = static_cast<int>(std::lround(what.seconds / 0.01));
  for (int frame = 0; frame < frames; ++frame) {
    const auto start = std::chrono::steady_clock::now();
    world.step();
    ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
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
  result.overlap = judge.deepest;
  result.dearest_frame = static_cast<int>(std::max_element(ms.begin(), ms.end()) - ms.begin()) + 1;
  result.dearest_ms = *std::max_element(ms.begin(), ms.end());
  std::nth_element(ms.begin(), ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2), ms.end());
  result.median_ms = ms[ms.size() / 2];
  return result;
}

}  // namespace impinge::test
