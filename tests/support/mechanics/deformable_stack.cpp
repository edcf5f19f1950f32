#include "tests/support/mechanics/deformable_stack.hpp"

#include <algorithm>
#include <cmath>

namespace impinge::test {
namespace {

constexpr double kSize = 0.2, kShift = 0.01;

Vec3 corner_of(int level) { return {kShift * level, kSize * level, kShift * level}; }

/// The nodes that carry a point of a cube's lower or upper face, by the lattice square it lies in.
ContactSide side_at(const SoftStack& stack, int level, int cells, bool upper, double x, double z) {
  ContactSide side;
  side.deformable = level;
  const Vec3 corner = corner_of(level);
  const double u = std::clamp((x - corner.x()) / kSize * cells, 0.0, static_cast<double>(cells));
  const double v = std::clamp((z - corner.z()) / kSize * cells, 0.0, static_cast<double>(cells));
  const int i = std::min(static_cast<int>(u), cells - 1), k = std::min(static_cast<int>(v), cells - 1);
  const DeformableBody& body = *stack.bodies[level]->body;
  for (int c = 0; c < 4; ++c) {
    const int di = c & 1, dk = c >> 1;
    const double weight = (di ? u - i : 1.0 - u + i) * (dk ? v - k : 1.0 - v + k);
    const int node = ((k + dk) * (cells + 1) + (upper ? cells : 0)) * (cells + 1) + i + di;
    if (std::abs(weight) > 1e-12) side.nodes.push_back({body.free_index()[node], weight});
  }
  return side;
}

void add_contact(SoftStack& stack, ContactSide a, ContactSide b, double friction) {
  ContactRows rows;
  rows.a = std::move(a);
  rows.b = std::move(b);
  rows.directions.row(0) = Vec3::UnitY().transpose();  // from b to a
  rows.directions.row(1) = Vec3::UnitZ().transpose();
  rows.directions.row(2) = Vec3::UnitX().transpose();
  rows.friction = friction;
  stack.group.contacts.push_back(std::move(rows));
}

}  // namespace

SoftStack make_soft_stack(const StackOptions& o) {
  SoftStack stack;
  const auto scheme = find_entry(integrators(), "linearly_implicit_euler")->make();
  for (int level = 0; level < static_cast<int>(o.cells.size()); ++level) {
    std::shared_ptr<Material> material = find_entry(materials(), "corotational")->make();
    MaterialSettings settings;
    settings.young = o.young;
    settings.poisson = o.poisson;
    material->settings() = settings;
    TetMesh mesh = make_tet_box(Vec3::Constant(kSize), o.cells[level], o.cells[level], o.cells[level]);
    for (Vec3& v : mesh.vertices) v += corner_of(level);
    auto made = std::make_unique<SoftStack::Body>();
    made->body =
        std::make_unique<DeformableBody>(FemAssembly(std::move(mesh), {{material, o.density}}, MassKind::lumped));
    DeformableBody& body = *made->body;
    body.damping = {0.0, 0.001};
    for (int i = 0; i < body.nodes(); ++i) {
      const Vec3 x = body.position.segment<3>(3 * i);
      body.velocity.segment<3>(3 * i) = Vec3(0.3 + x.z(), -0.5 - 0.5 * x.x() + 0.2 * level, 0.1 - 2.0 * x.y());
    }
    made->solver = make_linear_solver("automatic", body.dofs(), 100);
    made->solver->analyze(*body.free_pattern());
    const auto first = make_linear_solver("simplicial_llt");
    first->analyze(*body.free_pattern());
    scheme->begin(body, {0, -9.81, 0}, o.time_step, made->step);
    scheme->free_velocity(body, made->step, *first);
    DeformableBlock block;
    block.a = &made->step.a;
    block.solver = made->solver.get();
    block.velocity = made->step.v_star;
    block.displacement_velocity = made->step.v_star;
    stack.group.deformable.push_back(std::move(block));
    stack.bodies.push_back(std::move(made));
  }
  const auto nodes_of = [&](int level, auto each) {
    const int n = o.cells[level];
    for (int k = 0; k <= n; ++k)
      for (int i = 0; i <= n; ++i) each(corner_of(level).x() + kSize * i / n, corner_of(level).z() + kSize * k / n);
  };
  nodes_of(0,
           [&](double x, double z) { add_contact(stack, side_at(stack, 0, o.cells[0], false, x, z), {}, o.friction); });
  for (int level = 1; level < static_cast<int>(o.cells.size()); ++level) {
    const auto add = [&](double x, double z) {
      const double low = kShift * level, high = kShift * (level - 1) + kSize;
      if (std::min(x, z) < low - 1e-12 || std::max(x, z) > high + 1e-12) return;
      add_contact(stack, side_at(stack, level, o.cells[level], false, x, z),
                  side_at(stack, level - 1, o.cells[level - 1], true, x, z), o.friction);
    };
    nodes_of(level, add);
    nodes_of(level - 1, add);
  }
  if (o.rigid_on_top) {
    const int top = static_cast<int>(o.cells.size()) - 1;
    const double mass = 5.0, half = 0.07;
    RigidBlock block;
    block.inverse_mass = 1.0 / mass;
    block.inverse_inertia = Mat3::Identity() * (6.0 / (mass * 4.0 * half * half));
    block.velocity = {0.2, -1.0, 0.1};
    block.angular_velocity = {0.5, 0.2, -0.3};
    stack.group.rigid.push_back(block);
    for (const double dx : {-half, half})
      for (const double dz : {-half, half}) {
        ContactSide side;
        side.rigid = 0;
        side.arm = {dx, -half, dz};
        const Vec3 middle = corner_of(top) + Vec3(0.5 * kSize, 0.0, 0.5 * kSize);
        add_contact(stack, side, side_at(stack, top, o.cells[top], true, middle.x() + dx, middle.z() + dz), o.friction);
      }
  }
  stack.group.lambda.assign(stack.group.contacts.size(), Vec3::Zero());
  stack.group.clear_delta();
  return stack;
}

}  // namespace impinge::test
