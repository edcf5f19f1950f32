#include "engine/bodies/soft_body.hpp"

#include <algorithm>

namespace impinge {

bool NodeRegion::contains(int node, const Vec3& x) const {
  switch (kind) {
    case box: return (x.array() >= min.array()).all() && (x.array() <= max.array()).all();
    case sphere: return (x - center).norm() <= radius;
    case list: return std::binary_search(nodes.begin(), nodes.end(), node);
  }
  return false;
}

SoftBody make_soft_body(const SoftDescription& d, const Pose& file, const Vec3& velocity, const Vec3& angular_velocity) {
  std::shared_ptr<Material> material = make_named(materials(), d.model);
  material->configure(d.material);
  SoftBody soft{DeformableBody(FemAssembly(d.mesh, {{material, d.density}}, d.mass, {}, d.fraction)), d.embedding, {}, 0.0};
  DeformableBody& fem = soft.fem;
  fem.damping = d.damping;
  for (int i = 0; i < fem.nodes(); ++i) fem.position.segment<3>(3 * i) = file.apply(d.mesh.vertices[i]);
  const Vec3 center = fem.center_of_mass();
  std::vector<int> held;
  for (int i = 0; i < fem.nodes(); ++i) {
    const Vec3 x = fem.position.segment<3>(3 * i);
    fem.velocity.segment<3>(3 * i) = velocity + angular_velocity.cross(x - center);
    soft.radius = std::max(soft.radius, (x - center).norm());
    if (std::any_of(d.fixed.begin(), d.fixed.end(), [&](const NodeRegion& r) { return r.contains(i, x); })) held.push_back(i);
  }
  fem.hold(held);
  return soft;
}

}  // namespace impinge
