#include "engine/detection/pairs/ridge_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace impinge {
namespace {

constexpr double kPlace = 1e-5;      // of the smaller solid's size: ridges closer than this meet
constexpr double kParallel = 0.02;   // sine
constexpr double kLeastRoom = 0.25;  // radians of directions: with less, a face lies on a face
constexpr int kRidge = 1 << 20;      // numbers of its contacts, beside those of faces, corners and crossings

struct Ridge {
  int edge = -1;
  Vec3 from, to;
  Vec3 normals[2];  // of its faces, outward
};

/// Edges whose ends lie both among the farthest corners.
std::vector<Ridge> foremost(const PlacedPolyhedron& placed, const Vec3& direction, double within) {
  const ConvexPolyhedron& solid = placed.solid;
  const Vec3 local = placed.pose.rotation.transpose() * direction;
  const double least = local.dot(solid.vertices()[solid.support_vertex(local)]) - within;
  std::vector<Ridge> found;
  for (std::size_t e = 0; e < solid.edges().size(); ++e) {
    const ConvexPolyhedron::Edge& edge = solid.edges()[e];
    const Vec3 &p = solid.vertices()[edge.vertex0], &q = solid.vertices()[edge.vertex1];
    if (local.dot(p) < least || local.dot(q) < least) continue;
    const Mat3& r = placed.pose.rotation;
    found.push_back({static_cast<int>(e),
                     placed.pose.apply(p),
                     placed.pose.apply(q),
                     {r * solid.faces()[edge.face0].normal, r * solid.faces()[edge.face1].normal}});
  }
  return found;
}

/// Angles about the ridges, from `low` to `high`.
struct Room {
  double low, high;
  double width() const { return high - low; }
  double middle() const { return 0.5 * (low + high); }
};

/// What two ridges allow: directions that leave the second's body and, turned round, the first's.
struct Fan {
  Vec3 u, v;  // angle 0 and a right angle on
  Room second, first, both;

  Vec3 direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * v; }
  /// Whether a face of the one lies nearly along a face of the other.
  bool is_aligned() const {
    for (const double a : {first.low, first.high})
      for (const double b : {second.low, second.high})
        if (std::abs(a - b) < kLeastRoom) return true;
    return false;
  }
};

Fan fan_of(const Ridge& first, const Ridge& second, const Vec3& along) {
  Fan fan;
  fan.u = (second.normals[0] + second.normals[1]).normalized();  // the middle of the second's
  fan.v = along.cross(fan.u).normalized();
  const auto angle = [&](const Vec3& n) { return std::atan2(n.dot(fan.v), n.dot(fan.u)); };
  const auto half = [](const Ridge& r) {
    return 0.5 * std::acos(std::clamp(r.normals[0].dot(r.normals[1]), -1.0, 1.0));
  };
  const double middle = angle(-first.normals[0] - first.normals[1]);
  fan.second = {-half(second), half(second)};
  fan.first = {middle - half(first), middle + half(first)};
  fan.both = {std::max(fan.first.low, fan.second.low), std::min(fan.first.high, fan.second.high)};
  return fan;
}

std::vector<Candidate> along_both(const Ridge& first, const Ridge& second, const Vec3& along, const Vec3& normal) {
  const auto place = [&](const Vec3& x) { return along.dot(x - second.from); };
  const double a0 = place(first.from), a1 = place(first.to), b0 = place(second.from), b1 = place(second.to);
  const double low = std::max(std::min(a0, a1), std::min(b0, b1)), high = std::min(std::max(a0, a1), std::max(b0, b1));
  std::vector<Candidate> ends;
  if (!(low < high)) return ends;
  for (const double at : {low, high}) {
    Candidate c;
    c.normal = normal;
    c.point_first = first.from + (at - a0) / (a1 - a0) * (first.to - first.from);
    c.point_second = second.from + (at - b0) / (b1 - b0) * (second.to - second.from);
    c.kind_first = c.kind_second = Feature::edge;
    const int number = at == low ? 0 : 1;
    c.index_first = kRidge + 2 * first.edge + number;
    c.index_second = kRidge + 2 * second.edge + number;
    ends.push_back(c);
  }
  return ends;
}

}  // namespace

double ridge_tolerance(double size_first, double size_second) { return kPlace * std::min(size_first, size_second); }

std::vector<Candidate> ridge_contacts(const ContactSink& sink, const PlacedPolyhedron& first,
                                      const PlacedPolyhedron& second, const Vec3& toward_first) {
  const double near = ridge_tolerance(first.solid.size(), second.solid.size());
  const std::vector<Ridge> of_second = foremost(second, toward_first, near);
  if (of_second.empty()) return {};
  for (const Ridge& a : foremost(first, -toward_first, near))
    for (const Ridge& b : of_second) {
      const Vec3 d = (a.to - a.from).normalized(), along = (b.to - b.from).normalized();
      if (d.cross(along).norm() > kParallel) continue;
      const Vec3 offset = a.from - b.from;
      if ((offset - along.dot(offset) * along).norm() > near) continue;
      const Fan fan = fan_of(a, b, along);
      if (fan.both.width() < kLeastRoom) continue;
      // What slides passes edge over edge without being held by it, as over the joints of a floor. There faces lie along
      // faces; bodies that lean stand at an angle, or don't move.
      const Vec3 apart = sink.first().velocity_at(a.from) - sink.second().velocity_at(a.from);
      const double shift = (apart - along.dot(apart) * along).norm() * sink.query().time_step;
      if (shift > (fan.is_aligned() ? near : std::max(near, sink.query().activation))) continue;
      return along_both(a, b, along, fan.direction(fan.both.middle()));
    }
  return {};
}

}  // namespace impinge
