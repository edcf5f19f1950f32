// Narrow phases between meshes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>

#include "engine/core/parallel.hpp"
#include "tests/support/geometry/meshes.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

double process_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Result {
  double ms = 0.0;
  std::size_t pairs = 0;
};

constexpr const char* kReference = "brute_force";

// those that differ in how they search: `continuous` searches as bvh does
std::vector<std::string> methods() {
  std::vector<std::string> names;
  for (const Entry<NarrowPhase>& entry : narrow_phases())
    if (entry.name != "continuous") names.emplace_back(entry.name);
  return names;
}

// Repeats until half a second is spent, three times at least (once if a single call takes more than two seconds);
// trees and fields that are made once are not in it
Result measure(const std::string& name, const ColliderSet& set, const std::vector<BodyPair>& pairs) {
  const std::unique_ptr<NarrowPhase> phase = find_entry(narrow_phases(), name)->make();
  std::vector<TrianglePair> found;
  double start = process_ms();
  phase->find(set.all(), pairs, found);
  std::vector<double> times{process_ms() - start};
  if (times[0] < 2000.0) {
    times.clear();
    double spent = 0.0;
    while (times.size() < 3 || (spent < 500.0 && times.size() < 25)) {
      start = process_ms();
      phase->find(set.all(), pairs, found);
      times.push_back(process_ms() - start);
      spent += times.back();
    }
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  }
  return {times[times.size() / 2], found.size()};
}

std::vector<Result> measure_all(const std::vector<std::string>& names, const ColliderSet& set,
                                const std::vector<BodyPair>& pairs) {
  std::vector<Result> all;
  for (const std::string& name : names) all.push_back(measure(name, set, pairs));
  return all;
}

void row(const std::string& series, std::size_t triangles, const std::vector<Result>& results) {
  fmt::print("{},{},{}", series, triangles, results.front().pairs);
  for (const Result& r : results) fmt::print(",{}", r.ms > 0.0 ? fmt::format("{:.4f}", r.ms) : "");
  fmt::print("\n");
}

std::string cells(const std::vector<Result>& results) {
  std::string text;
  for (const Result& r : results) text += r.ms > 0.0 ? fmt::format(" {:>11.3f} ms", r.ms) : fmt::format(" {:>14}", "");
  for (const Result& r : results)
    if (r.ms > 0.0 && r.pairs != results.front().pairs) text += "  DIFFERENT PAIRS";
  return text;
}

std::string head(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += fmt::format(" {:>14}", name);
  return text;
}

