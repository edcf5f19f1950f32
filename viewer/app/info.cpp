// impinge info: what of a scene is modelled, and what is left out because nothing needs it.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/rigid_body.hpp"
#include "engine/core/parallel.hpp"
#include "engine/core/units.hpp"
#include "viewer/app/shared_options.hpp"
#include "viewer/study/ablation.hpp"
#include "viewer/study/deformable_report.hpp"
#include "viewer/study/model_report.hpp"
#include "viewer/study/scene_preflight.hpp"

namespace impinge {

namespace {

struct Counts {
  std::map<std::string, int> shapes;
  std::size_t vertices = 0, triangles = 0, bytes = 0;
};

Counts count(const World& world) {
  Counts counts;
  for (const Body& body : world.bodies()) {
    counts.shapes[std::string(body.shape->name())]++;
    const auto* deformable = body.as<DeformableBody>();
    counts.bytes += deformable == nullptr ? sizeof(RigidBody) : sizeof(DeformableBody) + memory_of(*deformable);
    const SurfaceMesh* mesh = body.shape->mesh();
    if (mesh == nullptr) continue;
    counts.vertices += mesh->mesh.vertices.size();
    counts.triangles += mesh->mesh.triangles.size();
    // vertices in the body's frame and in the world; triangles, their edges, and the edges with their triangles
    counts.bytes += mesh->mesh.vertices.size() * (2 * sizeof(Vec3) + sizeof(int)) +
                    mesh->mesh.triangles.size() * (sizeof(Triangle) + 2 * sizeof(std::array<int, 3>)) +
                    mesh->topology.edges.size() * sizeof(MeshTopology::Edge);
  }
  return counts;
}

/// All three in one unit: that of the largest.
std::string extent_text(const Vec3& extent) {
  const Unit unit = length_unit(extent.maxCoeff());
  const auto side = [&](double metres) { return fmt::format("{:.3g} {}", metres / unit.size, unit.name); };
  return fmt::format("{} × {} × {}", side(extent.x()), side(extent.y()), side(extent.z()));
}

/// Name, kind, shape, size and mass of the first of them.
void print_bodies(const World& world) {
  constexpr std::size_t kMostNamed = 40;
  std::size_t width = 0, named = 0;
  for (const Body& body : world.bodies())
    if (named++ < kMostNamed) width = std::max(width, body.name.size());
  named = 0;
  for (const Body& body : world.bodies()) {
    if (named++ == kMostNamed) break;
    const Vec3 extent = body.bounds().extent();
    const bool has_box = extent.allFinite() && (extent.array() >= 0.0).all();
    fmt::print("  {:<{}}  {:<10}  {:<11}  {}{}\n", body.name, width, kind_name(body.kind()), body.shape->name(),
               has_box ? fmt::format("{}, size {}", extent_text(extent), length_text(body.size)) : "without end",
               body.has_freedom() ? ", " + mass_text(body.mass) : "");
  }
  const std::size_t all = static_cast<std::size_t>(world.bodies().size().value());
  if (all > kMostNamed) fmt::print("  and {} more\n", all - kMostNamed);
}

void print_scene(const Session& session, const Counts& counts, const ModelFacts& facts) {
  const StepRecord& record = session.record();
  fmt::print("bodies:       {} ({} deformable, {} dynamic, {} scripted, {} static)\n", session.world().bodies().size(),
             facts.deformable, facts.dynamic, facts.scripted, facts.fixed);
  print_bodies(session.world());
  std::vector<std::string> shapes;
  for (const auto& [name, number] : counts.shapes) shapes.push_back(fmt::format("{} {}", number, name));
  fmt::print("shapes:       {}\n", shapes.empty() ? "none" : fmt::format("{}", fmt::join(shapes, ", ")));
  fmt::print("surfaces:     {} vertices, {} triangles in all bodies\n", counts.vertices, counts.triangles);
  for (const SurfaceFile& file : session.scene().surfaces)
    fmt::print("  {}: {} vertices, {} {}{}\n", file.name, file.vertices, file.tets > 0 ? file.tets : file.triangles,
               file.tets > 0 ? "tetrahedra" : "triangles",
               file.welded > 0 ? fmt::format(", {} coinciding vertices welded", file.welded) : "");
  print_deformable_bodies(session);
  fmt::print("freedom:      {} degrees ({} dynamic bodies of 6, {} of deformable bodies' nodes)\n", record.stats.dofs,
             facts.dynamic, facts.deformable_dofs);
  fmt::print("at the start: {} body pairs, {} triangle pairs, {} contacts\n", record.stats.broad_pairs,
             record.stats.triangle_pairs, record.stats.contacts);
  fmt::print("memory:       about {:.1f} MB for bodies and surfaces\n", static_cast<double>(counts.bytes) / 1e6);
}

void print_model(const Parameters& p, const ModelFacts& facts) {
  fmt::print("time:         {} s a frame, {} sub-steps of {} s\n", shortest(p.simulation.frame_time),
             p.simulation.substeps, shortest(p.simulation.time_step()));
  for (const ModelLine& line : model_lines(p, facts))
    fmt::print("{:<14}{}{}\n", line.stage + ":", line.used ? "" : "left out: ", line.what);
}

class InfoCommand : public SubCommand {
 public:
  void declare(Options& options) override {
    scene_options(options, run_.scene, run_.overrides);
    script_option(options, run_.script, "script file");
    options.flag(
        "--ablation", ablation_,
        "run the scene as it is and with each economy switched off: what it would cost, and what it would change");
    frames_option(options, run_.frames, "with --ablation: the last frame's number (default: 20)");
    options.path("--out", out_, "with --ablation: folder for ablation.csv; a sweep's folder shows it in its report");
    options.whole("--threads", threads_, 1, 4096, "threads to use (default: all cores; one with --ablation)");
  }

  int run() override {
    if (!ablation_ && (run_.frames || !out_.empty()))
      refuse_option(run_.frames ? "--frames without --ablation" : "--out without --ablation", "info alone runs nothing",
                    "add --ablation, or leave it out");
    set_thread_count(threads_.value_or(0));
    {
      Session session(run_.scene, run_.overrides, run_.script);
      if (ablation_) check_ablation(run_, session);
      const Counts counts = count(session.world());
      const ModelFacts facts = model_facts(session.world());
      fmt::print("{}\n", run_.scene.string());
      print_scene(session, counts, facts);
      print_model(session.world().parameters, facts);
      fmt::print("{}", warning_lines(preflight_of(session)));
    }
    if (!ablation_) return 0;
    if (!threads_) set_thread_count(1);  // threads that wait for work would count as work
    print_ablation(run_, out_);
    return 0;
  }

 private:
  RunOptions run_;
  bool ablation_ = false;
  std::filesystem::path out_;
  std::optional<int> threads_;
};

}  // namespace

Entry<SubCommand> info_command() {
  return entry<SubCommand, InfoCommand>("info", "what of a scene is modelled and what is left out");
}

}  // namespace impinge
