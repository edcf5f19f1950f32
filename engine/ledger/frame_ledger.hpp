// The books of a frame: what raised the energy, momentum and angular momentum of each body, by source, as values. How
// the entries come about: ledger.hpp.
//
// Two books are kept for the energy of a body, J:
//   motion   T, kinetic energy
//   stored   U = V + W, potential energy −Σ m g·x and elastic energy
// Gravity and elasticity take from what is stored what they give to the motion, so that their entries are of opposite
// signs and make no energy; every other source makes or takes what its two entries add up to. So
//   ΔT = Σ motion,   ΔU = Σ stored,   ΔE = Σ (motion + stored)
// with the left sides measured at the two ends of the frame, and what is between left and right is the closing error: no
// source is found as the rest.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/bodies/balance.hpp"

namespace impinge {

enum class LedgerSource : std::uint8_t {
  gravity,
  elastic,
  damping,
  impact,
  friction,
  attachment,
  script,
  push_out,
  held_back,
  sleep,
  solver,
  integrator
};
inline constexpr std::size_t kLedgerSources = 12;

struct LedgerSourceInfo {
  LedgerSource source;
  std::string_view name;  ///< a word
  std::string_view doc;   ///< one sentence
  bool is_exchange;       ///< between what is stored and the motion: it makes no energy
};
/// In the order of the enumeration.
const std::array<LedgerSourceInfo, kLedgerSources>& ledger_sources();
inline const LedgerSourceInfo& info_of(LedgerSource s) { return ledger_sources()[static_cast<std::size_t>(s)]; }
/// Nothing where there is none of that name.
std::optional<LedgerSource> find_ledger_source(std::string_view name);

/// What one source did to one body.
struct LedgerEntry {
  double motion = 0.0, stored = 0.0;     ///< J
  Vec3 momentum = Vec3::Zero();          ///< kg·m/s
  Vec3 angular_momentum = Vec3::Zero();  ///< about the world's origin, kg·m²/s

  double energy() const { return motion + stored; }
  LedgerEntry& operator+=(const LedgerEntry& more);
};

/// What is read of a source: of an exchange what it gave to the motion, else the energy that it made, J.
double figure_of(LedgerSource source, const LedgerEntry& entry);

/// Of one body, or of all of them.
struct BodyLedger {
  std::array<LedgerEntry, kLedgerSources> of;
  /// What was measured: end less beginning.
  Balance rise;
  /// The sub-step in which the source did most to its energy, from 1 on; 0: none, or between frames.
  std::array<int, kLedgerSources> substep = {};

  LedgerEntry& operator[](LedgerSource s) { return of[static_cast<std::size_t>(s)]; }
  const LedgerEntry& operator[](LedgerSource s) const { return of[static_cast<std::size_t>(s)]; }
  double figure(LedgerSource s) const { return figure_of(s, (*this)[s]); }
  /// Σ over the sources.
  LedgerEntry sum() const;
  /// What the sources don't explain, J: of each of the two books, and of both.
  double motion_error() const { return rise.kinetic - sum().motion; }
  double stored_error() const { return rise.potential + rise.elastic - sum().stored; }
  double closing_error() const { return motion_error() + stored_error(); }
  Vec3 momentum_error() const { return rise.momentum - sum().momentum; }
  Vec3 angular_momentum_error() const { return rise.angular_momentum - sum().angular_momentum; }
  /// Σ of the amounts of all entries, J: what an error is small against.
  double turnover() const;

  BodyLedger& operator+=(const BodyLedger& more);
};

struct FrameLedger {
  std::vector<BodyLedger> bodies;  ///< scene order; of what has no freedom all is zero

  /// Of all bodies: what they do to each other cancels as far as it should.
  BodyLedger world() const;
};

/// What the source did in the frame to one body, or, with a negative index, to all, J; NaN without books, or of
/// a body that was not known then.
double energy_from(const FrameLedger* ledger, LedgerSource source, int body);

/// The entry that raised the energy most: its body (an index) and source.
struct LargestRise {
  std::size_t body = 0;
  LedgerSource source = LedgerSource::gravity;
  double energy = 0.0;  ///< J
  int substep = 0;
};
/// Exchanges are left out: they raise nothing. Nothing where no source raised any.
std::optional<LargestRise> largest_rise(const FrameLedger& ledger);

}  // namespace impinge
