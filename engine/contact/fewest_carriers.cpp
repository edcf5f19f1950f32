#include "engine/contact/fewest_carriers.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

namespace impinge {
namespace {

constexpr std::size_t kNumbers = 6;  // of a force and a torque
constexpr double kDependent = 1e-9;  // of the largest singular value: impulses that make up for each other

using Wrench = Eigen::Matrix<double, 6, 1>;

/// Force, and torque about the middle by the points' reach, so that both count alike.
std::vector<Wrench> wrenches(std::span<const CarriedImpulse> impulses) {
  Vec3 middle = Vec3::Zero();
  for (const CarriedImpulse& c : impulses) middle += c.point / static_cast<double>(impulses.size());
  double reach = 0.0;
  for (const CarriedImpulse& c : impulses) reach = std::max(reach, (c.point - middle).norm());
  const double per_metre = reach > 0.0 ? 1.0 / reach : 0.0;
  std::vector<Wrench> all;
  for (const CarriedImpulse& c : impulses)
    all.emplace_back((Wrench() << c.impulse, per_metre * (c.point - middle).cross(c.impulse)).finished());
  return all;
}

}  // namespace

std::vector<double> fewer_carriers(std::span<const CarriedImpulse> impulses, std::size_t most) {
  const std::vector<Wrench> wrench = wrenches(impulses);
  std::vector<double> share(impulses.size(), 1.0);
  std::vector<std::size_t> carry(impulses.size());
  std::iota(carry.begin(), carry.end(), std::size_t{0});
  while (carry.size() > std::max(most, std::size_t{1})) {
    std::stable_sort(carry.begin(), carry.end(), [&](std::size_t l, std::size_t r) {
      return share[l] * impulses[l].impulse.norm() < share[r] * impulses[r].impulse.norm();
    });
    const std::size_t n = std::min(carry.size(), kNumbers + 1);  // so many depend on each other
    Eigen::MatrixXd columns(kNumbers, n);
    for (std::size_t k = 0; k < n; ++k) columns.col(static_cast<Eigen::Index>(k)) = share[carry[k]] * wrench[carry[k]];
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(columns, Eigen::ComputeFullV);
    const VecX& sizes = svd.singularValues();
    if (n <= kNumbers && sizes[sizes.size() - 1] > kDependent * sizes[0]) break;
    // by what sums to nothing; the one that has most of it goes, so that no other grows to more than twice its size
    const VecX nothing = svd.matrixV().col(static_cast<Eigen::Index>(n) - 1);
    Eigen::Index out = 0;
    nothing.cwiseAbs().maxCoeff(&out);
    for (std::size_t k = 0; k < n; ++k) share[carry[k]] *= 1.0 - nothing[static_cast<Eigen::Index>(k)] / nothing[out];
    share[carry[static_cast<std::size_t>(out)]] = 0.0;
    carry.erase(carry.begin() + out);
  }
  return share;
}

}  // namespace impinge
