// The books of worlds, for tests: kept while they run, and summed.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/ledger/frame_ledger.hpp"
#include "tests/support/mechanics/worlds.hpp"

namespace impinge::test {

/// Books of a whole run, by body, and the worst that they were out by in any frame.
struct RunLedger {
  std::vector<BodyLedger> bodies;
  double turnover = 0.0;                          ///< largest of a body in a frame, J
  double motion_error = 0.0, stored_error = 0.0;  ///< J
  double momentum_error = 0.0, spin_error = 0.0;  ///< kg m/s, kg m²/s
  double momentum_turnover = 0.0, spin_turnover = 0.0;

  double figure(LedgerSource source, std::size_t body = 0) const { return bodies.at(body).figure(source); }
  BodyLedger world() const { return FrameLedger{bodies}.world(); }
  /// Largest error as a share of the largest turnover.
  double energy_share() const { return share(std::max(motion_error, stored_error), turnover); }
  double momentum_share() const {
    // an entry of angular momentum is a sum of arms, metres, by impulses that may cancel
    return std::max(share(momentum_error, momentum_turnover), share(spin_error, spin_turnover + momentum_turnover));
  }

  void add(const FrameLedger& frame) {
    bodies.resize(frame.bodies.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const BodyLedger& of = frame.bodies[b];
      bodies[b] += of;
      turnover = std::max(turnover, of.turnover());
      motion_error = std::max(motion_error, std::abs(of.motion_error()));
      stored_error = std::max(stored_error, std::abs(of.stored_error()));
      momentum_error = std::max(momentum_error, of.momentum_error().norm());
      spin_error = std::max(spin_error, of.angular_momentum_error().norm());
      double momentum = 0.0, spin = 0.0;
      for (const LedgerEntry& entry : of.of) momentum += entry.momentum.norm(), spin += entry.angular_momentum.norm();
      momentum_turnover = std::max(momentum_turnover, momentum);
      spin_turnover = std::max(spin_turnover, spin);
    }
  }

 private:
  static double share(double error, double size) { return error == 0.0 ? 0.0 : error / size; }
};

/// The world is started already.
inline RunLedger keep_books(World& world, int frames) {
  world.parameters.record.ledger = true;
  RunLedger books;
  for (int i = 0; i < frames; ++i) {
    world.step();
    books.add(*world.record().stats.ledger);
  }
  return books;
}

}  // namespace impinge::test
