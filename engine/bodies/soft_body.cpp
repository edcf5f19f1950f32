#include "engine/bodies/soft_body.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.hpp"

namespace impinge {

bool NodeRegion::contains(int node, const Vec3& x) const {
  switch (kind) {
    case box:
      return (x.array() >= min.array()).all() && (x.array() <= max.array()).all();
    case sphere:
      return (x - center).norm() <= radius;
    case list:
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
  }
  return false;
}

Vec3 HeldRegion::at(std::size_t k, double time) const {
  if (motion.is_empty()) return start[k] + displacement;
  const Pose now = motion.at(time);
  return pivot + displacement + now.position + now.rotation * (start[k] - pivot);
}

void SoftBody::drive_held(double time, double h, double share) {
  for (HeldRegion& region : held) {
    const bool moved = region.is_moved();
    region.displacement =
        share >= 1.0 ? region.wanted : Vec3(region.displacement + share * (region.wanted - region.displacement));
    for (std::size_t k = 0; k < region.nodes.size(); ++k) {
      const Vec3 now = fem.position.segment<3>(3 * region.nodes[k]);
      fem.set_held_velocity(region.nodes[k], moved ? Vec3((region.at(k, time + h) - now) / h) : Vec3(Vec3::Zero()));
    }
  }
}

double SoftBody::fastest_node() const {
  double fastest = 0.0;
  for (int i = 0; i < fem.nodes(); ++i) fastest = std::max(fastest, fem.velocity.segment<3>(3 * i).norm());
  return fastest;
}

SoftBody make_soft_body(const SoftDescription& d, const Pose& file, const Vec3& velocity,
                        const Vec3& angular_velocity) {
  std::shared_ptr<Material> material = make_named(materials(), d.model);
  material->settings() = d.material;
  configure(*material, d.settings);
  SoftBody soft{DeformableBody(FemAssembly(d.mesh, {{material, d.density}}, d.mass, {}, d.fraction)),
                d.embedding,
                material,
                {},
                {},
                d.model};
  DeformableBody& fem = soft.fem;
  fem.damping = d.damping;
  for (int i = 0; i < fem.nodes(); ++i) fem.position.segment<3>(3 * i) = file.apply(d.mesh.vertices[i]);
  const Vec3 center = fem.center_of_mass();
  std::vector<int> held;
  std::vector<char> taken(fem.nodes(), 0);
  for (std::size_t r = 0; r < d.fixed.size(); ++r) {
    HeldRegion region;
    for (int i = 0; i < fem.nodes(); ++i) {
      const Vec3 x = fem.position.segment<3>(3 * i);
      if (taken[i] || !d.fixed[r].contains(i, x)) continue;  // a node belongs to the first region that holds it
      taken[i] = 1;
      region.nodes.push_back(i);
      region.start.push_back(x);
      region.pivot += x;
    }
    if (region.nodes.empty())
      throw InputError(fmt::format("region {} of fixed holds no node of the body; move or widen it", r));
    region.pivot /= static_cast<double>(region.nodes.size());
    if (!d.fixed[r].motion.empty()) region.motion = Motion(d.fixed[r].motion);
    held.insert(held.end(), region.nodes.begin(), region.nodes.end());
    soft.held.push_back(std::move(region));
  }
  for (int i = 0; i < fem.nodes(); ++i)
    fem.velocity.segment<3>(3 * i) = velocity + angular_velocity.cross(Vec3(fem.position.segment<3>(3 * i)) - center);
  fem.hold(held);
  return soft;
}

}  // namespace impinge
