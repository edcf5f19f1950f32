#include "viewer/notes/swell_note.hpp"

#include <fmt/format.h>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/scale.hpp"
#include "engine/integrators/turning_swell.hpp"
#include "engine/world/world.hpp"
#include "viewer/notes/note_archive.hpp"

namespace impinge {
namespace {

constexpr double kWorthAWord = 0.1;  // of a body's kinetic energy, and of its weight times its size

}  // namespace

void SwellNote::add(const World& world) {
  const Parameters& p = world.parameters;
  if (p.simulation.integrator.name() != "linearly_implicit_euler" || world.frame() == 0) return;
  for (const Body& body : world.bodies()) {
    const auto* soft = body.as<DeformableBody>();
    if (soft == nullptr || body.absent || body.deleted || body.asleep || soft->model == "linear") continue;
    const auto swell = turning_swell(*soft, p.simulation.time_step());
    const double rests = body.mass * scale_gravity(p.simulation.gravity) * body.size, kinetic = soft->kinetic_energy();
    if (!swell || !(swell->energy > kWorthAWord * (kinetic + rests))) continue;
    Swollen& worst = bodies_[body.name];
    if (swell->energy > worst.energy)
      worst = {world.record().stats.frame, swell->strain, swell->turn, swell->energy, kinetic};
  }
}

void SwellNote::keep(NoteArchive& archive) {
  archive.map(bodies_, [&](Swollen& s) { archive.keep(s.frame, s.strain, s.turn, s.energy, s.kinetic); });
}

std::string SwellNote::text() const {
  std::string lines;
  for (const auto& [name, s] : bodies_)
    lines += fmt::format(
        "note:     '{}' swells as it turns, in frame {} by {:.2g} % at {:.2g} radians a sub-step: {:.3g} J of elastic "
        "energy "
        "that the integrator makes and takes back, beside {:.3g} J of motion; take more simulation.substeps\n",
        name, s.frame, 100.0 * s.strain, s.turn, s.energy, s.kinetic);
  return lines;
}

}  // namespace impinge
