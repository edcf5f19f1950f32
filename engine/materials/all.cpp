// The list of materials: one line each.
#include "engine/materials/material.hpp"

namespace impinge {

Entry<Material> linear_material();
Entry<Material> corotational_material();
Entry<Material> fixed_corotated_material();
Entry<Material> stvk_material();
Entry<Material> neo_hookean_material();
Entry<Material> mass_spring_material();

const Registry<Material>& materials() {
  static const Registry<Material> list = {linear_material(), corotational_material(), fixed_corotated_material(),
                                          stvk_material(),   neo_hookean_material(),  mass_spring_material()};
  return list;
}

}  // namespace impinge
