// The list of economies: what a scene leaves out, by parameters that exist for other uses too.
#include <fmt/format.h>

#include "viewer/study/ablation.hpp"
#include "viewer/study/model_report.hpp"

namespace impinge {

namespace {

constexpr const char* kAlways = "always";
constexpr const char* kNoUse = "no use here";

class List {
 public:
  void take(const char* name, const std::string& instead, std::vector<std::string> overrides,
            const std::string& no_use) {
    if (overrides.empty())
      idle_.push_back({name, no_use, {}, kNoUse});
    else
      live_.push_back({name, instead, std::move(overrides), ""});
  }
  void always(const char* name, const std::string& what) { idle_.push_back({name, what, {}, kAlways}); }
  std::vector<Economy> all() {
    live_.insert(live_.end(), idle_.begin(), idle_.end());
    return live_;
  }

 private:
  std::vector<Economy> live_, idle_;
};

/// The first that is what is wanted.
template <class Interface, class Predicate>
std::string_view first_name(const Registry<Interface>& registry, Predicate&& is_wanted) {
  for (const Entry<Interface>& entry : registry)
    if (is_wanted(*entry.make())) return entry.name;
  throw InternalError("no method to compare with");
}

std::vector<std::string> only_if(bool used, std::vector<std::string> overrides) {
  return used ? std::move(overrides) : std::vector<std::string>();
}

}  // namespace

std::vector<Economy> economies(const Session& session) {
  const World& world = session.world();
  const Parameters& p = world.parameters;
  const ModelFacts facts = model_facts(world);
  const bool meets = facts.meets(), soft = facts.deformable > 0;
  std::vector<std::string> rows, masses, self;
  std::size_t vertices = 0, nodes = 0;
  for (const Body& body : world.bodies()) {
    if (body.friction == 0.0) rows.push_back(fmt::format("body.{}.friction=1e-9", body.name));
    const auto* deformable = body.as<DeformableBody>();
    if (deformable == nullptr) continue;
    const FemAssembly& fem = deformable->fem;
    vertices += body.shape->mesh()->mesh.vertices.size();
    nodes += static_cast<std::size_t>(fem.nodes());
    if (fem.mass_kind() == MassKind::lumped)
      masses.push_back(fmt::format("body.{}.material.mass=consistent", body.name));
    if (!body.self_collision) self.push_back(fmt::format("body.{}.self_collision=true", body.name));
  }
  if (p.contact.friction == 0.0) rows.push_back("contact.friction=1e-9");
  const bool uses_lcp = p.response.method->uses_cone_solver();
  const auto of = [](const char* path, const auto& registry, auto&& is_rival) {
    return fmt::format("{}={}", path, first_name(registry, is_rival));
  };
  const auto tests_every_pair = [](const auto& phase) { return phase.tests_every_pair(); };
  const DeformableIntegrator& integrator = *p.simulation.integrator;

  List list;
  list.take("sleeping", "bodies at rest are simulated on",
            only_if(p.simulation.sleeping, {"simulation.sleeping=false"}), "it is switched off");
  list.take("broad phase", "every pair of bodies is tested",
            only_if(meets && !p.broad_phase.method->tests_every_pair(),
                    {of("broad_phase.method", broad_phases(), tests_every_pair)}),
            "no two bodies can meet, or it is brute force");
  list.take("narrow phase", "every pair of triangles is tested",
            only_if(meets && facts.mesh_pairs && !p.narrow_phase.method->tests_every_pair(),
                    {of("narrow_phase.method", narrow_phases(), tests_every_pair)}),
            "no two meshes can meet (exact shapes go by formula), or it is brute force");
  list.take("warm start", "each contact starts from no impulse",
            only_if(meets && p.contact.warm_start, {"contact.warm_start=false"}),
            "it is switched off, or no two bodies can meet");
  list.take("rows of friction 0", "three rows a contact, friction 1e-9", meets ? rows : std::vector<std::string>(),
            "every contact has friction, so none is left out");
  list.take("solver by problem", "projected Gauss-Seidel for every contact problem",
            only_if(meets && uses_lcp && p.lcp.method->chooses_by_problem(), {"lcp.method=projected_gauss_seidel"}),
            "the scene names its cone solver, or the response has none");
  const int cap = static_cast<int>(std::min(10.0 * p.lcp.max_iterations, 1e7));
  list.take("contact tolerance", "contact solved to 1e-12, ten times the iterations allowed",
            only_if(meets && uses_lcp && p.lcp.tolerance > 1e-12,
                    {"lcp.tolerance=1e-12", fmt::format("lcp.max_iterations={}", cap)}),
            "the response has none, or it is as small");
  list.take("one linear solve a sub-step", "implicit Euler by Newton's method until it has converged",
            only_if(soft && integrator.newton() == nullptr && !integrator.is_explicit(),
                    {of("simulation.integrator", integrators(), [](const auto& i) { return i.newton() != nullptr; })}),
            "no body is deformable, or the integrator iterates or is explicit");
  list.take("linear solver by size", "a factorization for every solve",
            only_if(soft && p.simulation.linear_solver.is_automatic(), {"simulation.linear_solver=simplicial_llt"}),
            "no body is deformable, or the scene names its solver");
  list.take("lumped mass", "consistent mass", masses, "no body is deformable, or all have consistent mass");
  list.take("self-contact", "every deformable body against itself", self,
            "no body is deformable, or all are tested against themselves");
  list.take("coarse time steps", "four times the sub-steps",
            only_if(p.simulation.substeps <= 250, {fmt::format("simulation.substeps={}", 4 * p.simulation.substeps)}),
            "there are as many sub-steps as can be");

  list.always("degrees of freedom", fmt::format("{} static and {} scripted bodies have none and are in no system",
                                                facts.fixed, facts.scripted));
  if (soft)
    list.always("nodes instead of vertices",
                fmt::format("{} nodes carry {} vertices of deformable surfaces", nodes, vertices));
  list.always("pairs nothing responds to", "static, scripted and sleeping bodies are not tested against each other");
  list.always("frames without contact", "no group, no system, no solve");
  list.always("one system a group", "bodies that don't touch are never in one system");
  list.always("one contact a place", "contacts of one place and direction are one contact");
  if (soft)
    list.always("factorizations", "the pattern is analyzed once, and numbers are factorized where they have changed");
  return list.all();
}

}  // namespace impinge
