// What a closed triangle surface encloses.
#include <algorithm>
#include <mutex>

#include "engine/geometry/inside.hpp"
#include "engine/shapes/shape_entry.hpp"

namespace impinge {
namespace {

class MeshShape final : public Shape {
 public:
  explicit MeshShape(MeshPointer surface)
      : Shape("mesh", surface.get()), surface_(std::move(surface)), centered_(std::make_shared<Centered>()) {}

  ShapeForm form() const override { return surface_.get(); }
  Aabb bounds(const Pose& pose) const override {
    Aabb box;
    for (const Vec3& v : surface_->mesh.vertices) box.include(pose.apply(v));
    return box;
  }
  double bounding_radius() const override {
    return reach_.get([&] {
      double reach = 0.0;
      for (const Vec3& v : surface_->mesh.vertices) reach = std::max(reach, v.norm());
      return reach;
    });
  }
  MassProperties mass(double density) const override { return mesh_mass(surface_->shown().mesh, density); }
  SharedShape recentered(const Vec3& center) const override {
    // all bodies of one mesh share the moved one too
    const std::lock_guard lock(centered_->mutex);
    if (!centered_->shape || centered_->center != center) {
      const auto moved = std::make_shared<SurfaceMesh>(shifted(*surface_, center));
      if (surface_->full != nullptr) moved->full = std::make_shared<SurfaceMesh>(shifted(*surface_->full, center));
      centered_->shape = MeshPointer(moved);
      centered_->center = center;
    }
    return centered_->shape;
  }
  double signed_distance(const Vec3& x) const override {
    const double distance = distance_to_surface(x, surface_->mesh.vertices, surface_->mesh.triangles);
    return winding_number(x, surface_->mesh.vertices, surface_->mesh.triangles) > 0.5 ? -distance : distance;
  }
  TriangleMesh surface(double) const override { return surface_->mesh; }
  TriangleMesh drawn() const override { return surface_->shown().mesh; }

 private:
  static SurfaceMesh shifted(SurfaceMesh surface, const Vec3& center) {
    for (Vec3& v : surface.mesh.vertices) v -= center;
    return surface;
  }

  struct Centered {
    std::mutex mutex;
    Vec3 center = Vec3::Zero();
    SharedShape shape;
  };
  MeshPointer surface_;
  Lazily<double> reach_;
  std::shared_ptr<Centered> centered_;
};

}  // namespace

SharedShape::SharedShape(MeshPointer surface) : SharedShape(MeshShape(std::move(surface))) {}

ShapeEntry mesh_shape() {
  return {"mesh", "What a closed triangle surface encloses: the body's key `surface`.", {}, nullptr};
}

}  // namespace impinge
