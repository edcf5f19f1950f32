#include "engine/geometry/mass_properties.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "engine/geometry/aabb.hpp"

namespace impinge {
namespace {

constexpr double kPi = 3.14159265358979323846;

MassProperties diagonal(double mass, double xx, double yy, double zz) {
  MassProperties result;
  result.mass = mass;
  result.inertia.diagonal() = Vec3(xx, yy, zz);
  return result;
}

}  // namespace

Aabb bounds_of(const TriangleMesh& mesh) {
  Aabb box;
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) box.include(mesh.vertices[v]);
  return box;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0.0;
  const Vec3 origin = bounds_of(mesh).center();
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin, c = mesh.vertices[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

MassProperties mesh_mass(const TriangleMesh& mesh, double density) {
  MassProperties result;
  if (mesh.triangles.empty()) return result;
  // apex inside the bounding box: with the world origin a mesh 1e5 m away would lose ten digits to cancellation
  const Vec3 origin = bounds_of(mesh).center();
  double volume = 0.0;
  Vec3 moment = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin, c = mesh.vertices[t[2]] - origin;
    const double v = a.dot(b.cross(c)) / 6.0;
    volume += v;
    moment += 0.25 * v * (a + b + c);
  }
  result.mass = density * volume;
  result.center = origin;
  if (!(volume > 0.0)) return result;
  result.center = origin + moment / volume;

  // second pass about the centre of mass: no parallel-axis subtraction. The integral of x xᵀ over the tetrahedron
  // (0, a, b, c) of volume v is v/20 (s sᵀ + a aᵀ + b bᵀ + c cᵀ) with s = a + b + c.
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = (mesh.vertices[t[0]] - origin) - moment / volume;
    const Vec3 b = (mesh.vertices[t[1]] - origin) - moment / volume;
    const Vec3 c = (mesh.vertices[t[2]] - origin) - moment / volume;
    const Vec3 s = a + b + c;
    const double v = a.dot(b.cross(c)) / 6.0;
    second += (v / 20.0) * (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  result.inertia = density * (second.trace() * Mat3::Identity() - second);
  return result;
}

PrincipalInertia principal_inertia(const Mat3& inertia) {
  PrincipalInertia principal;
  if (inertia.isDiagonal(0.0)) {
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return inertia(a, a) < inertia(b, b); });
    for (int i = 0; i < 3; ++i) {
      principal.moments[i] = inertia(order[i], order[i]);
      principal.axes.col(i) = Vec3::Unit(order[i]);
    }
  } else {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    principal.moments = solver.eigenvalues().cwiseMax(1e-15 * solver.eigenvalues()[2]);
    principal.axes = solver.eigenvectors();
  }
  if (principal.axes.determinant() < 0.0) principal.axes.col(0) *= -1.0;
  return principal;
}

MassProperties sphere_mass(double radius, double density) {
  const double mass = density * (4.0 / 3.0) * kPi * radius * radius * radius;
  const double moment = 0.4 * mass * radius * radius;
  return diagonal(mass, moment, moment, moment);
}

MassProperties box_mass(const Vec3& half, double density) {
  const double mass = density * 8.0 * half.x() * half.y() * half.z();
  const Vec3 sq = half.cwiseAbs2();
  return diagonal(mass, mass / 3.0 * (sq.y() + sq.z()), mass / 3.0 * (sq.x() + sq.z()), mass / 3.0 * (sq.x() + sq.y()));
}

MassProperties capsule_mass(double radius, double half_length, double density) {
  const double r = radius, length = 2.0 * half_length;
  const double cylinder = density * kPi * r * r * length;
  const double caps = density * (4.0 / 3.0) * kPi * r * r * r;
  const double along = (0.5 * cylinder + 0.4 * caps) * r * r;
  // each half ball has its centre of mass 3r/8 beyond the end of the cylinder
  const double across = cylinder * (length * length / 12.0 + 0.25 * r * r) +
                        caps * (0.4 * r * r + 0.25 * length * length + 0.375 * length * r);
  return diagonal(cylinder + caps, across, along, across);
}

}  // namespace impinge
