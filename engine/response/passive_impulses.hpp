// Impulses that would win energy, made less.
#pragma once

namespace impinge {

/// The share of impulses with which bodies keep the energy that they came with, where all of them would win some; else 1.
/// `came`, `left`: the sums of impulse times velocity before and after all of it, J.
inline double passive_share(double came, double left) {
  return came + left <= 0.0 || came >= 0.0 ? 1.0 : -2.0 * came / (left - came);
}

}  // namespace impinge
