// Bodies that hang in one another, made by formula: chains, arms on pins, a bolt in its nut, an arch of stones.
#pragma once

#include <string>

#include "engine/world/world.hpp"

namespace impinge::test {

inline constexpr double kLinkMajor = 0.1, kLinkMinor = 0.02;  ///< metres, radii of the chain's links

struct Assembly {
  std::string name;  ///< chain, arms, rollers, bolt, arch
  int count = 2;     ///< of links, arms, stones; a bolt has none
  int substeps = 1;  ///< of frame_time 0.01 s
  double seconds = 1.0;
};

struct AssemblyResult {
  double thickness = 0.0;  ///< of the thinnest part that carries, metres
  double overlap = 0.0;    ///< largest at the end of a sub-step, metres, by the judge, edges included
  double by_vertices = 0.0;
  int contacts = 0;  ///< most of a pair of bodies
  std::int64_t unconverged = 0, unsafe = 0;
  double gain = 0.0;                         ///< J, the most that was ever won over the start
  double fall = 0.0;                         ///< J, the most that the weight gave
  double reach = 0.0;                        ///< metres: how far the last body moved from its place
  double median_ms = 0.0, dearest_ms = 0.0;  ///< of a frame
  int dearest_frame = 0;
};

/// An empty world takes the bodies and the frame.
void assemble(const Assembly& what, World& world);
/// Runs it; the judge looks at the end of every sub-step, or of frames only.
AssemblyResult run(const Assembly& what, bool every_substep, int second_looks = 4);

}  // namespace impinge::test
