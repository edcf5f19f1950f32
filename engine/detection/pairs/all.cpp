// The pairs of shapes that have a test of their own, because a formula is exact or quick; one line each. Every other
// pair is tested by the forms of the two (primitive.cpp).
#include "engine/detection/pairs/primitive_pairs.hpp"

namespace impinge {

const std::vector<PairTest>& pair_tests() {
  static const std::vector<PairTest> list = {
      {"plane", "sphere", plane_sphere},       {"plane", "box", plane_box},
      {"plane", "capsule", plane_capsule},     {"sphere", "sphere", sphere_sphere},
      {"sphere", "box", sphere_box},           {"sphere", "capsule", sphere_capsule},
      {"sphere", "mesh", sphere_mesh},         {"box", "box", box_box},
      {"box", "capsule", box_capsule},         {"box", "mesh", box_mesh},
      {"capsule", "capsule", capsule_capsule}, {"capsule", "mesh", capsule_mesh},
  };
  return list;
}

}  // namespace impinge
