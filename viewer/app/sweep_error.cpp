// The error of a run against a reference, from the surfaces that both exported.
#include <cmath>
#include <map>

#include "engine/io/file.hpp"
#include "engine/io/mesh_file.hpp"
#include "viewer/app/sweep_table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

// the time of each whole frame, from the first two columns of stats.csv
std::vector<double> times_in(const fs::path& run) {
  std::vector<double> times;
  if (!fs::is_regular_file(run / "stats.csv")) return times;
  const std::string text = read_file(run / "stats.csv", std::uint64_t{1} << 32);
  for (std::size_t begin = text.find('\n') + 1, end = 0; begin != 0 && (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    times.push_back(std::strtod(text.c_str() + text.find(',', begin) + 1, nullptr));
  return times;
}

fs::path surface(const fs::path& run, std::size_t frame, const std::string& body) {
  std::string digits = std::to_string(frame);
  digits.insert(0, 6 - std::min<std::size_t>(6, digits.size()), '0');
  return run / "surfaces" / digits / (body + ".ply");
}

}  // namespace

SurfaceDistance surface_distance(const fs::path& run, const fs::path& reference, const std::vector<std::string>& bodies) {
  const std::vector<double> times = times_in(run), others = times_in(reference);
  SurfaceDistance distance;
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  double sum = 0.0;
  std::size_t points = 0;
  for (std::size_t a = 0, b = 0; a < times.size(); ++a) {
    const double tolerance = 1e-9 * (1.0 + times[a]);  // times are sums of steps, rounded
    while (b < others.size() && others[b] < times[a] - tolerance) ++b;
    if (b >= others.size() || others[b] > times[a] + tolerance) continue;
    for (const std::string& body : bodies) {
      const fs::path file_a = surface(run, a, body), file_b = surface(reference, b, body);
      if (!fs::is_regular_file(file_a) || !fs::is_regular_file(file_b)) continue;
      const TriangleMesh mesh_a = read_mesh(file_a), mesh_b = read_mesh(file_b);
      if (mesh_a.vertices.size() != mesh_b.vertices.size()) continue;
      for (std::size_t v = 0; v < mesh_a.vertices.size(); ++v) {
        sum += (mesh_a.vertices[v] - mesh_b.vertices[v]).squaredNorm();
        if (b == 0) low = low.cwiseMin(mesh_b.vertices[v]), high = high.cwiseMax(mesh_b.vertices[v]);
      }
      points += mesh_a.vertices.size();
    }
  }
  if (points == 0) return distance;
  distance.rms = std::sqrt(sum / static_cast<double>(points));
  distance.scene_size = (high - low).norm();
  return distance;
}

}  // namespace impinge
