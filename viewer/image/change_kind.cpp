#include "viewer/image/change_kind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace impinge {

namespace {

constexpr int kReach = 4;                // pixels: shifts that are tried
constexpr int kSharp = 12;               // levels from one pixel to the next that make an edge
constexpr std::size_t kEnough = 20'000;  // places at which shifts are tried
constexpr double kMostly = 0.9;          // of the pixels that differ
constexpr double kSameEdges = 0.75, kNoEdges = 0.35;

struct Place {
  int x, y;
};

std::vector<Place> differing(const Image& a, const Image& b, const Difference& d) {
  std::vector<Place> places;
  for (int y = d.box[1]; y < d.box[1] + d.box[3]; ++y)
    for (int x = d.box[0]; x < d.box[0] + d.box[2]; ++x)
      if (channel_difference(a.pixel(x, y), b.pixel(x, y)) > d.settings.tolerance) places.push_back({x, y});
  return places;
}

/// Enough of them to tell a share: every second one, or third one, ...
std::vector<Place> few_of(const std::vector<Place>& places) {
  const std::size_t stride = places.size() / kEnough + 1;
  std::vector<Place> some;
  for (std::size_t i = 0; i < places.size(); i += stride) some.push_back(places[i]);
  return some;
}

/// Share of the places at which `to` shows what `from` shows at (-dx, -dy) from there; 0 where they leave the picture.
double share_found(const std::vector<Place>& places, const Image& from, const Image& to, int dx, int dy,
                   int tolerance) {
  std::size_t found = 0, there = 0;
  for (const auto& [x, y] : places) {
    const int u = x - dx, v = y - dy;
    if (u < 0 || v < 0 || u >= from.width || v >= from.height) continue;
    ++there;
    found += channel_difference(from.pixel(u, v), to.pixel(x, y)) <= tolerance;
  }
  return 2 * there < places.size() ? 0.0 : static_cast<double>(found) / static_cast<double>(there);
}

bool is_edge(const Image& image, int x, int y) {
  const auto sharp = [&](int u, int v) {
    return u < image.width && v < image.height && channel_difference(image.pixel(x, y), image.pixel(u, v)) > kSharp;
  };
  return sharp(x + 1, y) || sharp(x, y + 1);
}

std::string shift_text(int dx, int dy) {
  const auto part = [](int by, const char* positive, const char* negative) {
    return by == 0
               ? std::string()
               : fmt::format("{} pixel{} {}", std::abs(by), std::abs(by) == 1 ? "" : "s", by > 0 ? positive : negative);
  };
  const std::string across = part(dx, "to the right", "to the left"), down = part(dy, "down", "up");
  return "moved by " + across + (!across.empty() && !down.empty() ? " and " : "") + down;
}

}  // namespace

ChangeKind change_kind(const Image& a, const Image& b, const Difference& difference) {
  ChangeKind kind;
  if (difference.differing == 0 || a.width != b.width || a.height != b.height) return kind;
  const std::vector<Place> places = differing(a, b, difference);
  const std::vector<Place> some = few_of(places);
  // moved: whatever changed in B stood in A at the same distance, and the other way round
  double best = 0.0;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int tolerance = difference.settings.tolerance;
      const double share =
          std::min(share_found(some, a, b, dx, dy, tolerance), share_found(some, b, a, -dx, -dy, tolerance));
      const bool nearer = share == best && std::abs(dx) + std::abs(dy) < std::abs(kind.dx) + std::abs(kind.dy);
      if (share > best || nearer) best = share, kind.dx = dx, kind.dy = dy;
    }
  if (best >= kMostly) {
    kind.kind = ChangeKind::moved;
    kind.text = shift_text(kind.dx, kind.dy);
    return kind;
  }
  kind.dx = kind.dy = 0;

  // edges in and round what differs
  std::vector<std::uint8_t> near(static_cast<std::size_t>(a.width) * a.height, 0);
  for (const auto& [x, y] : places)
    for (int v = std::max(0, y - 1); v <= y; ++v)
      for (int u = std::max(0, x - 1); u <= x; ++u) near[static_cast<std::size_t>(v) * a.width + u] = 1;
  std::int64_t in_a = 0, in_b = 0, in_both = 0, in_either = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (!near[static_cast<std::size_t>(y) * a.width + x]) continue;
      const bool edge_a = is_edge(a, x, y), edge_b = is_edge(b, x, y);
      in_a += edge_a, in_b += edge_b, in_both += edge_a && edge_b, in_either += edge_a || edge_b;
    }
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(whole, 1));
  };
  if (in_either > 0 && share(in_both, in_either) >= kSameEdges) {
    kind.kind = ChangeKind::recolored;
    kind.text = "other colours, the shapes stand where they stood";
  } else if (in_a > 0 && share(in_b, in_a) <= kNoEdges) {
    kind.kind = ChangeKind::missing;
    kind.text = "something of A is missing in B";
  } else if (in_b > 0 && share(in_a, in_b) <= kNoEdges) {
    kind.kind = ChangeKind::added;
    kind.text = "something is new in B";
  } else {
    kind.kind = ChangeKind::other;
    kind.text = "other shapes";
  }
  return kind;
}

}  // namespace impinge