// least squares slope of log(ms) over log(n)
double exponent(const std::vector<std::pair<double, double>>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [n, ms] : points) {
    const double x = std::log(n), y = std::log(ms);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double count = static_cast<double>(points.size());
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

// the seed's Fig. 6.4: 2,560 triangles, collisions from some ten to 5,000 and more. Two round spheres of 1,280
// triangles reach a few hundred; eight of 320 that are drawn together reach the rest
Plot figure_6_4() {
  const std::vector<std::string> names = methods();
  fmt::print(stderr, "\nFig. 6.4 of the seed: 2,560 triangles, more and more of them intersecting\n{:>10} {:>12}{}\n",
             "bodies", "collisions", head(names));
  Plot plot{"Narrow phase: 2,560 triangles, more and more of them in collision",
            "intersecting pairs of triangles",
            "time, ms",
            {}};
  for (const std::string& name : names) plot.series.push_back({name, {}});
  const auto show = [&](const ColliderSet& set) {
    std::vector<BodyPair> pairs;
    const int bodies = static_cast<int>(set.all().size());
    for (int i = 0; i < bodies; ++i)
      for (int j = i + 1; j < bodies; ++j)
        if (overlap(set.all()[static_cast<std::size_t>(i)].bounds, set.all()[static_cast<std::size_t>(j)].bounds))
          pairs.push_back({BodyIndex(i), BodyIndex(j), 0.0});  // as a broad phase hands them on
    const std::vector<Result> results = measure_all(names, set, pairs);
    row(fmt::format("fig64_{}_bodies", bodies), 2560, results);
    fmt::print(stderr, "{:>10} {:>12}{}\n", bodies, results.front().pairs, cells(results));
    for (std::size_t i = 0; i < names.size(); ++i)
      plot.series[i].points.emplace_back(static_cast<double>(results[i].pairs), results[i].ms);
  };
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const MeshPointer large = surface(icosphere(3)), small = surface(icosphere(2));
  for (double distance : {1.99, 1.9, 1.6, 1.0, 0.3}) {
    ColliderSet set;
    set.add(large);
    set.add(large, {turn, distance * Vec3(0.6, 0.64, 0.48)});
    show(set);
  }
  for (PlotSeries& series : plot.series) series.points.emplace_back(NAN, NAN);  // other bodies, another line
  for (double reach : {1.70, 1.5, 1.2, 0.9, 0.6, 0.4, 0.2, 0.1, 0.07}) {
    ColliderSet set;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      set.add(small, {Eigen::AngleAxisd(0.3 * (i + 1), Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                      reach / std::sqrt(3.0) * corner});
    }
    show(set);
  }
  return plot;
}

void growth(int finest) {
  const std::vector<std::string> names = methods();
  fmt::print(stderr,
             "\nGrowth: two icospheres, far pose (rotated 0.7 rad, moved (0.35, 0.22, 0.13)) and near pose\n{:>6} "
             "{:>10} {:>8}{}   {}\n",
             "pose", "triangles", "pairs", head(names), "peers, ms, printed figures of another machine");
  const char* peers[] = {"",
                         "Embree query 0.25, refit+query 0.6-0.8; FCL AABB refit+query 1.5-1.9",
                         "Embree query 0.45, refit+query 2; FCL 4-5; CGAL 12",
                         "Embree query 0.9-1.6, refit+query 6-8; FCL 27-30; CGAL 60",
                         "Embree query 3.5, refit+query 40-58; FCL 107; CGAL 290",
                         "Embree query 5.5, refit+query 180; FCL 520; CGAL 1600"};
  const std::size_t expected[] = {174, 346, 702, 1400, 2798, 5598};
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  for (const bool is_far : {true, false}) {
    std::vector<std::vector<std::pair<double, double>>> points(names.size());
    const char* pose = is_far ? "far" : "near";
    for (int k = 3; k <= finest; ++k) {
      const MeshPointer mesh = surface(icosphere(k));
      const std::size_t triangles = 2 * mesh->mesh.triangles.size();
      ColliderSet set;
      set.add(mesh);
      set.add(mesh, is_far ? Pose{Eigen::AngleAxisd(0.7, axis).toRotationMatrix(), Vec3(0.35, 0.22, 0.13)}
                           : Pose{Eigen::AngleAxisd(0.05, axis).toRotationMatrix(), Vec3(0.010, 0.007, 0.003)});
      const std::vector<BodyPair> pair = {{BodyIndex(0), BodyIndex(1), 0.0}};
      std::vector<Result> results;
      for (std::size_t i = 0; i < names.size(); ++i) {
        results.push_back(names[i] == kReference && k > 5 ? Result{} : measure(names[i], set, pair));
        if (results.back().ms > 0.0) points[i].emplace_back(static_cast<double>(triangles), results.back().ms);
      }
      row(fmt::format("growth_{}", pose), triangles, results);
      fmt::print(stderr, "{:>6} {:>10} {:>8}{}   {}{}\n", pose, triangles, results.front().pairs, cells(results),
                 is_far && k >= 4 ? peers[k - 3] : "",
                 is_far && results.front().pairs != expected[k - 3] ? "  WRONG NUMBER OF PAIRS" : "");
    }
    fmt::print(stderr, "  {} pose: time grows as", pose);
    for (std::size_t i = 0; i < names.size(); ++i) fmt::print(stderr, " n^{:.2f} ({})", exponent(points[i]), names[i]);
    fmt::print(stderr, "; {} measured to 40,960 triangles\n", kReference);
  }
}

// n x n squares above and below, each two triangles, and walls between
MeshPointer slab(int n) {
  constexpr double kSide = 0.4, kThickness = 0.05;
  TriangleMesh m;
  const auto at = [n](int level, int i, int j) { return (level * (n + 1) + i) * (n + 1) + j; };
  for (int level = 0; level < 2; ++level)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        m.vertices.emplace_back(kSide * i / n - 0.5 * kSide, kThickness * level, kSide * j / n - 0.5 * kSide);
  const auto quad = [&](int a, int b, int c, int d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      quad(at(0, i, j), at(0, i + 1, j), at(0, i + 1, j + 1), at(0, i, j + 1));
      quad(at(1, i, j), at(1, i, j + 1), at(1, i + 1, j + 1), at(1, i + 1, j));
    }
  for (int i = 0; i < n; ++i) {
    quad(at(0, i, 0), at(1, i, 0), at(1, i + 1, 0), at(0, i + 1, 0));
    quad(at(0, i + 1, n), at(1, i + 1, n), at(1, i, n), at(0, i, n));
    quad(at(0, n, i), at(1, n, i), at(1, n, i + 1), at(0, n, i + 1));
    quad(at(0, 0, i + 1), at(1, 0, i + 1), at(1, 0, i), at(0, 0, i));
  }
  return surface(std::move(m));
}

// faces that lie on each other as after a solve: some picometres within each other, turned about their normal
void flush() {
  const std::vector<std::string> names = methods();
  fmt::print(stderr, "\nFlush: a slab of fine triangles on another, 2e-11 m within it\n{:>10} {:>8}{}\n", "triangles",
             "pairs", head(names));
  const Mat3 turn = Eigen::AngleAxisd(0.35, Vec3::UnitY()).toRotationMatrix();
  for (const int n : {10, 40, 100}) {
    const MeshPointer mesh = slab(n);
    ColliderSet set;
    set.add(mesh);
    set.add(mesh, {turn, Vec3(0.03, 0.05 - 2e-11, 0.02)});
    const std::vector<BodyPair> pair = {{BodyIndex(0), BodyIndex(1), 0.0}};
    std::vector<Result> results;
    for (const std::string& name : names)
      results.push_back(name == kReference && n > 40 ? Result{} : measure(name, set, pair));
    const std::size_t triangles = 2 * mesh->mesh.triangles.size();
    row("flush", triangles, results);
    fmt::print(stderr, "{:>10} {:>8}{}\n", triangles, results.front().pairs, cells(results));
  }
}

}  // namespace

