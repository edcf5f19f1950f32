#include "engine/shapes/shape.hpp"

namespace impinge {

const char* shape_name(const Shape& shape) {
  static constexpr const char* kNames[] = {"plane", "sphere", "box", "capsule", "mesh"};
  return kNames[shape.index()];
}

MeshPointer make_box_mesh(const Vec3& half) {
  auto surface = std::make_shared<SurfaceMesh>();
  for (int i = 0; i < 8; ++i)
    surface->mesh.vertices.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(),
                                        (i & 4 ? 1 : -1) * half.z());
  surface->mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                             {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  surface->topology = make_topology(surface->mesh);
  return surface;
}

Aabb shape_bounds(const Shape& shape, const Pose& pose) {
  struct Bounds {
    const Pose& pose;
    Aabb operator()(const Plane& p) const {
      const double inf = std::numeric_limits<double>::infinity();
      Aabb box{Vec3::Constant(-inf), Vec3::Constant(inf)};
      // the half-space behind an axis-aligned plane has a bound on that side
      const Vec3 n = pose.rotation * p.normal;
      const double offset = p.offset + n.dot(pose.position);
      for (int k = 0; k < 3; ++k) {
        if (n[k] == 1.0) box.max[k] = offset;
        if (n[k] == -1.0) box.min[k] = -offset;
      }
      return box;
    }
    Aabb operator()(const Sphere& s) const {
      return {pose.position - Vec3::Constant(s.radius), pose.position + Vec3::Constant(s.radius)};
    }
    Aabb operator()(const Box& b) const {
      const Vec3 reach = pose.rotation.cwiseAbs() * b.half;
      return {pose.position - reach, pose.position + reach};
    }
    Aabb operator()(const Capsule& c) const {
      const Vec3 reach = (pose.rotation.col(1) * c.half_length).cwiseAbs() + Vec3::Constant(c.radius);
      return {pose.position - reach, pose.position + reach};
    }
    Aabb operator()(const MeshPointer& m) const {
      Aabb box;
      for (const Vec3& v : m->mesh.vertices) box.include(pose.apply(v));
      return box;
    }
  };
  return std::visit(Bounds{pose}, shape);
}

}  // namespace impinge
