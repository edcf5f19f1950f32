#include "engine/bodies/crushed.hpp"

#include "engine/bodies/deformable_body.hpp"
#include "engine/geometry/svd3.hpp"

namespace impinge {

std::vector<CrushedBody> find_crushed(const Bodies& bodies) {
  std::vector<CrushedBody> found;
  for (const Body& body : bodies) {
    const auto* soft = body.as<DeformableBody>();
    if (soft == nullptr) continue;
    CrushedBody crushed{body.name, soft->model, soft->fem.elements().size()};
    for (std::size_t e = 0; e < crushed.elements; ++e) {
      Corners x;
      for (int k = 0; k < 4; ++k) x.col(k) = soft->position.segment<3>(3 * soft->fem.rest().tets[e][k]);
      const Mat3 f = deformation_gradient(soft->fem.elements()[e], x);
      const double limit = soft->fem.material(static_cast<int>(e)).collapse_stretch();
      if (!(f.determinant() > 0.0)) {
        ++crushed.inverted;
      } else if (limit > 0.0 && rotation_svd(f).sigma.minCoeff() < limit) {
        ++crushed.collapsed;
        crushed.stretch = limit;
      }
    }
    if (crushed.inverted + crushed.collapsed > 0) found.push_back(crushed);
  }
  return found;
}

}  // namespace impinge
