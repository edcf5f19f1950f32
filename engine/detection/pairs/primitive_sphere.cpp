// Sphere against sphere, box and capsule: one contact each, along the line from the nearest point to the centre.
#include "engine/detection/pairs/primitive_pairs.hpp"

#include "engine/geometry/distance.hpp"

namespace impinge {

void sphere_sphere(ContactSink& sink) {
  const Vec3 &a = sink.first().pose.position, &b = sink.second().pose.position;
  const double radius_a = shape_of<Sphere>(sink.first()).radius, radius_b = shape_of<Sphere>(sink.second()).radius;
  Candidate c;
  const Vec3 offset = a - b;
  const double distance = offset.stableNorm();
  c.normal = distance > 0.0 ? offset.stableNormalized() : Vec3::UnitY();  // concentric: any direction is as good
  c.point_first = a - radius_a * c.normal;
  c.point_second = b + radius_b * c.normal;
  sink.add(c);
}

void sphere_box(ContactSink& sink) {
  const Vec3& center = sink.first().pose.position;
  const double radius = shape_of<Sphere>(sink.first()).radius;
  const NearestOnBox nearest = nearest_on_box(world_box(sink.second()), center);
  Candidate c;
  c.normal = nearest.normal;
  c.point_first = center - radius * nearest.normal;
  c.point_second = nearest.point;
  c.owner = nearest.beyond == 1 ? NormalOwner::second : NormalOwner::neither;
  sink.add(c);
}

void sphere_capsule(ContactSink& sink) {
  const Vec3& center = sink.first().pose.position;
  const double radius_a = shape_of<Sphere>(sink.first()).radius;
  const double radius_b = shape_of<Capsule>(sink.second()).radius;
  const WorldSegment axis = world_axis(sink.second());
  const Vec3 nearest = closest_on_segment(center, axis.p0, axis.p1).point;
  Candidate c;
  const Vec3 offset = center - nearest;
  // a centre on the axis, where the offset is rounding only, leaves across it in a direction that turns with the
  // capsule
  c.normal = offset.stableNorm() > 1e-12 * radius_b ? Vec3(offset.stableNormalized())
                                                    : Vec3(sink.second().pose.rotation.col(0));
  c.point_first = center - radius_a * c.normal;
  c.point_second = nearest + radius_b * c.normal;
  sink.add(c);
}

}  // namespace impinge
