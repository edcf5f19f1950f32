// Any convex solid against a half-space and against any other convex solid.
#include <algorithm>
#include <cmath>

#include "engine/detection/pairs/convex_manifold.hpp"
#include "engine/detection/pairs/primitive_pairs.hpp"
#include "engine/detection/pairs/ridge_contacts.hpp"

namespace impinge {
namespace {

PlacedConvex placed(const Collider& c) { return {std::get<const ConvexSet*>(c.shape->form()), c.pose}; }

}  // namespace

void convex_convex(ContactSink& sink) {
  const PlacedConvex first = placed(sink.first()), second = placed(sink.second());
  std::vector<Candidate> found = convex_candidates(first, second, sink.reach());
  const ConvexPolyhedron *a = first.set->polyhedron(), *b = second.set->polyhedron();
  if (!found.empty() && a != nullptr && b != nullptr) {
    const Candidate& lowest = *std::min_element(found.begin(), found.end(),
                                                [](const auto& l, const auto& r) { return gap_of(l) < gap_of(r); });
    if (std::abs(gap_of(lowest)) <= ridge_tolerance(a->size(), b->size())) {
      std::vector<Candidate> ridge = ridge_contacts(sink, {*a, first.pose}, {*b, second.pose}, lowest.normal);
      if (!ridge.empty()) found = std::move(ridge);
    }
  }
  for (const Candidate& c : found) sink.add_new(c);
}

void plane_convex(ContactSink& sink) {
  const WorldPlane plane = world_plane(sink.first());
  const PlacedConvex solid = placed(sink.second());
  const Vec3 down = solid.pose.rotation.transpose() * -plane.normal;
  const auto against = [&](const Vec3& x) {
    Candidate c;
    c.point_second = x;
    c.point_first = x - plane.normal * (plane.normal.dot(x) - plane.offset);
    c.normal = -plane.normal;
    c.owner = NormalOwner::first;
    return c;
  };
  const auto height = [&](const Candidate& c) { return plane.normal.dot(c.point_second) - plane.offset; };
  // the farthest point of all, wherever it lies
  const Candidate own = against(solid.pose.apply(solid.set->support(down) + solid.set->rounding() * down));
  if (height(own) > sink.reach()) return;
  const double size = sink.second().bounds.extent().norm();
  std::vector<Candidate> points;
  const auto add = [&](const Vec3& local, int vertex) {
    Candidate c = against(solid.pose.apply(local));
    c.kind_second = Feature::vertex;
    c.index_second = vertex;
    if (height(c) <= sink.reach()) points.push_back(c);
  };
  if (const ConvexPolyhedron* polyhedron = solid.set->polyhedron()) {
    // all of them, as of a mesh: what rolls on corners comes down on those that are next
    for (std::size_t v = 0; v < polyhedron->vertices().size(); ++v) add(polyhedron->vertices()[v], static_cast<int>(v));
  } else {
    const ContactFace face = solid.set->facing(down);
    for (int i = 0; i < face.count && face.count > 1; ++i) add(face.point[i], face.vertex[i]);
    reduce_candidates(points, solid.pose, 1e-6 * size);
  }
  double lowest = 1e300;
  for (const Candidate& c : points) lowest = std::min(lowest, height(c));
  if (lowest > height(own) + 1e-9 * size) points.push_back(own);
  for (const Candidate& c : points) sink.add_new(c);
}

}  // namespace impinge
