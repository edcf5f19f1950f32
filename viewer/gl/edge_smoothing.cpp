#include "viewer/gl/edge_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/core/parallel.hpp"

namespace impinge {
namespace {

constexpr int kLeastContrast = 10;  // of 255; below it steps are not seen
constexpr int kReach = 16;          // pixels that an edge is followed to either side

/// Brightness, 0..255; below 0 where nothing or little is, so that any surface stands out from that.
struct Luma {
  std::vector<std::int16_t> values;
  int width, height;

  int operator()(int x, int y) const {
    return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width + std::clamp(x, 0, width - 1)];
  }
};

/// How far from (x, y) the border between it and its neighbour at (x + px, y + py) runs along (ax, ay) unbroken, in
/// pixels, and by how much the pair where it ends is brighter than the border's mean (twice that, in levels).
struct End {
  int distance, beyond;
};

End follow(const Luma& luma, int x, int y, int px, int py, int ax, int ay, int pair, int limit) {
  int beyond = 0;
  for (int i = 1; i <= kReach; ++i) {
    const int u = x + i * ax, v = y + i * ay;
    beyond = luma(u, v) + luma(u + px, v + py) - pair;
    if (std::abs(beyond) >= limit) return {i, beyond};
  }
  return {kReach, beyond};
}

/// How much of the colour across the edge the pixel takes, 0..0.5; (px, py) is set to the side it comes from.
float share_of_neighbour(const Luma& luma, int x, int y, int& px, int& py) {
  const int m = luma(x, y), n = luma(x, y - 1), s = luma(x, y + 1), w = luma(x - 1, y), e = luma(x + 1, y);
  const int high = std::max({m, n, s, w, e}), contrast = high - std::min({m, n, s, w, e});
  if (contrast < std::max(kLeastContrast, high / 10)) return 0.0f;
  const int nw = luma(x - 1, y - 1), ne = luma(x + 1, y - 1), sw = luma(x - 1, y + 1), se = luma(x + 1, y + 1);
  // second differences down the columns and along the rows: the edge runs across the larger ones
  const int down = std::abs(nw + sw - 2 * w) + 2 * std::abs(n + s - 2 * m) + std::abs(ne + se - 2 * e);
  const int along = std::abs(nw + ne - 2 * n) + 2 * std::abs(w + e - 2 * m) + std::abs(sw + se - 2 * s);
  const bool level = down >= along;
  const int first = level ? n : w, second = level ? s : e;
  const bool towards_first = std::abs(first - m) >= std::abs(second - m);
  const int other = towards_first ? first : second;
  px = level ? 0 : (towards_first ? -1 : 1);
  py = level ? (towards_first ? -1 : 1) : 0;
  const int limit = std::max(1, std::abs(other - m) / 2);
  const End back = follow(luma, x, y, px, py, level ? -1 : 0, level ? 0 : -1, m + other, limit);
  const End forth = follow(luma, x, y, px, py, level ? 1 : 0, level ? 0 : 1, m + other, limit);
  const End nearer = back.distance < forth.distance ? back : forth;
  float share = 0.0f;
  // where the edge ends it turns to one side: only the pixels that lose area by it change
  if ((nearer.beyond < 0) != (m < other))
    share = 0.5f - static_cast<float>(nearer.distance) / static_cast<float>(back.distance + forth.distance);
  // a pixel that sticks out of its surroundings is drawn towards them
  const float mean = static_cast<float>(2 * (n + s + e + w) + ne + nw + se + sw) / 12.0f;
  const float spike = std::min(1.0f, std::abs(mean - static_cast<float>(m)) / static_cast<float>(contrast));
  const float eased = spike * spike * (3.0f - 2.0f * spike);
  return std::max(share, 0.4f * eased * eased);
}

/// How much a pixel and its four neighbours differ, of a row: a loop without branches, which compilers make one of eight
/// pixels at once.
void contrasts_of_row(const Luma& luma, int y, std::int16_t* to) {
  const int width = luma.width;
  const std::int16_t* own = luma.values.data() + static_cast<std::size_t>(y) * width;
  const std::int16_t *up = y > 0 ? own - width : own, *down = y + 1 < luma.height ? own + width : own;
  const auto contrast = [&](int x, int west, int east) {
    const std::int16_t high = std::max({own[x], up[x], down[x], own[west], own[east]}),
                       low = std::min({own[x], up[x], down[x], own[west], own[east]});
    return static_cast<std::int16_t>(high - low);
  };
  to[0] = contrast(0, 0, std::min(1, width - 1));
  for (int x = 1; x + 1 < width; ++x) {
    const std::int16_t a = std::max(own[x - 1], own[x + 1]), b = std::max(up[x], down[x]);
    const std::int16_t c = std::min(own[x - 1], own[x + 1]), d = std::min(up[x], down[x]);
    const std::int16_t high = std::max(std::max(a, b), own[x]), low = std::min(std::min(c, d), own[x]);
    to[x] = static_cast<std::int16_t>(high - low);
  }
  if (width > 1) to[width - 1] = contrast(width - 1, width - 2, width - 1);
}

}  // namespace

void smooth_edges(const std::vector<std::uint8_t>& in, std::vector<std::uint8_t>& out, int width, int height) {
  Luma luma{std::vector<std::int16_t>(static_cast<std::size_t>(width) * height), width, height};
  out.resize(in.size());
  parallel_for(static_cast<std::size_t>(height), 64, [&](std::size_t row) {
    const std::uint8_t* p = in.data() + row * width * 4;
    std::int16_t* to = luma.values.data() + row * width;
    for (int x = 0; x < width; ++x, p += 4)
      to[x] = static_cast<std::int16_t>(((77 * p[0] + 150 * p[1] + 29 * p[2]) >> 8) + p[3] - 255);
  });
  parallel_for(static_cast<std::size_t>(height), 64, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::copy_n(in.data() + row * width * 4, width * 4, out.data() + row * width * 4);
    thread_local std::vector<std::int16_t> contrast;
    contrast.resize(static_cast<std::size_t>(width));
    contrasts_of_row(luma, y, contrast.data());
    for (int x = 0; x < width; ++x) {
      if (contrast[x] < kLeastContrast) continue;  // nearly all pixels
      int px = 0, py = 0;
      const float share = share_of_neighbour(luma, x, y, px, py);
      if (share <= 0.0f) continue;
      const int u = std::clamp(x + px, 0, width - 1), v = std::clamp(y + py, 0, height - 1);
      const std::uint8_t* own = in.data() + (row * width + x) * 4;
      const std::uint8_t* other = in.data() + (static_cast<std::size_t>(v) * width + u) * 4;
      std::uint8_t* to = out.data() + (row * width + x) * 4;
      for (int c = 0; c < 4; ++c)
        to[c] = static_cast<std::uint8_t>(
            std::lround(static_cast<float>(own[c]) + share * static_cast<float>(other[c] - own[c])));
    }
  });
}

}  // namespace impinge
