#include "engine/world/parameters.hpp"

#include "engine/bodies/scale.hpp"

namespace impinge {
namespace {

const Words<Continuous> kContinuous = {
    {Continuous::when_needed, "auto"}, {Continuous::on, "on"}, {Continuous::off, "off"}};
const Words<VelocityTime> kVelocities = {{VelocityTime::end, "end"}, {VelocityTime::middle, "middle"}};

}  // namespace

void Parameters::bind(ParameterSet& set) {
  bind_model(set);
  Rows(set).below("record").add(
      "ledger", record.ledger,
      "Whether the books of energy and momentum are kept, by source and by body: ledger.csv and the panel ledger. It "
      "changes no state.");
}

void Parameters::bind_model(ParameterSet& set) {
  const Rows all(set), of_simulation = all.below("simulation"), of_lcp = all.below("lcp");
  of_simulation.add("frame_time", simulation.frame_time, {1e-6, 10.0, true}, "s",
                    "Length of a frame; a sub-step is frame_time / substeps.");
  of_simulation.add("substeps", simulation.substeps, {1, 1000, true}, "", "Sub-steps of a frame.");
  of_simulation.add("gravity", simulation.gravity, {-1e4, 1e4}, "m/s²", "Acceleration of every dynamic body.");
  of_simulation.add("integrator", simulation.integrator,
                    "Time integration of deformable bodies; all are alike for rigid ones, where A = M.");
  of_simulation.add(
      "velocities", simulation.velocities, kVelocities,
      "What the velocities that a sub-step finds are taken for: those of its end (symplectic Euler, of "
      "first order), or of its middle (leapfrog: rigid bodies, and deformable ones with symplectic_euler, "
      "move to second order; the first sub-step gives half of the forces).");
  of_simulation.add("linear_solver", simulation.linear_solver,
                    "Solver of a deformable body's system; automatic: by size and right-hand sides.");
  of_simulation.add("sleeping", simulation.sleeping,
                    "Whether groups at rest are put to sleep: they cost nothing, and have no contacts in figures and "
                    "pictures, until they are touched.");
  of_simulation.add("sleep_speed", simulation.sleep_speed, {0.0, 10.0, true}, "m/s",
                    "A body whose every point is slower than this counts as resting; auto: 4.9e-5 √(g·size).");
  of_simulation.add("sleep_time", simulation.sleep_time, {0.0, 1000.0}, "s",
                    "How long a whole group must rest before it sleeps; auto: 2.4 √(size/g) of each body.");
  simulation.integrator.declare(all.below("integrator"));
  contact.declare(all.below("contact"));
  all.below("broad_phase").add("method", broad_phase.method, "Which bodies may touch.");
  broad_phase.method.declare(all.below("broad_phase"));
  all.below("narrow_phase").add("method", narrow_phase.method, "Which triangles of two meshes touch.");
  narrow_phase.method.declare(all.below("narrow_phase"));
  all.below("narrow_phase")
      .add(
          "continuous", narrow_phase.continuous, kContinuous,
          "Whether surfaces are kept from passing through one another between sub-steps: where they approach by more "
          "than the search for contacts reaches, and wherever a body with self_collision moves (auto), always (on), or "
          "never (off).");
  all.below("response").add("method", response.method, "How contacts change velocities.");
  response.method.declare(all.below("response"));
  of_lcp.add("method", lcp.method, "Solver of the cone complementarity problem.");
  of_lcp.add("tolerance", lcp.tolerance, {1e-15, 1.0, true}, "",
             "Natural-map residual to reach, relative to the largest right-hand side.");
  of_lcp.add("max_iterations", lcp.max_iterations, {0, 10000000, true}, "",
             "Iterations of the solver at most for a group and sub-step.");
  lcp.method.declare(of_lcp);
}

void take_settings(std::span<const RowText> values, Parameters& parameters) {
  ParameterSet rows;
  parameters.bind(rows);
  const auto take = [&](std::string_view path, const std::string& value) {
    if (const Parameter* row = rows.find(path)) row->set(parse_value(*row, value));
  };
  for (const auto& [path, value] : values)
    if (const std::vector<std::string>* renamed = rows.renamed(path))
      for (const std::string& present : *renamed) take(present, value);
    else
      take(path, value);
}

LcpSettings lcp_settings(const Parameters& p) { return {p.lcp.tolerance, p.lcp.max_iterations}; }

ResponseContext response_context(const Parameters& p) {
  ResponseContext context;
  context.lcp = lcp_settings(p);
  context.time_step = p.simulation.time_step();
  context.max_push_out = p.contact.max_push_out;
  context.restitution_threshold = p.contact.restitution_threshold;
  context.gravity = p.simulation.gravity;
  return context;
}

TimeIntegration time_integration(const Parameters& p) {
  return {*p.simulation.integrator, p.simulation.linear_solver, p.simulation.gravity, p.simulation.time_step(),
          p.simulation.velocities};
}

Continuous watching(const Parameters& p) {
  const bool is_up_to_method = p.narrow_phase.continuous == Continuous::when_needed;
  return is_up_to_method && p.narrow_phase.method->watches_every_motion() ? Continuous::on : p.narrow_phase.continuous;
}

Detecting detecting(const Parameters& p) {
  const Response& response = *p.response.method;
  const bool looks_ahead = watching(p) != Continuous::off;
  return {p.contact,
          *p.broad_phase.method,
          *p.narrow_phase.method,
          response.is_approximate() && !response.lives_on_overlap(),
          looks_ahead,
          looks_ahead && !response.is_approximate(),
          p.simulation.gravity};
}

Solving solving(const Parameters& p) {
  return {*p.response.method,       *p.lcp.method,
          response_context(p),      p.contact,
          *p.simulation.integrator, scale_gravity(p.simulation.gravity),
          p.simulation.velocities};
}

}  // namespace impinge
