// Broad phases on moving boxes, FCL's dynamic AABB tree beside them when it is installed.
#include <fmt/format.h>
#include <ctime>

#include <algorithm>
#include <map>
#include <string>

#include "engine/detection/broadphase/broad_phase.hpp"
#include "tests/support/geometry/moving_boxes.hpp"
#include "tests/support/median.hpp"
#include "tests/support/program/bench_arguments.hpp"

#ifdef IMPINGE_HAS_FCL
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#endif

using namespace impinge;
using namespace impinge::test;

namespace {

/// Processor time: the machine may be shared.
double milliseconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Result {
  double first_ms, frame_ms;
  std::size_t pairs;
};

int frames_for(int count) { return count <= 1000 ? 64 : count <= 10000 ? 24 : 12; }

Result run(BroadPhase& broad, int count, double speed) {
  MovingBoxes moving(count, speed);
  std::vector<BoxPair> pairs;
  double start = milliseconds();
  broad.find(moving.boxes, pairs);
  Result result{milliseconds() - start, 0.0, 0};
  std::vector<double> times;
  for (int frame = 1; frame < frames_for(count); ++frame) {
    moving.step();
    start = milliseconds();
    broad.find(moving.boxes, pairs);
    times.push_back(milliseconds() - start);
  }
  result.frame_ms = median(times);
  result.pairs = pairs.size();
  return result;
}

#ifdef IMPINGE_HAS_FCL
/// The tree as its users drive it: objects of its own box shapes, moved, updated, all pairs listed.
Result run_fcl(int count, double speed) {
  MovingBoxes moving(count, speed);
  std::vector<fcl::CollisionObjectd> objects;
  objects.reserve(static_cast<std::size_t>(count));
  const auto place = [&](int i) {
    objects[i].setTranslation(moving.center[i]);
    objects[i].computeAABB();
  };
  std::vector<fcl::CollisionObjectd*> pointers;
  for (int i = 0; i < count; ++i) {
    objects.emplace_back(std::make_shared<fcl::Boxd>(2.0 * moving.half[i]));
    place(i);
  }
  for (auto& object : objects) pointers.push_back(&object);
  struct Found {
    const fcl::CollisionObjectd* base;
    std::vector<BoxPair> pairs;
  } found{objects.data(), {}};
  const auto callback = [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    Found& f = *static_cast<Found*>(data);
    const int i = static_cast<int>(a - f.base), j = static_cast<int>(b - f.base);
    if (a->getAABB().overlap(b->getAABB())) f.pairs.emplace_back(std::min(i, j), std::max(i, j));
    return false;
  };
  fcl::DynamicAABBTreeCollisionManagerd tree;
  double start = milliseconds();
  tree.registerObjects(pointers);
  tree.setup();
  tree.collide(&found, callback);
  Result result{milliseconds() - start, 0.0, 0};
  std::vector<double> times;
  for (int frame = 1; frame < frames_for(count); ++frame) {
    moving.step();
    start = milliseconds();
    for (int i = 0; i < count; ++i) place(i);
    tree.update();
    found.pairs.clear();
    tree.collide(&found, callback);
    times.push_back(milliseconds() - start);
  }
  result.frame_ms = median(times);
  result.pairs = found.pairs.size();
  return result;
}
#endif

/// Slope of log(time) over log(n) by least squares.
double exponent(const std::vector<std::pair<int, double>>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(points.size());
  for (const auto& [count, time] : points) {
    const double x = std::log(count), y = std::log(time);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

int main(int argc, char** argv) {
  int largest = 100000;
  BenchArguments arguments(
      "bench_broad_phase",
      "Broad phases on moving boxes: milliseconds a frame (boxes in, sorted pairs out), growth with n, and\n"
      "FCL's dynamic AABB tree in the same process when it is installed.");
  arguments.number("largest", largest, {100}, "boxes at most: 100, 1000 and so on");
  arguments.read_or_exit(argc, argv);
  fmt::print("{:<18}{:>8}  {:<9}{:>12}{:>12}{:>10}{:>12}\n", "broad phase", "boxes", "motion", "first ms", "frame ms",
             "pairs", "against FCL");
  for (double speed : {kCoherent, kFast}) {
    const char* motion = speed == kCoherent ? "coherent" : "fast";
    std::map<int, Result> peer;
#ifdef IMPINGE_HAS_FCL
    for (int count = 100; count <= largest; count *= 10) {
      peer[count] = run_fcl(count, speed);
      fmt::print("{:<18}{:>8}  {:<9}{:>12.4g}{:>12.4g}{:>10}\n", "FCL AABB tree", count, motion, peer[count].first_ms,
                 peer[count].frame_ms, peer[count].pairs);
    }
#endif
    for (const auto& entry : broad_phases()) {
      std::vector<std::pair<int, double>> points;
      for (int count = 100; count <= largest; count *= 10) {
        if (entry.name == "brute_force" && count > 10000) continue;
        const auto broad = entry.make();
        const Result result = run(*broad, count, speed);
        points.emplace_back(count, result.frame_ms);
        fmt::print("{:<18}{:>8}  {:<9}{:>12.4g}{:>12.4g}{:>10}", entry.name, count, motion, result.first_ms,
                   result.frame_ms, result.pairs);
        if (peer.contains(count)) {
          fmt::print("{:>11.2f}x", peer[count].frame_ms / result.frame_ms);
          if (peer[count].pairs != result.pairs) fmt::print("  PAIRS DIFFER");
        }
        fmt::print("\n");
      }
      if (points.size() > 1)
        fmt::print("{:<18}{:>8}  {:<9} grows like n^{:.2f}\n", entry.name, "", motion, exponent(points));
    }
  }
  return 0;
}
