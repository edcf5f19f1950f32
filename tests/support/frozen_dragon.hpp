// The seed's dragon scene, frozen where it is hardest.
#pragma once

#include "engine/world/frozen_comparison.hpp"
#include "viewer/controller/session.hpp"

namespace impinge::test {

/// The frame of most contacts among the first `frames`.
inline FrozenStep hardest_frame(const std::vector<std::string>& overrides, int frames) {
  const std::filesystem::path scene = std::filesystem::path(IMPINGE_SOURCE_DIR) / "scenes/dragon_spheres";
  Session session(scene.string() + ".toml", overrides, scene.string() + ".script");
  FrozenStep hardest, step;
  session.advance();
  for (int frame = 1; frame <= frames; ++frame) {
    session.advance(&step);
    if (step.contacts() > hardest.contacts()) hardest = std::move(step);
  }
  return hardest;
}

/// Solved far beyond what a run asks for.
inline FrozenOutcome solved(const FrozenStep& step, const char* response, const char* solver, double tolerance) {
  ResponseSettings settings;
  settings.lcp = {tolerance, 20000};
  settings.max_outer_iterations = 20000;
  return solve_frozen(step, *find_entry(responses(), response)->make(), *find_entry(lcp_solvers(), solver)->make(), settings);
}

}  // namespace impinge::test
