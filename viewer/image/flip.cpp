#include "viewer/image/flip.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"

namespace impinge {

namespace {

using Plane = std::vector<float>;  // one value a pixel, row by row
using Triple = std::array<double, 3>;

// constants of [Andersson20 §4, §5]
constexpr double kErrorExponent = 0.7, kKnee = 0.4, kAtKnee = 0.95, kFeatureExponent = 0.5, kFeatureWidth = 0.082;
constexpr int kTile = 128;  // pixels

// linear RGB to XYZ (D65) and back, and the white that the rows add up to
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
                                 {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
                                 {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};
constexpr double kFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};

Triple white() {
  Triple w;
  for (int i = 0; i < 3; ++i) w[i] = kToXyz[i][0] + kToXyz[i][1] + kToXyz[i][2];
  return w;
}

Triple times(const double (&m)[3][3], const Triple& v) {
  Triple out;
  for (int i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

double linear(std::uint8_t level) {
  const double s = level / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// linear in XYZ: CIELAB's axes without its cube roots
Triple opponent(const Triple& rgb) {
  static const Triple w = white();
  const Triple c = times(kToXyz, rgb);
  const double x = c[0] / w[0], y = c[1] / w[1], z = c[2] / w[2];
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Triple from_opponent(const Triple& c) {
  static const Triple w = white();
  const double y = (c[0] + 16.0) / 116.0;
  return times(kFromXyz, {w[0] * (y + c[1] / 500.0), w[1] * y, w[2] * (y - c[2] / 200.0)});
}

// CIELAB with colours that fade in the dark as the eye's do: [Hunt52]
Triple hunt_lab(const Triple& rgb) {
  static const Triple w = white();
  const Triple c = times(kToXyz, rgb);
  Triple f;
  constexpr double d = 6.0 / 29.0;
  for (int i = 0; i < 3; ++i) {
    const double t = c[i] / w[i];
    f[i] = t > d * d * d ? std::cbrt(t) : t / (3.0 * d * d) + 4.0 / 29.0;
  }
  const double l = 116.0 * f[1] - 16.0;
  return {l, 0.01 * l * 500.0 * (f[0] - f[1]), 0.01 * l * 200.0 * (f[1] - f[2])};
}

// a distance that holds for large differences too [Abasi20]
double hyab(const Triple& a, const Triple& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

/// Weights at -radius ... radius.
using Kernel = std::vector<double>;

template <class Weight>
Kernel kernel(int radius, Weight weight) {
  Kernel k;
  for (int i = -radius; i <= radius; ++i) k.push_back(weight(i));
  return k;
}

// positive weights add up to 1, negative ones to -1
Kernel balanced(Kernel k) {
  double positive = 0.0, negative = 0.0;
  for (const double w : k) (w > 0.0 ? positive : negative) += w;
  for (double& w : k) w = w > 0.0 ? w / positive : negative < 0.0 ? -w / negative : 0.0;
  return k;
}

/// Columns by `across`, then rows by `down`; beyond the border its last pixel goes on.
Plane filtered(const Plane& in, int width, int height, const Kernel& across, const Kernel& down) {
  using Row = Eigen::Map<const Eigen::ArrayXf>;
  Plane half(in.size()), out(in.size());
  const int rx = static_cast<int>(across.size() / 2), ry = static_cast<int>(down.size() / 2);
  std::vector<float> wide(static_cast<std::size_t>(width) + 2 * rx);
  Eigen::ArrayXd sum(width);
  for (int y = 0; y < height; ++y) {
    const float* row = in.data() + static_cast<std::size_t>(y) * width;
    for (int x = -rx; x < width + rx; ++x) wide[x + rx] = row[std::clamp(x, 0, width - 1)];
    sum.setZero();
    for (std::size_t k = 0; k < across.size(); ++k) sum += across[k] * Row(wide.data() + k, width).cast<double>();
    Eigen::Map<Eigen::ArrayXf>(half.data() + static_cast<std::size_t>(y) * width, width) = sum.cast<float>();
  }
  for (int y = 0; y < height; ++y) {
    sum.setZero();
    for (int k = -ry; k <= ry; ++k) {
      const float* row = half.data() + static_cast<std::size_t>(std::clamp(y + k, 0, height - 1)) * width;
      sum += down[k + ry] * Row(row, width).cast<double>();
    }
    Eigen::Map<Eigen::ArrayXf>(out.data() + static_cast<std::size_t>(y) * width, width) = sum.cast<float>();
  }
  return out;
}

/// One sum of Gaussians of the eye's contrast sensitivity: weight sqrt(pi/b) a each, over degrees.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivity[3] = {{1.0, 0.0047, 0.0, 1e-5}, {1.0, 0.0053, 0.0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
constexpr double kWidest = 0.04;  // the largest b

class Observer {
 public:
  explicit Observer(double pixels_per_degree) {
    constexpr double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest / (2.0 * pi * pi)) * pixels_per_degree));
    reach_ = radius;
    for (int c = 0; c < 3; ++c) {
      const Sensitivity& s = kSensitivity[c];
      double total = 0.0;
      for (const auto& [a, b] : {std::pair{s.a1, s.b1}, {s.a2, s.b2}}) {
        if (a == 0.0) continue;
        const double rate = pi * pi / (b * pixels_per_degree * pixels_per_degree);
        const Kernel k = kernel(radius, [&](int i) { return std::exp(-rate * i * i); });
        double sum = 0.0;
        for (const double w : k) sum += w;
        const double weight = a * std::sqrt(pi / b);
        parts_[c].push_back({weight, k});
        total += weight * sum * sum;
      }
      for (Part& part : parts_[c]) part.weight /= total;
    }
    const double sd = 0.5 * kFeatureWidth * pixels_per_degree;
    const int reach = static_cast<int>(std::ceil(3.0 * sd));
    reach_ = std::max(reach_, reach);
    const auto bell = [&](int i) { return std::exp(-i * i / (2.0 * sd * sd)); };
    smooth_ = kernel(reach, bell);
    double sum = 0.0;
    for (const double w : smooth_) sum += w;
    for (double& w : smooth_) w /= sum;
    edge_ = balanced(kernel(reach, [&](int i) { return -i * bell(i); }));
    point_ = balanced(kernel(reach, [&](int i) { return (i * i / (sd * sd) - 1.0) * bell(i); }));
  }

  /// Pixels: what lies farther away changes nothing at a pixel.
  int reach() const { return reach_; }

  /// What is left of the colours at that distance, as CIELAB after Hunt.
  std::vector<Triple> colors(const std::array<Plane, 3>& channels, int width, int height) const {
    std::array<Plane, 3> seen;
    for (int c = 0; c < 3; ++c) {
      seen[c].assign(channels[c].size(), 0.0f);
      for (const Part& part : parts_[c]) {
        const Plane one = filtered(channels[c], width, height, part.kernel, part.kernel);
        for (std::size_t i = 0; i < one.size(); ++i) seen[c][i] += static_cast<float>(part.weight * one[i]);
      }
    }
    std::vector<Triple> lab(channels[0].size());
    for (std::size_t i = 0; i < lab.size(); ++i) {
      Triple rgb = from_opponent({seen[0][i], seen[1][i], seen[2][i]});
      for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
      lab[i] = hunt_lab(rgb);
    }
    return lab;
  }

  /// Strengths of edges and of points in a channel from 0 to 1.
  std::array<Plane, 2> features(const Plane& luminance, int width, int height) const {
    std::array<Plane, 2> strength;
    for (int k = 0; k < 2; ++k) {
      const Kernel& detector = k == 0 ? edge_ : point_;
      strength[k] = filtered(luminance, width, height, detector, smooth_);
      const Plane down = filtered(luminance, width, height, smooth_, detector);
      for (std::size_t i = 0; i < down.size(); ++i) strength[k][i] = std::hypot(strength[k][i], down[i]);
    }
    return strength;
  }

 private:
  struct Part {
    double weight;
    Kernel kernel;
  };
  int reach_ = 0;
  std::vector<Part> parts_[3];
  Kernel smooth_, edge_, point_;
};

struct Seen {
  std::vector<Triple> colors;
  std::array<Plane, 2> features;
};

Seen look_at(const Image& image, const Observer& observer) {
  static const std::vector<double> table = [] {
    std::vector<double> t;
    t.reserve(256);
    for (int level = 0; level < 256; ++level) t.push_back(linear(static_cast<std::uint8_t>(level)));
    return t;
  }();
  const std::size_t pixels = image.rgb.size() / 3;
  std::array<Plane, 3> channels;
  for (Plane& plane : channels) plane.resize(pixels);
  Plane luminance(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* p = image.rgb.data() + 3 * i;
    const Triple c = opponent({table[p[0]], table[p[1]], table[p[2]]});
    for (int k = 0; k < 3; ++k) channels[k][i] = static_cast<float>(c[k]);
    luminance[i] = static_cast<float>((c[0] + 16.0) / 116.0);
  }
  return {observer.colors(channels, image.width, image.height),
          observer.features(luminance, image.width, image.height)};
}

struct Box {
  int x, y, width, height;
};

/// The box with so many pixels more on each side, as far as the picture goes.
Box grown(const Box& box, int by, const Image& image) {
  const int x = std::max(0, box.x - by), y = std::max(0, box.y - by);
  return {x, y, std::min(image.width, box.x + box.width + by) - x, std::min(image.height, box.y + box.height + by) - y};
}

bool is_same_in(const Box& box, const Image& a, const Image& b) {
  for (int y = box.y; y < box.y + box.height; ++y)
    if (!std::equal(a.pixel(box.x, y), a.pixel(box.x, y) + std::size_t{3} * box.width, b.pixel(box.x, y))) return false;
  return true;
}

Image part_of(const Image& image, const Box& box) {
  Image part(box.width, box.height);
  for (int y = 0; y < box.height; ++y)
    std::copy_n(image.pixel(box.x, box.y + y), std::size_t{3} * box.width, part.pixel(0, y));
  return part;
}

float error_of(const Seen& a, const Seen& b, std::size_t i) {
  // the two most distant colours of the gamut
  static const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kErrorExponent),
                      knee = kKnee * largest;
  const double distance = std::pow(hyab(a.colors[i], b.colors[i]), kErrorExponent);
  const double color =
      distance < knee ? kAtKnee / knee * distance : kAtKnee + (distance - knee) / (largest - knee) * (1.0 - kAtKnee);
  double feature = 0.0;
  for (int k = 0; k < 2; ++k) feature = std::max(feature, std::abs(double{a.features[k][i]} - b.features[k][i]));
  feature = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
  return static_cast<float>(std::pow(color, 1.0 - feature));
}

}  // namespace

Flip flip(const Image& a, const Image& b, double pixels_per_degree) {
  IMPINGE_ASSERT(a.width == b.width && a.height == b.height && !a.rgb.empty() && pixels_per_degree > 0.0);
  const Observer observer(pixels_per_degree);
  Flip result;
  result.error.resize(a.rgb.size() / 3, 0.0f);
  // in tiles: most of two pictures is the same as a rule, and nothing is to be seen where all is that an eye takes in
  const int across = (a.width + kTile - 1) / kTile, down = (a.height + kTile - 1) / kTile;
  parallel_for(static_cast<std::size_t>(across) * down, 1, [&](std::size_t k) {
    const int x = static_cast<int>(k) % across * kTile, y = static_cast<int>(k) / across * kTile;
    const Box tile{x, y, std::min(kTile, a.width - x), std::min(kTile, a.height - y)};
    const Box around = grown(tile, observer.reach(), a);
    if (is_same_in(around, a, b)) return;
    const Seen seen_a = look_at(part_of(a, around), observer), seen_b = look_at(part_of(b, around), observer);
    for (int v = tile.y; v < tile.y + tile.height; ++v)
      for (int u = tile.x; u < tile.x + tile.width; ++u)
        result.error[static_cast<std::size_t>(v) * a.width + u] =
            error_of(seen_a, seen_b, static_cast<std::size_t>(v - around.y) * around.width + (u - around.x));
  });
  for (const float e : result.error) result.mean += e;
  result.mean /= static_cast<double>(result.error.size());
  return result;
}

}  // namespace impinge