int main(int argc, char** argv) {
  int threads = 1, finest = 7;
  std::string picture;
  BenchArguments arguments(
      "bench_narrow_phase",
      "Narrow phases between meshes: the seed's Fig. 6.4, growth with the number of triangles, and the\n"
      "mesh-mesh cases that peers were measured on. CSV on standard output, a summary for people on\n"
      "standard error. Processor time of the whole process (all threads), ms; the median of some repeats\n"
      "after a first call that allocates. Compare figures of one run only: machines and their other users\n"
      "differ.");
  arguments.number("--threads", threads, {1}, "how many");
  arguments.number("--finest", finest, {3, 8}, "K of the finest icosphere, 20·4^K triangles a body");
  arguments.word("--plot", picture, {}, "FILE.png for Fig. 6.4 of the seed as a picture, none if it isn't given");
  arguments.read_or_exit(argc, argv);
  set_thread_count(threads);
  fmt::print("series,triangles,pairs");
  for (const std::string& name : methods()) fmt::print(",{}_ms", name);
  fmt::print("\n");
  fmt::print(stderr, "processor time of {} thread{}\n", threads, threads == 1 ? "" : "s");
  const Plot plot = figure_6_4();
  if (!picture.empty()) write_png(picture, paint_plots({plot}, 1280, 720).front());
  growth(finest);
  flush();
}
