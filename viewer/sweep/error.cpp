#include "viewer/sweep/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/meshes/mesh_file.hpp"
#include "engine/io/paths.hpp"
#include "engine/world/step_record.hpp"
#include "viewer/sweep/surface_match.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;
constexpr double kApart = 1e-3;  // scene sizes
// of a body's size: surfaces of other triangles that begin farther apart are no two of the same body at the same place
constexpr double kOtherBody = 0.1;

double time_of(const StatsLine& line) { return line.figures[sweep_figure("time_s")]; }

// frames of two runs that show the same time, up to the window's end; times are sums of steps, rounded
std::vector<std::pair<std::size_t, std::size_t>> common_frames(const std::vector<StatsLine>& a,
                                                               const std::vector<StatsLine>& b, double window) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0, k = 0; i < a.size(); ++i) {
    const double time = time_of(a[i]), tolerance = 1e-9 * (1.0 + time);
    if (time > window + tolerance) break;
    while (k < b.size() && time_of(b[k]) < time - tolerance) ++k;
    if (k < b.size() && time_of(b[k]) <= time + tolerance) pairs.emplace_back(i, k);
  }
  return pairs;
}

TriangleMesh mesh(const fs::path& run, std::size_t frame, const std::string& body) {
  const fs::path file = run / "surfaces" / fmt::format("{:06}", frame) / (body + ".ply");
  return is_file(file) ? read_mesh(file) : TriangleMesh();
}

std::vector<Vec3> surface(const fs::path& run, std::size_t frame, const std::string& body) {
  return mesh(run, frame, body).vertices;
}

// sum of squared distances and number of points of one pair of frames
struct Squares {
  double sum = 0.0;
  std::size_t points = 0;
  void add(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    if (a.size() != b.size()) return;
    for (std::size_t v = 0; v < a.size(); ++v) sum += (a[v] - b[v]).squaredNorm();
    points += a.size();
  }
  double rms() const { return points == 0 ? -1.0 : std::sqrt(sum / static_cast<double>(points)); }
};

double start_size(const fs::path& run, const std::vector<std::string>& bodies) {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const std::string& body : bodies)
    for (const Vec3& x : surface(run, 0, body)) low = low.cwiseMin(x), high = high.cwiseMax(x);
  return low.x() > high.x() ? 0.0 : (high - low).norm();
}

// by body; of what is too far from the reference's surface to be the same body's, errors.mismatch says so
std::map<std::string, SurfaceMatch> match_surfaces(const fs::path& run, const fs::path& reference,
                                                   const std::vector<std::string>& bodies, SweepErrors& errors) {
  std::map<std::string, SurfaceMatch> matches;
  for (const std::string& body : bodies) {
    const SurfaceMatch& match =
        matches.emplace(body, SurfaceMatch(mesh(run, 0, body), mesh(reference, 0, body))).first->second;
    if (match.is_by_number()) continue;
    errors.apart = std::max(errors.apart, match.apart());
    if (const double size = start_size(reference, {body}); match.apart() > kOtherBody * size)
      errors.mismatch =
          fmt::format("no error: the surface of '{}' begins up to {:.3g} m from the reference's, {:.0f} % of its size",
                      body, match.apart(), 100.0 * match.apart() / size);
  }
  return matches;
}

// net impulse of the last sub-step on the first body of each pair, by frame
using PairImpulses = std::map<std::string, Vec3>;
std::map<std::size_t, PairImpulses> impulses_in(const fs::path& run) {
  std::map<std::size_t, PairImpulses> frames;
  if (!is_file(run / "contacts.csv")) return frames;
  const std::string text = read_file(run / "contacts.csv", std::uint64_t{1} << 34);
  for (std::size_t begin = text.find('\n') + 1, end = 0;
       begin != 0 && (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    std::vector<std::string> words(1);
    for (std::size_t i = begin; i < end; ++i)
      if (text[i] == ',')
        words.emplace_back();
      else
        words.back() += text[i];
    if (words.size() < 19) continue;
    const auto number = [&](std::size_t i) { return std::strtod(words[i].c_str(), nullptr); };
    const Vec3 n(number(11), number(12), number(13)), t1 = tangent1(n), t2 = n.cross(t1);
    Vec3& sum =
        frames[static_cast<std::size_t>(number(0))].emplace(words[1] + "," + words[2], Vec3::Zero()).first->second;
    sum += number(16) * n + number(17) * t1 + number(18) * t2;
  }
  return frames;
}

double sub_step(const std::vector<StatsLine>& lines, std::size_t i) {
  return i == 0 ? 0.0 : (time_of(lines[i]) - time_of(lines[i - 1])) / lines[i].figures[sweep_figure("substeps")];
}

void compare_forces(const fs::path& run, const fs::path& reference, const std::vector<StatsLine>& a,
                    const std::vector<StatsLine>& b, const std::vector<std::pair<std::size_t, std::size_t>>& frames,
                    SweepErrors& errors) {
  auto own = impulses_in(run), other = impulses_in(reference);
  double difference = 0.0, size = 0.0;
  std::size_t count = 0;
  for (const auto& [i, k] : frames) {
    if (i == 0 || k == 0) continue;  // nothing is solved for frame 0
    PairImpulses& mine = own[i];
    PairImpulses& theirs = other[k];
    for (const auto& [pair, impulse] : theirs) mine.emplace(pair, Vec3::Zero());
    for (const auto& [pair, impulse] : mine) {
      const auto it = theirs.find(pair);
      const Vec3 force = impulse / sub_step(a, i),
                 wanted = it == theirs.end() ? Vec3(Vec3::Zero()) : Vec3(it->second / sub_step(b, k));
      difference += (force - wanted).squaredNorm();
      size += wanted.squaredNorm();
    }
    ++count;
  }
  if (count == 0) return;
  errors.force = std::sqrt(difference / static_cast<double>(count));
  if (size > 0.0) errors.force_relative = std::sqrt(difference / size);
}

}  // namespace

