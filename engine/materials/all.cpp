// The list of materials: one line each.
#include "engine/materials/material.hpp"

namespace impinge {

const Registry<Material>& materials() {
  static const Registry<Material> list = [] {
    Registry<Material> all;
    IMPINGE_LIST(all, linear_material);
    IMPINGE_LIST(all, corotational_material);
    IMPINGE_LIST(all, fixed_corotated_material);
    IMPINGE_LIST(all, stvk_material);
    IMPINGE_LIST(all, neo_hookean_material);
    IMPINGE_LIST(all, mass_spring_material);
    return all;
  }();
  return list;
}

}  // namespace impinge
