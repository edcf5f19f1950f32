// Pictures a second at 1280 x 720.
#include <fmt/format.h>
#include <ctime>

#include <algorithm>
#include <chrono>

#include "engine/core/parallel.hpp"
#include "engine/shapes/primitives.hpp"
#include "tests/support/pictures/hand_made_record.hpp"
#include "tests/support/program/bench_arguments.hpp"
#include "viewer/image/png.hpp"
#include "viewer/layers/layer.hpp"
#include "viewer/present/frame_painter.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Of all threads: what is left to compare where others use the machine too.
double processor_ms() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Body>
double median_ms(int repeats, const Body& body) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const double start = now_ms();
    body(i);
    times.push_back(now_ms() - start);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

/// Spheres as meshes, side by side on a floor; 20 * 4^k triangles each.
void add_spheres(test::HandMadeRecord& scene, int count, int divisions) {
  TriangleMesh mesh = Sphere{0.4}.drawn();  // 1280 triangles
  if (divisions < 3) {
    mesh.vertices = {{0.4, 0, 0}, {-0.4, 0, 0}, {0, 0.4, 0}, {0, -0.4, 0}, {0, 0, 0.4}, {0, 0, -0.4}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  }
  const auto surface = std::make_shared<SurfaceMesh>(SurfaceMesh{mesh, make_topology(mesh)});
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  scene.add("floor", BodyKind::fixed, Plane{Vec3::UnitY(), 0.0}, Vec3::Zero());
  for (int i = 0; i < count; ++i)
    scene.add(fmt::format("s{}", i), BodyKind::dynamic, MeshPointer(surface),
              {i % side - 0.5 * side, 0.4, i / side - 0.5 * side});
}

}  // namespace

int main(int argc, char** argv) {
  BenchArguments arguments(
      "bench_rendering",
      "Pictures a second at 1280 x 720: a record in, pixels out, and with encoding as PNG in the same\n"
      "thread (a run encodes on another one), ms. Beside them what the same software renderer needed for\n"
      "the bare triangles, and what MuJoCo's needed.");
  arguments.read_or_exit(argc, argv);
  fmt::print("{:>10} {:>13} {:>12} {:>12} {:>12} {:>12}   {}\n", "triangles", "antialiasing", "paint ms", "cpu ms",
             "with PNG ms", "pictures/s", "peers, ms a frame with 1 / 2 threads");
  struct Case {
    int count, divisions, triangles;
    const char* peers;
  };
  for (const Case& c :
       {Case{10, 0, 80, "llvmpipe alone 3.6 / 1.9"}, Case{55, 3, 70400, "llvmpipe alone 29 / 22; MuJoCo's 73-78"},
        Case{158, 3, 202240, "llvmpipe alone (203k) 51 / 37"}}) {
    test::HandMadeRecord scene;
    add_spheres(scene, c.count, c.divisions);
    ViewSettings settings = make_view_settings();
    settle_camera(settings, scene.record(), 16.0 / 9.0);
    FramePainter painter(1280, 720);
    Image image;
    for (const bool smooth : {false, true}) {
      settings.antialiasing = smooth;
      painter.paint(scene.record(), settings, image);  // buffers and shaders are made once
      const double start = processor_ms();
      const double paint = median_ms(15, [&](int) { painter.paint(scene.record(), settings, image); });
      const double processor = (processor_ms() - start) / 15.0;
      std::size_t bytes = 0;
      const double both = median_ms(15, [&](int) {
        painter.paint(scene.record(), settings, image);
        bytes += encode_png(image).size();
      });
      fmt::print("{:>10} {:>13} {:>12.1f} {:>12.1f} {:>12.1f} {:>12.1f}   {}\n", c.triangles, smooth ? "edges" : "none",
                 paint, processor, both, 1e3 / both, c.peers);
    }
  }
}
