#include "engine/detection/continuous/convex_solids.hpp"

namespace impinge {

std::vector<PlacedConvex> convex_solids(const Shape& shape) {
  const ShapeForm form = shape.form();
  if (const auto* solid = std::get_if<const ConvexSet*>(&form)) return {{*solid, Pose()}};
  std::vector<PlacedConvex> solids;
  if (const std::vector<ShapePart>* parts = shape.parts())
    for (const ShapePart& part : *parts) solids.push_back({std::get<const ConvexSet*>(part.shape->form()), part.pose});
  return solids;
}

PlacedConvex placed(const PlacedConvex& solid, const Pose& pose) {
  return {solid.set, {pose.rotation * solid.pose.rotation, pose.apply(solid.pose.position)}};
}

Vec3 farthest(const PlacedConvex& solid, const Vec3& direction) {
  return solid.pose.apply(solid.set->support(solid.pose.rotation.transpose() * direction)) +
         solid.set->rounding() * direction;
}

Pose seen_from(const Pose& of, const Pose& pose) {
  return {of.rotation.transpose() * pose.rotation, of.rotation.transpose() * (pose.position - of.position)};
}

}  // namespace impinge
