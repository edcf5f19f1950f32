// Every registered broad phase against brute force, and the published pair counts of moving boxes.
#include <catch2/catch.hpp>

#include <limits>

#include "engine/detection/broadphase/broad_phase.hpp"
#include "tests/support/geometry/moving_boxes.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// The answer by definition, written apart from the engine.
std::vector<BoxPair> truth(const std::vector<Aabb>& boxes) {
  std::vector<BoxPair> pairs;
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
    for (int j = i + 1; j < static_cast<int>(boxes.size()); ++j) {
      bool apart = false;
      for (int k = 0; k < 3; ++k)
        apart = apart || boxes[i].min[k] > boxes[j].max[k] || boxes[j].min[k] > boxes[i].max[k];
      if (!apart) pairs.emplace_back(i, j);
    }
  return pairs;
}

Aabb box_at(const Vec3& center, const Vec3& half) { return {center - half, center + half}; }

/// A scene of one of many kinds: crowded, sparse, flat, on a grid (many equal ends), nested, far away, with huge and
/// infinite boxes.
std::vector<Aabb> scene(Random& r, int kind, int count) {
  std::vector<Aabb> boxes;
  const Vec3 away = kind == 5 ? Vec3(1e5, -1e5, 1e5) : Vec3(Vec3::Zero());
  for (int i = 0; i < count; ++i) {
    Vec3 c = std::cbrt(count) * r.vector(), h(r.in(0.1, 0.6), r.in(0.1, 0.6), r.in(0.1, 0.6));
    if (kind == 1) c *= 0.2;
    if (kind == 2) c[r.below(3)] = 0.0;
    if (kind == 3) {
      c = c.array().round();
      h = Vec3::Constant(0.5 * r.below(3));
    }
    if (kind == 4) {
      c *= 0.01 * i / count;
      h = Vec3::Constant(0.1 * (i + 1));
    }
    if (kind == 6 && r.below(10) == 0) h *= 100.0;
    if (kind == 7) c.y() = c.x() = 0.0;
    boxes.push_back(box_at(c + away, h));
    if (kind == 8 && r.below(8) == 0) {
      boxes.back() = {Vec3::Constant(-kInf), Vec3::Constant(kInf)};
      if (r.below(2)) boxes.back().max[r.below(3)] = r.sym();
      if (r.below(4) == 0) boxes.back().min[r.below(3)] = -5.0;
    }
    if (kind == 9 && i > 0 && r.below(2)) boxes.back() = boxes[r.below(i)];
  }
  return boxes;
}
constexpr int kKinds = 10;

}  // namespace

TEST_CASE("broad phases agree with brute force on random scenes", "[methods]") {
  for (const auto& phase : broad_phases()) {
    Random r(21);
    std::vector<BoxPair> pairs;
    for (int k = 0; k < 1000; ++k) {
      const auto boxes = scene(r, k % kKinds, k % 50 == 0 ? 600 : r.below(80));
      const auto broad = phase.make();
      broad->find(boxes, pairs);
      INFO(phase.name << " scene " << k);
      REQUIRE(pairs == truth(boxes));
    }
  }
}

TEST_CASE("broad phases agree with brute force on moving scenes", "[methods]") {
  for (const auto& phase : broad_phases())
    for (int kind = 0; kind < kKinds; ++kind)
      for (double speed : {0.0, 1e-3, 0.05, 2.0}) {
        Random r(31 + kind);
        auto boxes = scene(r, kind, 60);
        std::vector<Vec3> velocity;
        for (std::size_t i = 0; i < boxes.size(); ++i) velocity.push_back(speed * r.vector());
        const auto broad = phase.make();
        std::vector<BoxPair> pairs = {{7, 3}};
        for (int step = 0; step < 200; ++step) {
          broad->find(boxes, pairs);
          INFO(phase.name << " kind " << kind << " speed " << speed << " step " << step);
          REQUIRE(pairs == truth(boxes));
          for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (r.below(20) == 0) velocity[i] = -velocity[i];
            boxes[i].min += velocity[i];
            boxes[i].max += velocity[i];
          }
          if (step % 37 == 36) {  // a few teleport, one changes its size
            for (int n = 0; n < 3; ++n) boxes[r.below(60)] = box_at(4.0 * r.vector(), Vec3::Constant(r.in(0.0, 1.0)));
          }
        }
      }
}

