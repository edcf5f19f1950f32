#include "engine/shapes/shape_mass.hpp"

namespace impinge {

MassProperties shape_mass(const Shape& shape, double density) {
  struct Mass {
    double density;
    MassProperties operator()(const Plane&) const { return {}; }
    MassProperties operator()(const Sphere& s) const { return sphere_mass(s.radius, density); }
    MassProperties operator()(const Box& b) const { return box_mass(b.half, density); }
    MassProperties operator()(const Capsule& c) const { return capsule_mass(c.radius, c.half_length, density); }
    MassProperties operator()(const MeshPointer& m) const { return mesh_mass(m->mesh, density); }
  };
  return std::visit(Mass{density}, shape);
}

}  // namespace impinge
