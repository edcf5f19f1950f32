#include "viewer/study/deformable_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/algebra/linear_solver.hpp"
#include "engine/elements/quadratic_elements.hpp"
#include "engine/geometry/mass_properties.hpp"

namespace impinge {

namespace {

constexpr int kManyRightHandSides = 100;  // about what contact asks for; one is what a free body asks for

std::string solvers_of(const LinearSolverChoice& wanted, int dofs) {
  if (dofs == 0) return "none, since every node is held";
  if (!wanted.is_automatic()) return std::string(wanted.name());
  const std::string_view one = automatic_linear_solver(dofs, 1),
                         many = automatic_linear_solver(dofs, kManyRightHandSides);
  return one == many ? fmt::format("{}", one) : fmt::format("{}; {} where it touches something", one, many);
}

/// "+0.12 % of", and in other words what is as good as all of it or many times as much.
std::string share_text(double share) {
  constexpr double kNearlyAll = 5e-5, kMuchMore = 2.0;
  if (std::abs(share - 1.0) < kNearlyAll) return "as much as";
  if (share > kMuchMore) return fmt::format("{:.3g} times", share);
  return fmt::format("{:+.2f} % of", 100.0 * (share - 1.0));
}

}  // namespace

void print_deformable_bodies(const Session& session) {
  for (const Body& body : session.world().bodies()) {
    const auto* deformable = body.as<DeformableBody>();
    if (deformable == nullptr) continue;
    const DeformableBody& soft = *deformable;
    const FemAssembly& fem = soft.fem;
    const MaterialSettings& m = soft.material->settings();
    const int held = fem.nodes() - soft.free_nodes();
    double filled = 0.0;
    for (const TetRest& element : fem.elements()) filled += element.volume;
    const TriangleMesh& surface = body.shape->mesh()->mesh;
    const double enclosed = signed_volume(surface);
    const std::size_t outside = static_cast<std::size_t>(soft.embedding.outside);

    const bool is_quadratic = fem.element_kind() == ElementKind::quadratic;
    fmt::print("  {}: {} nodes, {} tetrahedra{}, smallest dihedral angle {:.1f} degrees\n", body.name, fem.nodes(),
               fem.rest().tets.size(),
               is_quadratic ? fmt::format(" (the parts of {} quadratic ones)", fem.rest().tets.size() / kTetParts) : "",
               smallest_dihedral_angle(fem.rest()));
    fmt::print("    freedom:  {} degrees free, {} held ({} nodes in {} regions)\n", soft.dofs(), 3 * held, held,
               soft.held.size());
    fmt::print(
        "    material: {}, young {} Pa, poisson {}, density {:.6g} kg/m^3, damping alpha {} 1/s, beta {} s, {} mass\n",
        soft.model, shortest(m.young), shortest(m.poisson), body.mass / filled, shortest(soft.damping.alpha),
        shortest(soft.damping.beta), fem.mass_kind() == MassKind::lumped ? "lumped" : "consistent");
    fmt::print("    volume:   {:.6g} m^3 filled ({} the surface's {:.6g} m^3), mass {:.6g} kg\n", filled,
               share_text(filled / enclosed), enclosed, body.mass);
    fmt::print("    solver:   {}\n", solvers_of(session.world().parameters.simulation.linear_solver, soft.dofs()));
    fmt::print("    surface:  {} vertices, {} triangles{}\n", surface.vertices.size(), surface.triangles.size(),
               outside > 0
                   ? fmt::format(", {} vertices outside of the volume, carried by the nearest tetrahedra", outside)
                   : "");
  }
  for (const SurfaceFile& file : session.scene().surfaces)
    for (const std::string& note : file.notes) fmt::print("  {}: {}\n", file.name, note);
}

std::size_t memory_of(const DeformableBody& body) {
  const FemAssembly& fem = body.fem;
  // an element keeps its rest data and its answer; the stiffness a block for each pair of neighbours, twice (all, free)
  const std::size_t answer = fem.element_kind() == ElementKind::quadratic
                                 ? (sizeof(QuadraticAnswer) + sizeof(TetRest) + sizeof(QuadraticTet)) / kTetParts
                                 : sizeof(ElementResponse);
  return fem.elements().size() * (sizeof(TetRest) + answer + sizeof(Tet)) + fem.block_mass().size() * 2 * sizeof(Mat3) +
         static_cast<std::size_t>(fem.nodes()) * 6 * sizeof(Vec3);
}

}  // namespace impinge
