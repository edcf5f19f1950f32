#include "engine/shapes/primitives.hpp"
#include "viewer/layers/layer.hpp"

namespace impinge {

Camera fitted_camera(const StepRecord& record, const Camera& like, const std::string& followed, double aspect) {
  Camera camera;
  camera.up = like.up;
  camera.fov_deg = like.fov_deg;
  camera.look_at({0.55, 0.42, 1.0}, Vec3::Zero());
  Aabb box;
  for (const BodyRecord& body : record.bodies) {
    if (followed.empty() || body.name != followed || body.bounds.is_empty()) continue;
    // what it passes is to be seen as well
    const Vec3 middle = body.bounds.center(), half = 1.5 * body.bounds.extent();
    camera.fit(Aabb{middle - half, middle + half}, aspect);
    return camera;
  }
  for (const BodyRecord& body : record.bodies)
    if (body.kind != BodyKind::fixed) box.include(body.bounds);
  if (!box.is_empty()) {
    const Vec3 middle = box.center();
    const Aabb moving = box;
    for (const BodyRecord& body : record.bodies) {
      if (body.kind != BodyKind::fixed) continue;
      if (const auto* plane = body.shape->as<Plane>()) {
        // where they would land
        const Vec3 n = body.pose.rotation * plane->normal;
        const double height = n.dot(middle - body.pose.position) - plane->offset;
        if (n.dot(record.gravity) < 0.0 && height > 0.0) box.include(Vec3(middle - height * n));
      } else if (!body.bounds.is_empty() && body.bounds.extent().norm() < 4.0 * moving.extent().norm()) {
        box.include(body.bounds);
      }
    }
  } else {
    for (const BodyRecord& body : record.bodies)
      if (body.shape->as<Plane>() == nullptr) box.include(body.bounds);
  }
  if (box.is_empty()) return like;
  camera.fit(box, aspect);
  return camera;
}

}  // namespace impinge
