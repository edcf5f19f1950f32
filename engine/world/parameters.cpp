#include "engine/world/parameters.hpp"

#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/integrators/integrator.hpp"
#include "engine/lcp/lcp_solver.hpp"
#include "engine/response/response.hpp"

namespace impinge {
namespace {

template <class Interface>
std::vector<std::string> names_of(const Registry<Interface>& registry) {
  std::vector<std::string> names;
  for (const auto& e : registry) names.emplace_back(e.name);
  return names;
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names = names_of(linear_solvers());
  names.insert(names.begin(), "automatic");
  return names;
}

}  // namespace

void Parameters::bind(ParameterSet& set) {
  set.add("simulation.frame_time", simulation.frame_time, {1e-6, 10.0, true}, "s",
          "Length of a frame; a sub-step is frame_time / substeps.");
  set.add("simulation.substeps", simulation.substeps, {1, 1000, true}, "", "Sub-steps of a frame.");
  set.add("simulation.gravity", simulation.gravity, {-1e4, 1e4}, "m/s²", "Acceleration of every dynamic body.");
  set.add("simulation.integrator", simulation.integrator, names_of(integrators()),
          "Time integration of deformable bodies; all are alike for rigid ones, where A = M.");
  set.add("simulation.linear_solver", simulation.linear_solver, solver_names(),
          "Solver of a deformable body's system; automatic: by size and right-hand sides.");
  set.add("simulation.sleeping", simulation.sleeping,
          "Whether groups at rest are put to sleep: they cost nothing, and have no contacts in figures and pictures, "
          "until they are touched.");
  set.add("simulation.sleep_speed", simulation.sleep_speed, {0.0, 10.0, true}, "m/s",
          "A body whose every point is slower than this counts as resting.");
  set.add("simulation.sleep_time", simulation.sleep_time, {0.0, 1000.0}, "s",
          "How long a whole group must rest before it sleeps.");
  set.add("contact.points", contact.points, {"intersection", "proximity"},
          "Where contacts come from: triangles that intersect already, or features closer than activation_distance.");
  set.add("contact.activation_distance", contact.activation_distance, {0.0, 1e3, true}, "m",
          "Features closer than this are contacts (proximity).");
  set.add("contact.friction", contact.friction, {0.0, 100.0}, "",
          "Coulomb coefficient of bodies that name none; a pair has the geometric mean.");
  set.add("contact.restitution", contact.restitution, {0.0, 1.0}, "",
          "Restitution of bodies that name none; a pair has the larger.");
  set.add("contact.restitution_threshold", contact.restitution_threshold, {0.0, 1e3, true}, "m/s",
          "Slower impacts do not bounce.");
  set.add("contact.max_push_out", contact.max_push_out, {0.0, 1e6, true}, "m/s",
          "Fastest recovery from overlap that exists already.");
  set.add("contact.push_out", contact.push_out, {"split", "velocity"},
          "Recovery from overlap changes positions only (split), or velocities too, as in the seed (velocity).");
  set.add("contact.warm_start", contact.warm_start, "Whether a contact starts from its impulse of the last sub-step.");
  set.add("broad_phase.method", broad_phase.method, names_of(broad_phases()), "Which bodies may touch.");
  set.add("narrow_phase.method", narrow_phase.method, names_of(narrow_phases()),
          "Which triangles of two meshes touch.");
  set.add("response.method", response.method, names_of(responses()), "How contacts change velocities.");
  set.add("response.form", response.form, {"accelerated", "seed"},
          "iterative_constraint_anticipation: the convergent form, or the one that the seed prints.");
  set.add("response.stop", response.stop, {"residual", "change"},
          "Its stop rule: a true residual (lcp.tolerance), or the seed's change of less than 5 %.");
  set.add("response.max_iterations", response.max_iterations, {1, 1000000, true}, "",
          "Its outer iterations at most for a group and sub-step.");
  set.add("response.impulse_iterations", response.impulse_iterations, {1, 1000000, true}, "",
          "sequential_impulse, simultaneous_impulse: sweeps at most for a group and sub-step.");
  set.add("response.penalty_form", response.penalty_form, {"implicit", "explicit"},
          "penalty: forces of the end of the sub-step (implicit), or of its start, stable for short sub-steps only "
          "(explicit).");
  set.add("response.penalty_stiffness", response.penalty_stiffness, {0.0, 1e15}, "N/m",
          "penalty: spring of each contact; 0: by the mass that the contact feels and the sub-step.");
  set.add("response.penalty_damping", response.penalty_damping, {0.0, 1e15}, "N·s/m",
          "penalty: damper of each contact; 0 beside an automatic stiffness: critical damping.");
  set.add("response.penalty_slip_speed", response.penalty_slip_speed, {0.0, 1e3, true}, "m/s",
          "penalty: friction is full from this sliding speed on, and less below it.");
  set.add("response.soft_frequency", response.soft_frequency, {0.0, 1e6, true}, "Hz",
          "soft_constraint: of each contact's spring; at most a quarter of the sub-steps' rate is used.");
  set.add("response.soft_damping_ratio", response.soft_damping_ratio, {0.0, 1e6}, "",
          "soft_constraint: of each contact's spring, 1 is critical.");
  set.add("response.soft_iterations", response.soft_iterations, {1, 1000000, true}, "",
          "soft_constraint: sweeps for a group and sub-step.");
  set.add(
      "response.soft_relax_iterations", response.soft_relax_iterations, {0, 1000000}, "",
      "soft_constraint: sweeps after the positions, which take out the velocity that recovery from overlap brought.");
  set.add("lcp.method", lcp.method, names_of(lcp_solvers()), "Solver of the cone complementarity problem.");
  set.add("lcp.tolerance", lcp.tolerance, {1e-15, 1.0, true}, "",
          "Natural-map residual to reach, relative to the largest right-hand side.");
  set.add("lcp.max_iterations", lcp.max_iterations, {0, 10000000, true}, "",
          "Sweeps at most for a group and sub-step.");
}

}  // namespace impinge