TEST_CASE("touching boxes overlap, also when they come to touch or leave", "[methods]") {
  for (const auto& phase : broad_phases()) {
    const auto broad = phase.make();
    std::vector<BoxPair> pairs;
    const Vec3 half = Vec3::Constant(0.5);
    // box 1 moves by 1/4 from -3 to 3 across box 0, box 2 touches box 0 along an edge throughout
    for (int step = 0; step <= 24; ++step) {
      const double x = -3.0 + 0.25 * step;
      const std::vector<Aabb> boxes = {box_at(Vec3::Zero(), half), box_at({x, 0, 0}, half), box_at({0, 1, 1}, half)};
      broad->find(boxes, pairs);
      INFO(phase.name << " at " << x);
      std::vector<BoxPair> expected;
      if (std::abs(x) <= 1.0) expected.emplace_back(0, 1);
      expected.emplace_back(0, 2);
      if (std::abs(x) <= 1.0) expected.emplace_back(1, 2);
      REQUIRE(pairs == expected);
    }
  }
}

TEST_CASE("broad phases survive all ends inverted, changing counts, empty scenes and empty boxes", "[methods]") {
  for (const auto& phase : broad_phases()) {
    const auto broad = phase.make();
    std::vector<BoxPair> pairs;
    Random r(41);
    INFO(phase.name);
    // [Haapaoja16 fig. 3.2]: quiet frames so that ends are followed, then every coordinate mirrored
    auto boxes = scene(r, 0, 500);
    for (int round = 0; round < 6; ++round) {
      for (int quiet = 0; quiet < 4; ++quiet) {
        broad->find(boxes, pairs);
        REQUIRE(pairs == truth(boxes));
      }
      for (Aabb& b : boxes) b = {-b.max, -b.min};
      broad->find(boxes, pairs);
      REQUIRE(pairs == truth(boxes));
    }
    for (int count : {0, 1, 2, 500, 3, 0, 40, 41, 40}) {
      boxes = scene(r, 0, count);
      broad->find(boxes, pairs);
      REQUIRE(pairs == truth(boxes));
      broad->find(boxes, pairs);
      REQUIRE(pairs == truth(boxes));
    }
    boxes = scene(r, 1, 50);
    boxes[7] = boxes[20] = Aabb{};
    broad->find(boxes, pairs);
    REQUIRE(pairs == truth(boxes));
    boxes[7] = boxes[8];
    boxes[3] = Aabb{};
    broad->find(boxes, pairs);
    REQUIRE(pairs == truth(boxes));
  }
}

TEST_CASE("moving boxes have the published numbers of overlapping pairs") {
  struct Published {
    int boxes, frame;
    double speed;
    std::size_t pairs;
  };
  for (const auto& phase : broad_phases())
    for (const Published& p : {Published{1000, 63, kCoherent, 1494}, Published{1000, 63, kFast, 1453},
                               Published{10000, 23, kCoherent, 15931}, Published{10000, 23, kFast, 15976},
                               Published{100000, 5, kCoherent, 164207}}) {
      if (phase.name == "brute_force" && p.boxes > 1000) continue;  // minutes; it is checked against the others above
      MovingBoxes moving(p.boxes, p.speed);
      const auto broad = phase.make();
      std::vector<BoxPair> pairs;
      for (int frame = 0; frame <= p.frame; ++frame) {
        if (frame > 0) moving.step();
        broad->find(moving.boxes, pairs);
      }
      INFO(phase.name << " " << p.boxes << " boxes, speed " << p.speed);
      CHECK(pairs.size() == p.pairs);
    }
}