ErrorWindow automatic_window(const fs::path& reference, const fs::path& perturbed,
                             const std::vector<std::string>& bodies) {
  const std::vector<StatsLine> a = sweep_stats(reference), b = sweep_stats(perturbed);
  const double size = start_size(reference, bodies);
  ErrorWindow window;
  double first = -1.0, before = 0.0;
  for (const auto& [i, k] : common_frames(a, b, window.seconds)) {
    Squares squares;
    for (const std::string& body : bodies) squares.add(surface(reference, i, body), surface(perturbed, k, body));
    const double apart = squares.rms(), time = time_of(a[i]);
    if (apart < 0.0) continue;
    if (first < 0.0 && apart > 0.0) first = apart;
    if (apart > kApart * size) {
      window.seconds = before;
      window.reason =
          fmt::format("a start 1e-9 scene sizes aside is {:.1e} scene sizes away at {:.3g} s (e-fold in {:.2g} s)",
                      apart / size, time, time / std::log(apart / first));
      return window;
    }
    before = time;
    window.reason = fmt::format("all: a start 1e-9 scene sizes aside stays within {:.1e} scene sizes", kApart);
  }
  if (window.reason.empty()) window.reason = "all: the run that starts 1e-9 scene sizes aside left nothing to compare";
  return window;
}

SweepErrors sweep_errors(const fs::path& run, const fs::path& reference, const std::vector<std::string>& bodies,
                         double window) {
  const std::vector<StatsLine> a = sweep_stats(run), b = sweep_stats(reference);
  const auto frames = common_frames(a, b, window);
  SweepErrors errors;
  if (frames.size() < 2) return errors;
  Squares squares;
  double own_depth = 0.0, depth = 0.0;
  const auto energy = [](const StatsLine& line) {
    return line.figures[sweep_figure("kinetic_J")] + line.figures[sweep_figure("potential_J")] +
           line.figures[sweep_figure("elastic_J")];
  };
  const auto momentum = [](const StatsLine& line) {
    return Vec3(line.figures[sweep_figure("momentum_x")], line.figures[sweep_figure("momentum_y")],
                line.figures[sweep_figure("momentum_z")]);
  };
  const std::map<std::string, SurfaceMatch> matches = match_surfaces(run, reference, bodies, errors);
  if (!errors.mismatch.empty()) return errors;
  for (const auto& [i, k] : frames) {
    for (const auto& [body, match] : matches)
      squares.add(surface(run, i, body), match.points(surface(reference, k, body)));
    own_depth = std::max(own_depth, a[i].figures[sweep_figure("max_penetration_m")]);
    depth = std::max(depth, b[k].figures[sweep_figure("max_penetration_m")]);
    errors.energy = std::max(errors.energy, std::abs(energy(a[i]) - energy(b[k])));
    errors.momentum = std::max(errors.momentum, (momentum(a[i]) - momentum(b[k])).norm());
    errors.seconds = time_of(a[i]);
  }
  errors.rms = squares.rms();
  errors.penetration = own_depth - depth;
  const double size = start_size(reference, bodies);
  if (errors.exist() && size > 0.0) errors.relative = errors.rms / size;
  compare_forces(run, reference, a, b, frames, errors);
  return errors;
}

SweepErrors analytic_errors(const fs::path& run, const AnalyticMotion& motion, const std::vector<std::string>& bodies,
                            ErrorWindow& window) {
  const std::vector<StatsLine> lines = sweep_stats(run);
  std::map<std::string, std::vector<Vec3>> start;
  for (const std::string& body : bodies) start[body] = surface(run, 0, body);
  SweepErrors errors;
  Squares squares;
  std::size_t count = 0;
  for (std::size_t i = 0; i < lines.size() && time_of(lines[i]) <= window.seconds * (1.0 + 1e-9); ++i) {
    if (motion.ends_with_contact && lines[i].figures[sweep_figure("contacts")] > 0.0) {
      window.seconds = errors.seconds;
      window.reason = fmt::format("the formula holds until the first contact at {:.3g} s", time_of(lines[i]));
      break;
    }
    for (const std::string& body : bodies) {
      std::vector<Vec3> wanted = start[body];
      for (Vec3& x : wanted) x += motion.displacement(body, time_of(lines[i]));
      squares.add(surface(run, i, body), wanted);
    }
    errors.seconds = time_of(lines[i]);
    ++count;
  }
  if (count < 2) return errors;
  errors.rms = squares.rms();
  const double size = start_size(run, bodies);
  if (errors.exist() && size > 0.0) errors.relative = errors.rms / size;
  return errors;
}

}  // namespace impinge
