#include "viewer/study/model_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/bodies/scale.hpp"
#include "engine/core/error.hpp"
#include "engine/core/parameter.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "engine/io/scene/former_paths.hpp"
#include "engine/io/scene/scene_values.hpp"

namespace impinge {

namespace {

void count_body(BodyKind kind, bool is_mesh, double friction, double restitution, bool self_collision, int& meshes,
                ModelFacts& facts) {
  switch (kind) {
    case BodyKind::fixed:
      ++facts.fixed;
      break;
    case BodyKind::scripted:
      ++facts.scripted;
      break;
    case BodyKind::dynamic:
      ++facts.dynamic;
      break;
    case BodyKind::deformable:
      ++facts.deformable;
      break;
  }
  facts.friction |= friction > 0.0;
  facts.frictionless |= !(friction > 0.0);
  facts.restitution |= restitution > 0.0;
  facts.self_collision |= kind == BodyKind::deformable && self_collision;
  meshes += is_mesh ? 1 : 0;
}

int& count_of(AttachmentKind kind, ModelFacts& facts) {
  switch (kind) {
    case AttachmentKind::line:
      return facts.lines;
    case AttachmentKind::plane:
      return facts.planes;
    case AttachmentKind::surface:
      return facts.surfaces;
    default:
      return facts.points;
  }
}

/// By the keys of a recorded scene, which were checked when it ran.
AttachmentKind attachment_kind(const TomlNode& table) {
  if (table.find("direction") != nullptr) return AttachmentKind::line;
  if (table.find("normal") != nullptr) return AttachmentKind::plane;
  return table.find("on") != nullptr ? AttachmentKind::surface : AttachmentKind::point;
}

std::string attachments_text(const ModelFacts& f) {
  std::string text;
  const auto add = [&](int count, const char* what, const char* rows) {
    if (count > 0) text += fmt::format("{}{} {}, {} each", text.empty() ? "" : "; ", count, what, rows);
  };
  if (f.points == f.attachments()) return fmt::format("{}, three bilateral rows each", f.points);
  add(f.points, "at a point", "three bilateral rows");
  add(f.lines, "sliding on a line", "two bilateral rows");
  add(f.planes, "in a plane", "one bilateral row");
  add(f.surfaces, "on a surface", "one bilateral row");
  return text;
}

const TomlNode* at_path(const TomlNode& root, const std::string& path) {
  const TomlNode* node = &root;
  for (std::size_t begin = 0; node != nullptr && begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const TomlEntry* entry = node->find(path.substr(begin, end - begin));
    node = entry == nullptr ? nullptr : &entry->value;
    begin = end + 1;
  }
  return node;
}

BodyKind kind_of(const std::string& word) {
  for (const BodyKind kind : {BodyKind::fixed, BodyKind::scripted, BodyKind::deformable})
    if (word == kind_name(kind)) return kind;
  return BodyKind::dynamic;
}

std::string response_text(const Parameters& p) {
  const Response& response = *p.response.method;
  const std::string summary = response.summary(lcp_settings(p));
  return fmt::format("{}{}{}{}", p.response.method.name(),
                     response.uses_cone_solver() ? fmt::format(" with {}", p.lcp.method.name()) : "",
                     summary.empty() ? "" : ", ", summary);
}

/// A number, or what an automatic one comes to between the least and the largest of its scale.
std::string threshold_text(const Threshold& threshold, double least, double most, const char* unit) {
  if (threshold.given) return fmt::format("{} {}", shortest(*threshold.given), unit);
  const std::string low = fmt::format("{:.2g}", threshold.at(least)), high = fmt::format("{:.2g}", threshold.at(most));
  if (!(most > 0.0)) return "what the bodies' sizes say (auto)";
  return low == high ? fmt::format("{} {} (auto)", low, unit) : fmt::format("{} to {} {} (auto)", low, high, unit);
}

}  // namespace

ModelFacts model_facts(const World& world) {
  ModelFacts facts;
  int meshes = 0;
  const Parameters& p = world.parameters;
  for (const Body& body : world.bodies()) {
    count_body(body.kind(), body.shape->mesh() != nullptr, body.friction.value_or(p.contact.friction),
               body.restitution.value_or(p.contact.restitution), body.self_collision, meshes, facts);
    if (body.kind() == BodyKind::deformable) facts.deformable_dofs += body.dofs();
  }
  facts.thinnest = facts.smallest = INFINITY;
  for (const Body& body : world.bodies()) {
    facts.thinnest = std::min(facts.thinnest, body.size);
    if (!body.has_freedom()) continue;
    facts.smallest = std::min(facts.smallest, body.size);
    facts.largest = std::max(facts.largest, body.size);
  }
  facts.mesh_pairs = meshes > 1 || facts.self_collision;
  for (const AttachmentRecord& a : world.record().attachments) {
    ++count_of(a.kind, facts);
    if (a.body_a.is_none() || a.body_b.is_none() || !world.bodies().never_touch(a.body_a, a.body_b)) continue;
    facts.exempt.push_back(fmt::format("{} and {}{}", world.bodies()[a.body_a].name, world.bodies()[a.body_b].name,
                                       a.name.empty() ? "" : fmt::format(" ('{}')", a.name)));
  }
  return facts;
}

bool read_recorded_model(const std::filesystem::path& run_toml, Parameters& parameters, ModelFacts& facts) {
  try {
    if (!is_file(run_toml)) return false;
    TomlNode root = parse_toml(run_toml.string(), read_file(run_toml, std::uint64_t{1} << 26));
    ParameterSet rows;
    parameters.bind(rows);
    rename_former_paths(root, rows);
    for (const Parameter& row : rows.all())
      if (const TomlNode* node = at_path(root, row.path)) row.set(scene_value(row, *node));
    int meshes = 0;
    const auto own = [](const TomlNode* node, double of_scene) {
      return node != nullptr && node->is_number() ? node->as_number() : of_scene;
    };
    if (const TomlEntry* bodies = root.find("body"))
      for (const TomlNode& body : bodies->value.items) {
        const TomlNode *kind = at_path(body, "kind"), *friction = at_path(body, "friction"),
                       *restitution = at_path(body, "restitution"), *self = at_path(body, "self_collision");
        const BodyKind is = kind_of(kind == nullptr ? "" : kind->string);
        count_body(is, is == BodyKind::deformable || body.find("surface") != nullptr,
                   own(friction, parameters.contact.friction), own(restitution, parameters.contact.restitution),
                   self != nullptr && self->flag, meshes, facts);
      }
    facts.mesh_pairs = meshes > 1 || facts.self_collision;
    facts.deformable_dofs = -1;
    if (const TomlEntry* attachments = root.find("attachment"))
      for (const TomlNode& attachment : attachments->value.items) ++count_of(attachment_kind(attachment), facts);
    return true;
  } catch (const InputError&) {
    return false;  // of another version: the report then says nothing about it
  }
}

std::vector<ModelLine> model_lines(const Parameters& p, const ModelFacts& f) {
  std::vector<ModelLine> lines;
  const auto line = [&](const char* stage, bool used, const std::string& what, const std::string& why) {
    lines.push_back({stage, used, used ? what : why});
  };
  const bool moves = f.moving() > 0, meets = f.meets(), proximity = p.contact.points == ContactPoints::proximity;
  const double g = scale_gravity(p.simulation.gravity);
  const auto speed = [&](const Threshold& threshold) {
    return threshold_text(threshold, speed_scale(g, f.smallest), speed_scale(g, f.largest), "m/s");
  };
  line("integrator", moves,
       fmt::format("{}{}", p.simulation.integrator.name(),
                   f.deformable == 0 ? " (rigid: A = M)"
                   : f.dynamic == 0  ? ""
                                     : " (for rigid bodies A = M)"),
       "nothing can move");
  line("broad phase", meets, std::string(p.broad_phase.method.name()), "no two bodies can meet");
  line("narrow phase", meets && f.mesh_pairs,
       fmt::format("{}, contacts by {}", p.narrow_phase.method.name(), name_of(p.contact.points)),
       "no two meshes can meet; exact shapes are tested by formula");
  line(
      "contacts", meets && proximity,
      fmt::format("features closer than {}", threshold_text(p.contact.activation_distance, f.thinnest, f.largest, "m")),
      meets ? "only what intersects is a contact" : "no two bodies can meet");
  line("response", meets, response_text(p), "no two bodies can meet");
  line("push-out", meets && p.contact.max_push_out.given.value_or(1.0) > 0.0,
       fmt::format("overlap goes at {} at most", speed(p.contact.max_push_out)),
       meets ? "switched off" : "no two bodies can meet");
  line("friction", meets && f.friction,
       fmt::format("Coulomb cone, three rows a contact, coefficient {} unless a body names one",
                   shortest(p.contact.friction)),
       "no body has any, so contacts have one row");
  const bool bounces = p.response.method->uses_restitution();
  line("restitution", meets && f.restitution && bounces,
       fmt::format("{} unless a body names one, above {}", shortest(p.contact.restitution),
                   speed(p.contact.restitution_threshold)),
       bounces ? "no body bounces" : fmt::format("{} does not use it", p.response.method.name()));
  line("sleeping", p.simulation.sleeping && moves,
       fmt::format("groups slower than {} for {}", speed(p.simulation.sleep_speed),
                   threshold_text(p.simulation.sleep_time, time_scale(g, f.smallest), time_scale(g, f.largest), "s")),
       "switched off, or nothing can move");
  line("deformation", f.deformable > 0,
       fmt::format("{}linear solver {}",
                   f.deformable_dofs < 0 ? "" : fmt::format("{} degrees of freedom, ", f.deformable_dofs),
                   p.simulation.linear_solver.name()),
       "no body is deformable");
  line("self-contact", f.self_collision, "of the deformable bodies that ask for it", "no deformable body asks for it");
  line("attachments", f.attachments() > 0,
       attachments_text(f) +
           (f.exempt.empty() ? "" : fmt::format("; never touch, collide = false: {}", some_of(f.exempt))),
       "the scene has none");
  return lines;
}

}  // namespace impinge
