// Fast bodies against thin ones: what is shot at what, how fast, and whether it passed. Every frame of these worlds is one
// sub-step, so that the end of each can be judged.
#pragma once

#include <string>

#include "engine/world/world.hpp"

namespace impinge::test {

struct Shot {
  std::string mover;   ///< box, hull, cube, icosphere, bunny (0.1 m), rod_box, rod_mesh (1 m x 20 mm)
  std::string target;  ///< plate_1m, plate_50, plate_20 (edges; 2 mm), foil (0.1 mm), moving_plate, shell, post
  double speed = 1.0;  ///< m/s; of a rod rad/s
  int substeps = 4;    ///< of 1/60 s
  std::uint64_t seed = 1;
  std::string response = {};  ///< empty: the default
  Continuous continuous = Continuous::when_needed;
};

struct ShotResult {
  bool has_passed = false;
  bool has_hit = false;
  double overlap = 0.0;     ///< largest at the end of a sub-step, metres, by the judge
  double shown = 0.0;       ///< largest max_penetration_m, which is all a user sees of it
  double thickness = 0.0;   ///< of the thinner of the two, metres
  std::int64_t unsafe = 0;  ///< unsafe_motions, summed
  std::int64_t unconverged = 0;
  double energy = 0.0;              ///< largest kinetic energy over that of the start
  double ms = 0.0, worst_ms = 0.0;  ///< of a sub-step: mean and largest
  std::string error;                ///< of a run that ended with one
};

/// Empty mesh: the shared data folder has no bunny.
bool can_shoot(const std::string& mover);
ShotResult shoot(const Shot& shot);

}  // namespace impinge::test
