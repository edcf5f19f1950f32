#include "viewer/notes/balance_note.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/bodies/deformable_body.hpp"
#include "engine/bodies/scale.hpp"
#include "engine/bodies/scripted_body.hpp"
#include "engine/preflight/shorter_substeps.hpp"
#include "engine/world/world.hpp"
#include "viewer/notes/note_archive.hpp"

namespace impinge {
namespace {

constexpr double kApart = 0.1;  // of the smaller body's size: a gap that is worth a word
constexpr std::size_t kMostApart = 4;
constexpr std::string_view kExact = "constraint_anticipation";

/// Whether anything of the scene moves by itself, whatever it meets.
bool is_driven_by_scene(const Bodies& bodies) {
  for (const Body& body : bodies) {
    if (const auto* scripted = body.as<ScriptedBody>(); scripted != nullptr && scripted->motion.keys().size() > 1)
      return true;
    if (body.pull) return true;
    if (const auto* soft = body.as<DeformableBody>())
      for (const HeldRegion& region : soft->held)
        if (region.is_moved()) return true;
  }
  return false;
}

/// What a body at rest might have without being worth a word: it may fall by its own size, and move as slowly as what sleeps.
double least_of(const Body& body, const Parameters& p) {
  if (!body.has_freedom()) return 0.0;
  const double slow = p.simulation.sleep_speed.at(speed_scale(scale_gravity(p.simulation.gravity), body.size));
  return body.mass * (p.simulation.gravity.norm() * body.size + 0.5 * slow * slow);
}

std::string energy_remedy(const Bodies& bodies, const Parameters& p) {
  const std::string_view integrator = p.simulation.integrator.name(), response = p.response.method.name();
  const double enough = kEnoughDamping * p.simulation.time_step();
  bool is_soft = false, is_undamped = false;
  for (const Body& body : bodies)
    if (const auto* soft = body.as<DeformableBody>()) is_soft = true, is_undamped |= soft->damping.beta < enough;
  std::string text = "take more simulation.substeps";
  if (is_undamped && integrator == "newmark")
    text = "take " + enough_damping(p) + " and more, or another simulation.integrator";
  else if (is_soft && p.simulation.integrator->is_explicit())
    text += ", or an implicit simulation.integrator";
  else if (response != kExact)
    text += fmt::format(", or response.method = \"{}\"", kExact);
  return text + "; --set record.ledger=true tells what gave it";
}

}  // namespace

void BalanceNote::add_earlier(const FrameEnergy& energy, bool is_driven) {
  is_driven_ |= is_driven && energy.frame > 0;
  if (!is_driven_) energies_.push_back(energy);
}

void BalanceNote::begin(const World& world) {
  has_begun_ = true;
  const Parameters& p = world.parameters;
  if (is_driven_by_scene(world.bodies())) is_driven_ = true, energies_.clear();
  for (const Body& body : world.bodies()) least_ += least_of(body, p);
  remedy_ = energy_remedy(world.bodies(), p);
  attachment_remedy_ = "take more simulation.substeps, or masses nearer to each other";
  if (p.response.method.name() != kExact) attachment_remedy_ += fmt::format(", or response.method = \"{}\"", kExact);
}

void BalanceNote::add(const World& world, bool is_driven) {
  if (!has_begun_) begin(world);
  const FrameStats& stats = world.record().stats;
  is_driven_ |= is_driven && stats.frame > 0;
  if (!is_driven_) energies_.push_back({stats.frame, stats.kinetic, stats.elastic, stats.potential});
  take_attachments(world);
}

void BalanceNote::take_attachments(const World& world) {
  const StepRecord& record = world.record();
  for (const AttachmentRecord& a : record.attachments) {
    Apart& seen = attachments_[a.number];
    if (seen.name.empty()) {
      const Body* smaller = &world.bodies()[a.body_a];
      if (!a.body_b.is_none() && world.bodies()[a.body_b].size < smaller->size) smaller = &world.bodies()[a.body_b];
      seen.name = a.name, seen.smaller = smaller->name, seen.size = smaller->size;
    }
    const double gap = a.error();
    const bool is_apart = gap > kApart * seen.size;
    seen.was_held |= !is_apart;  // what slides may start off its surface
    if (!is_apart || !seen.was_held) continue;
    if (seen.first < 0) seen.first = record.stats.frame, seen.gap = gap;
    if (gap > seen.most) seen.most = gap, seen.worst = record.stats.frame;
  }
}

void BalanceNote::keep(NoteArchive& archive) {
  auto known = static_cast<std::uint64_t>(energies_.size());
  archive.keep(known);
  if (known < energies_.size()) energies_.resize(known);
  archive.keep(has_begun_, is_driven_, least_, remedy_, attachment_remedy_);
  archive.map(attachments_,
              [&](Apart& a) { archive.keep(a.name, a.smaller, a.size, a.was_held, a.first, a.worst, a.gap, a.most); });
}

std::string BalanceNote::energy_text() const {
  const std::optional<EnergyRise> found = find_energy_rise(energies_, least_);
  if (!found) return "";
  return fmt::format(
      "note:     {}: from frame {} on more than a tenth of what there was, most in frame {}: "
      "{:.3g} J, {:.3g} times the {:.3g} J that it had; {}\n",
      kEnergyMark, found->first, found->worst, found->rise, found->rise / found->had, found->had, remedy_);
}

std::string BalanceNote::attachments_text() const {
  std::vector<const Apart*> apart;
  for (const auto& [number, seen] : attachments_)
    if (seen.first >= 0) apart.push_back(&seen);
  std::stable_sort(apart.begin(), apart.end(), [](const Apart* l, const Apart* r) { return l->first < r->first; });
  std::string lines;
  for (std::size_t i = 0; i < std::min(apart.size(), kMostApart); ++i) {
    const Apart& a = *apart[i];
    lines += fmt::format("note:     '{}' {} {}: by {:.3g} m, {:.0f} % of '{}'", a.name, kApartMark, a.first, a.gap,
                         100.0 * a.gap / a.size, a.smaller);
    if (a.worst > a.first) lines += fmt::format(", in frame {} by {:.3g} m", a.worst, a.most);
    lines += fmt::format("; {}\n", attachment_remedy_);
  }
  if (apart.size() > kMostApart)
    lines += fmt::format("note:     so did {} more; attachment_error_m in stats.csv has the largest\n",
                         apart.size() - kMostApart);
  return lines;
}

std::string BalanceNote::text() const { return energy_text() + attachments_text(); }

}  // namespace impinge
