// Surfaces with triangles that are much smaller or larger than the rest: contacts go by the mean edge.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/units.hpp"
#include "engine/preflight/warning.hpp"

namespace impinge {
namespace {

constexpr double kMostOfMedian = 100.0;  // times, of the median
constexpr double kFew = 0.01;            // of all: so few small ones, which scans have at their seams, disturb nobody

/// Longest edge.
double size_of(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
}

struct Odd {
  std::size_t count = 0, worst = 0;  // triangles; which
  double size = 0.0;                 // of the worst, metres
};

class TriangleSizes : public Warning {
 public:
  std::vector<Finding> look(const SceneAtStart& start) const override {
    std::vector<Finding> found;
    std::set<const SurfaceMesh*> seen;
    for (const Body& body : start.world.bodies()) {
      const SurfaceMesh* surface = body.shape->mesh();
      if (surface == nullptr || surface->mesh.triangles.empty() || !seen.insert(surface).second) continue;
      look_at(body, surface->mesh, found);
    }
    return found;
  }

 private:
  static void look_at(const Body& body, const TriangleMesh& mesh, std::vector<Finding>& found) {
    std::vector<double> sizes;
    for (const Triangle& t : mesh.triangles) sizes.push_back(size_of(mesh, t));
    std::vector<double> sorted = sizes;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double median = *middle;
    Odd small, large;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const auto take = [&](Odd& odd, bool is_worse) {
        if (odd.count++ == 0 || is_worse) odd.worst = i, odd.size = sizes[i];
      };
      if (sizes[i] * kMostOfMedian < median) take(small, sizes[i] < small.size);
      if (sizes[i] > kMostOfMedian * median) take(large, sizes[i] > large.size);
    }
    const auto tell = [&](const Odd& odd, const char* word, const char* remedy) {
      if (odd.count == 0) return;
      const double times = odd.size > median ? odd.size / median : median / odd.size;
      found.push_back(
          {fmt::format("{} of {} triangles of '{}'{} are over {:g} times {} than half of them, number {} by "
                       "{:.3g} times: {}, where the median is {}",
                       odd.count, sizes.size(), body.name,
                       body.surface_file.empty() ? "" : " (" + body.surface_file + ")", kMostOfMedian, word, odd.worst,
                       times, length_text(odd.size), length_text(median)),
           remedy});
    };
    if (static_cast<double>(small.count) > kFew * static_cast<double>(sizes.size()))
      tell(small, "smaller", "weld close vertices, or remesh: searches and lengths go by the mean edge");
    tell(large, "larger", "split them, or make a shape of it: searches and lengths go by the mean edge");
  }
};

}  // namespace

Entry<Warning> triangle_sizes_warning() {
  return entry<Warning, TriangleSizes>("triangle-sizes",
                                       "a surface has triangles much smaller or larger than the rest");
}

}  // namespace impinge
