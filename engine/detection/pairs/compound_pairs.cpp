#include "engine/detection/pairs/compound_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "engine/detection/pairs/contact_sink.hpp"

namespace impinge {
namespace {

constexpr double kSamePlace = 1e-9;  // of the smaller body: contacts nearer than this are one
constexpr double kSeam = 1e3;        // times that: parts nearer than this are joined

/// The parts of a collider as colliders; itself if it is no compound.
std::vector<Collider> parts_of(const Collider& whole) {
  const std::vector<ShapePart>* parts = whole.shape->parts();
  if (parts == nullptr) return {whole};
  std::vector<Collider> list;
  for (const ShapePart& part : *parts) {
    Collider c = whole;
    c.shape = part.shape.get();
    c.pose = {whole.pose.rotation * part.pose.rotation, whole.pose.apply(part.pose.position)};
    c.bounds = c.shape->bounds(c.pose);
    c.velocity = whole.velocity_at(c.pose.position);
    list.push_back(c);
  }
  return list;
}

/// Half of a feature key with the part's number in the ten highest bits of its index: parts are fewer than 1,024, and
/// features beyond a million of one part may share a name, which costs a warm start.
std::uint64_t with_part(std::uint64_t half, std::size_t part) {
  return (half & ~std::uint64_t{0x3ff00000}) | (static_cast<std::uint64_t>(part) & 0x3ffu) << 20;
}

/// Whether the place on part `own` that is nearest to a point outside, `gap` away, is no local minimum of the point's
/// distance to the compound: it belongs to another part as well, which is convex and nearer to the point.
bool is_seam(const Vec3& place, const Vec3& point, double gap, std::size_t own, const std::vector<Collider>& parts,
             double tie) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k == own || !overlap(parts[k].bounds.inflated(kSeam * tie), Aabb{place, place})) continue;
    const auto distance = [&](const Vec3& x) {
      return parts[k].shape->signed_distance(parts[k].pose.apply_inverse(x));
    };
    if (distance(place) <= kSeam * tie && distance(point) < gap - tie) return true;
  }
  return false;
}

}  // namespace

void compound_contacts(std::span<const Collider> colliders, const BodyPair& pair, const ContactQuery& query,
                       std::vector<Collision>& contacts) {
  const Collider &a = colliders[pair.a], &b = colliders[pair.b];
  const bool many_a = a.shape->parts() != nullptr, many_b = b.shape->parts() != nullptr;
  const std::vector<Collider> parts_a = parts_of(a), parts_b = parts_of(b);
  const double reach = ContactSink(colliders, pair, false, query, contacts).reach();
  const auto extent = [](const Collider& c) {
    const double size = c.bounds.extent().norm();
    return std::isfinite(size) ? size : 1e300;
  };
  const double tie = kSamePlace * std::min(extent(a), extent(b));
  const std::size_t begin = contacts.size();
  std::vector<Collision> found;
  for (std::size_t i = 0; i < parts_a.size(); ++i)
    for (std::size_t j = 0; j < parts_b.size(); ++j) {
      if (!overlap(parts_a[i].bounds.inflated(reach), parts_b[j].bounds)) continue;
      const Collider local[2] = {parts_a[i], parts_b[j]};
      found.clear();
      primitive_contacts(local, {BodyIndex(0), BodyIndex(1), pair.margin}, query, found);
      for (Collision& c : found) {
        if (c.gap > 0.0 && ((many_b && is_seam(c.point_b, c.point_a, c.gap, j, parts_b, tie)) ||
                            (many_a && is_seam(c.point_a, c.point_b, c.gap, i, parts_a, tie))))
          continue;
        const auto is_same = [&](const Collision& k) {
          return k.normal.dot(c.normal) > 1.0 - 1e-9 && (k.point_a - c.point_a).norm() <= tie &&
                 (k.point_b - c.point_b).norm() <= tie;
        };
        if (std::any_of(contacts.begin() + static_cast<std::ptrdiff_t>(begin), contacts.end(), is_same)) continue;
        c.body_a = pair.a;
        c.body_b = pair.b;
        if (!c.normal_owner.is_none()) c.normal_owner = c.normal_owner == BodyIndex(0) ? pair.a : pair.b;
        const std::uint64_t high = c.feature >> 32, low = c.feature & 0xffffffffu;
        c.feature = (many_a ? with_part(high, i) : high) << 32 | (many_b ? with_part(low, j) : low);
        contacts.push_back(c);
      }
    }
}

}  // namespace impinge
