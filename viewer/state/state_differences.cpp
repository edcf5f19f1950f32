#include "viewer/state/state_differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace impinge {
namespace {

void compare_vectors(const std::string& body, const char* field, const char* unit, const Vec3& a, const Vec3& b,
                     std::vector<FieldDifference>& out) {
  if (a != b) out.push_back({body, field, unit, (a - b).norm(), ""});
}

// node by node
void compare_nodes(const std::string& body, const char* field, const char* unit, const VecX& a, const VecX& b,
                   std::vector<FieldDifference>& out) {
  if (a.size() != b.size()) {
    out.push_back({body, fmt::format("number of nodes ({} and {})", a.size() / 3, b.size() / 3), "", 0.0, ""});
    return;
  }
  FieldDifference difference{body, field, unit, -1.0, ""};
  for (Eigen::Index i = 0; i + 2 < a.size(); i += 3) {
    const Vec3 p = a.segment<3>(i), q = b.segment<3>(i);
    if (p != q && (p - q).norm() > difference.largest)
      difference.largest = (p - q).norm(), difference.where = fmt::format("node {}", i / 3);
  }
  if (difference.largest >= 0.0) out.push_back(std::move(difference));
}

double angle_between(const Mat3& a, const Mat3& b) {
  // from the distance of the matrices: exact for small angles too
  return 2.0 * std::asin(std::min(1.0, (a - b).norm() / (2.0 * std::numbers::sqrt2))) * 180.0 / std::numbers::pi;
}

}  // namespace

std::vector<FieldDifference> field_differences(const StepRecord& a, const StepRecord& b) {
  std::vector<FieldDifference> out;
  for (const BodyRecord& p : a.bodies) {
    const auto it =
        std::find_if(b.bodies.begin(), b.bodies.end(), [&](const BodyRecord& body) { return body.name == p.name; });
    if (it == b.bodies.end()) continue;
    const BodyRecord& q = *it;
    const std::string name(p.name);
    if (p.kind != q.kind) {
      out.push_back({name, "kind", "", 0.0, ""});
      continue;
    }
    if (p.deformable != nullptr && q.deformable != nullptr) {
      compare_nodes(name, "position", "m", p.deformable->position, q.deformable->position, out);
      compare_nodes(name, "velocity", "m/s", p.deformable->velocity, q.deformable->velocity, out);
      continue;
    }
    compare_vectors(name, "position", "m", p.pose.position, q.pose.position, out);
    if (p.pose.rotation != q.pose.rotation)
      out.push_back({name, "rotation", "degrees", angle_between(p.pose.rotation, q.pose.rotation), ""});
    compare_vectors(name, "velocity", "m/s", p.velocity, q.velocity, out);
    compare_vectors(name, "angular velocity", "rad/s", p.angular_velocity, q.angular_velocity, out);
    if (p.asleep != q.asleep)
      out.push_back({name, p.asleep ? "sleep (asleep in A only)" : "sleep (asleep in B only)", "", 0.0, ""});
  }
  return out;
}

}  // namespace impinge
