// impinge info: what of a scene is modelled, and what is left out because nothing needs it.
#include <fmt/format.h>

#include <map>

#include "viewer/app/commands.hpp"
#include "viewer/app/soft_report.hpp"

namespace impinge {

namespace {

struct Counts {
  int fixed = 0, scripted = 0, dynamic = 0, deformable = 0;
  int soft_dofs = 0;
  std::map<std::string, int> shapes;
  std::size_t vertices = 0, triangles = 0, bytes = 0;
  bool friction = false, restitution = false, mesh_pairs = false, self_collision = false;
};

Counts count(const World& world) {
  Counts counts;
  int meshes = 0;
  for (const RigidBody& body : world.bodies()) {
    switch (body.kind) {
      case BodyKind::fixed: ++counts.fixed; break;
      case BodyKind::scripted: ++counts.scripted; break;
      case BodyKind::dynamic: ++counts.dynamic; break;
      case BodyKind::deformable: ++counts.deformable; break;
    }
    counts.shapes[shape_name(body.shape)]++;
    if (body.soft) {
      counts.soft_dofs += body.soft->fem.dofs();
      counts.bytes += memory_of(*body.soft);
    }
    const double friction = body.friction < 0.0 ? world.parameters.contact.friction : body.friction;
    const double restitution = body.restitution < 0.0 ? world.parameters.contact.restitution : body.restitution;
    counts.friction |= friction > 0.0;
    counts.restitution |= restitution > 0.0;
    counts.self_collision |= body.is_deformable() && body.self_collision;
    counts.bytes += sizeof(RigidBody);
    const auto* mesh = std::get_if<MeshPointer>(&body.shape);
    if (mesh == nullptr) continue;
    ++meshes;
    counts.vertices += (*mesh)->mesh.vertices.size();
    counts.triangles += (*mesh)->mesh.triangles.size();
    // vertices in the body's frame and in the world; triangles, their edges, and the edges with their triangles
    counts.bytes += (*mesh)->mesh.vertices.size() * (2 * sizeof(Vec3) + sizeof(int)) +
                    (*mesh)->mesh.triangles.size() * (sizeof(Triangle) + 2 * sizeof(std::array<int, 3>)) + (*mesh)->topology.edges.size() * sizeof(MeshTopology::Edge);
  }
  counts.mesh_pairs = meshes > 1 || counts.self_collision;
  return counts;
}

void print_scene(const Session& session, const Counts& counts) {
  const StepRecord& record = session.record();
  fmt::print("bodies:       {} ({} deformable, {} dynamic, {} scripted, {} static)\n", session.world().bodies().size(), counts.deformable, counts.dynamic, counts.scripted, counts.fixed);
  std::vector<std::string> shapes;
  for (const auto& [name, number] : counts.shapes) shapes.push_back(fmt::format("{} {}", number, name));
  fmt::print("shapes:       {}\n", shapes.empty() ? "none" : fmt::format("{}", fmt::join(shapes, ", ")));
  fmt::print("surfaces:     {} vertices, {} triangles in all bodies\n", counts.vertices, counts.triangles);
  for (const SurfaceFile& file : session.scene().surfaces)
    fmt::print("  {}: {} vertices, {} {}{}\n", file.name, file.vertices, file.tets > 0 ? file.tets : file.triangles, file.tets > 0 ? "tetrahedra" : "triangles", file.welded > 0 ? fmt::format(", {} coinciding vertices welded", file.welded) : "");
  print_soft_bodies(session);
  fmt::print("freedom:      {} degrees ({} dynamic bodies of 6, {} of deformable bodies' nodes)\n", record.stats.dofs, counts.dynamic, counts.soft_dofs);
  fmt::print("at the start: {} body pairs, {} triangle pairs, {} contacts\n", record.stats.broad_pairs, record.stats.triangle_pairs, record.stats.contacts);
  fmt::print("memory:       about {:.1f} MB for bodies and surfaces\n", static_cast<double>(counts.bytes) / 1e6);
}

void print_model(const Parameters& p, const Counts& counts, std::size_t attachments) {
  fmt::print("time:         {} s a frame, {} sub-steps of {} s\n", shortest(p.simulation.frame_time), p.simulation.substeps, shortest(p.simulation.time_step()));
  const auto line = [](const char* stage, bool used, const std::string& what, const char* why) { fmt::print("{:<14}{}\n", stage, used ? what : std::string("left out: ") + why); };
  const int moving = counts.dynamic + counts.deformable;
  const bool moves = moving > 0, meets = moves && (moving + counts.fixed + counts.scripted > 1 || counts.self_collision);
  line("integrator:", moves, p.simulation.integrator + (counts.deformable == 0 ? " (rigid: A = M)" : counts.dynamic == 0 ? "" : " (for rigid bodies A = M)"), "nothing can move");
  line("broad phase:", meets, p.broad_phase.method, "no two bodies can meet");
  line("narrow phase:", meets && counts.mesh_pairs, p.narrow_phase.method + ", contacts by " + p.contact.points, "no two meshes can meet; exact shapes are tested by formula");
  line("response:", meets, fmt::format("{} with {}, tolerance {}, at most {} iterations", p.response.method, p.lcp.method, shortest(p.lcp.tolerance), p.lcp.max_iterations), "no two bodies can meet");
  line("friction:", meets && counts.friction, fmt::format("Coulomb cone, three rows a contact, coefficient {} unless a body names one", shortest(p.contact.friction)), "no body has any, so contacts have one row");
  line("restitution:", meets && counts.restitution, fmt::format("{} unless a body names one, above {} m/s", shortest(p.contact.restitution), shortest(p.contact.restitution_threshold)), "no body bounces");
  line("sleeping:", p.simulation.sleeping && moves, fmt::format("groups slower than {} m/s for {} s", shortest(p.simulation.sleep_speed), shortest(p.simulation.sleep_time)), "switched off, or nothing can move");
  line("deformation:", counts.deformable > 0, fmt::format("{} degrees of freedom, linear solver {}", counts.soft_dofs, p.simulation.linear_solver), "no body is deformable");
  line("self-contact:", counts.self_collision, "of the deformable bodies that ask for it", "no deformable body asks for it");
  line("attachments:", attachments > 0, fmt::format("{}, three bilateral rows each", attachments), "the scene has none");
}

}  // namespace

int info_command(const Arguments& arguments) {
  Session session(arguments.run_options.scene, arguments.run_options.overrides, {});
  const Counts counts = count(session.world());
  fmt::print("{}\n", arguments.run_options.scene.string());
  print_scene(session, counts);
  print_model(session.world().parameters, counts, session.record().attachments.size());
  return 0;
}

}  // namespace impinge
