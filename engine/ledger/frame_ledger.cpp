#include "engine/ledger/frame_ledger.hpp"

#include <cmath>
#include <limits>

namespace impinge {

const std::array<LedgerSourceInfo, kLedgerSources>& ledger_sources() {
  using enum LedgerSource;
  static constexpr std::array<LedgerSourceInfo, kLedgerSources> kSources = {{
      {gravity, "gravity", "What gravity gave to the motion, and took from the potential energy.", true},
      {elastic, "elastic", "What elastic forces gave to the motion, and took from the elastic energy.", true},
      {damping, "damping", "Work of Rayleigh damping.", false},
      {impact, "impact", "Work of normal impulses of contacts, resting ones too, against what they meet.", false},
      {friction, "friction", "Work of tangential impulses of contacts, against what they meet.", false},
      {attachment, "attachment", "Work of the impulses of attachments and slides.", false},
      {script, "script",
       "Work of what is moved by a script, held nodes included, of pulls, and what pushes, moves,"
       " additions, deletions and changed parameters did.",
       false},
      {push_out, "push_out", "Recovery from overlap: bodies put elsewhere, with the turn of their spin.", false},
      {held_back, "held_back", "Bodies that stand still for the rest of a sub-step in which they would pass.", false},
      {sleep, "sleep", "The motion that is taken from bodies that fall asleep.", false},
      {solver, "solver", "Impulses that the solution of the equations is short of, within their tolerances.", false},
      {integrator, "integrator",
       "Where bodies come to, against the work that gravity and elastic forces did on the way; and turning.", false},
  }};
  return kSources;
}

std::optional<LedgerSource> find_ledger_source(std::string_view name) {
  for (const LedgerSourceInfo& info : ledger_sources())
    if (info.name == name) return info.source;
  return std::nullopt;
}

LedgerEntry& LedgerEntry::operator+=(const LedgerEntry& more) {
  motion += more.motion, stored += more.stored;
  momentum += more.momentum, angular_momentum += more.angular_momentum;
  return *this;
}

double figure_of(LedgerSource source, const LedgerEntry& entry) {
  return info_of(source).is_exchange ? entry.motion : entry.energy();
}

LedgerEntry BodyLedger::sum() const {
  LedgerEntry all;
  for (const LedgerEntry& entry : of) all += entry;
  return all;
}

double BodyLedger::turnover() const {
  double all = 0.0;
  for (const LedgerEntry& entry : of) all += std::abs(entry.motion) + std::abs(entry.stored);
  return all;
}

BodyLedger& BodyLedger::operator+=(const BodyLedger& more) {
  for (std::size_t s = 0; s < kLedgerSources; ++s) of[s] += more.of[s];
  rise += more.rise;
  return *this;
}

BodyLedger FrameLedger::world() const {
  BodyLedger all;
  for (const BodyLedger& body : bodies) all += body;
  return all;
}

double energy_from(const FrameLedger* ledger, LedgerSource source, int body) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (ledger == nullptr) return kNone;
  if (body < 0) return ledger->world().figure(source);
  const auto index = static_cast<std::size_t>(body);  // of a body that was added later there is nothing to tell
  return index < ledger->bodies.size() ? ledger->bodies[index].figure(source) : kNone;
}

std::optional<LargestRise> largest_rise(const FrameLedger& ledger) {
  LargestRise largest;
  for (std::size_t b = 0; b < ledger.bodies.size(); ++b)
    for (const LedgerSourceInfo& info : ledger_sources()) {
      if (info.is_exchange) continue;
      const BodyLedger& body = ledger.bodies[b];
      const double energy = body.figure(info.source);
      if (energy > largest.energy)
        largest = {b, info.source, energy, body.substep[static_cast<std::size_t>(info.source)]};
    }
  if (largest.energy == 0.0) return std::nullopt;
  return largest;
}

}  // namespace impinge
