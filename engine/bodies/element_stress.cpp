#include "engine/bodies/element_stress.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/parallel.hpp"
#include "engine/elements/quadratic_elements.hpp"
#include "engine/geometry/svd3.hpp"

namespace impinge {
namespace {

constexpr std::size_t kElementsPerTask = 64;

Corners corners_of(const DeformableBody& body, int element) {
  const Tet& tet = body.fem.rest().tets[element];
  Corners x;
  for (int k = 0; k < 4; ++k) x.col(k) = body.position.segment<3>(3 * tet[k]);
  return x;
}

template <class Value>
std::vector<double> of_each(const DeformableBody& body, Value&& value) {
  std::vector<double> result(body.fem.elements().size());
  parallel_for(result.size(), kElementsPerTask, [&](std::size_t e) { result[e] = value(static_cast<int>(e)); });
  return result;
}

}  // namespace

ElementState element_state(const DeformableBody& body, int element) {
  const TetRest& rest = body.fem.elements()[element];
  const Corners x = corners_of(body, element);
  const Mat3 f = deformation_gradient(rest, x);
  ElementState state;
  state.volume_ratio = f.determinant();
  state.stretch = rotation_svd(f).sigma;
  state.stress.setZero();
  for (const ElementPoint& point : body.fem.stress_points(element, body.position)) {
    ElementResponse response;
    body.fem.material(element).force(point.rest, point.x, response);
    // the forces of an element add up to nothing, so the origin doesn't matter but for rounding: take it near
    const Corners arm = point.x.colwise() - Vec3(point.x.col(0));
    const Mat3 virial = response.force * arm.transpose();
    const double ratio = deformation_gradient(point.rest, point.x).determinant();
    const double volume = point.rest.volume * std::max(std::abs(ratio), 0.01);
    state.stress -= 0.5 / volume * (virial + virial.transpose());
  }
  return state;
}

double von_mises(const Mat3& stress) {
  const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

double equivalent_strain(const Vec3& stretch) {
  return std::sqrt(2.0 / 3.0) * (stretch.array() - stretch.mean()).matrix().norm();
}

std::vector<double> element_von_mises(const DeformableBody& body) {
  return of_each(body, [&](int e) { return von_mises(element_state(body, e).stress); });
}

std::vector<double> element_mean_stress(const DeformableBody& body) {
  return of_each(body, [&](int e) { return element_state(body, e).stress.trace() / 3.0; });
}

std::vector<double> element_equivalent_strain(const DeformableBody& body) {
  return of_each(body, [&](int e) {
    return equivalent_strain(rotation_svd(deformation_gradient(body.fem.elements()[e], corners_of(body, e))).sigma);
  });
}

std::vector<double> element_volume_ratio(const DeformableBody& body) {
  return of_each(
      body, [&](int e) { return deformation_gradient(body.fem.elements()[e], corners_of(body, e)).determinant(); });
}

std::vector<double> node_average(const DeformableBody& body, const std::vector<double>& of_elements) {
  const std::vector<TetRest>& elements = body.fem.elements();
  IMPINGE_ASSERT(of_elements.size() == elements.size());
  std::vector<double> sum(body.nodes(), 0.0), weight(body.nodes(), 0.0);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int node : body.fem.rest().tets[e]) {
      sum[node] += elements[e].volume * of_elements[e];
      weight[node] += elements[e].volume;
    }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= weight[i];
  return sum;
}

}  // namespace impinge
