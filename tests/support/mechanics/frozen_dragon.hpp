// The seed's dragon scene, frozen where it is hardest.
#pragma once

#include <algorithm>

#include "engine/frozen/frozen_comparison.hpp"
#include "tests/support/mechanics/methods.hpp"
#include "viewer/controller/session.hpp"

namespace impinge::test {

/// The last sub-step of each of the first `frames`.
inline std::vector<FrozenStep> dragon_frames(const std::vector<std::string>& overrides, int frames) {
  const std::filesystem::path scene = std::filesystem::path(IMPINGE_SOURCE_DIR) / "scenes/dragon_spheres";
  Session session(scene.string() + ".toml", overrides, scene.string() + ".script");
  std::vector<FrozenStep> steps(static_cast<std::size_t>(frames));
  session.advance();
  for (FrozenStep& step : steps) session.advance(&step);
  return steps;
}

/// The frame of most contacts among them.
inline FrozenStep hardest_frame(const std::vector<std::string>& overrides, int frames) {
  std::vector<FrozenStep> steps = dragon_frames(overrides, frames);
  return std::move(*std::max_element(steps.begin(), steps.end(), [](const FrozenStep& l, const FrozenStep& r) {
    return l.contacts() < r.contacts();
  }));
}

/// Solved far beyond what a run asks for.
inline FrozenOutcome solved(const FrozenStep& step, const char* response, const char* solver, double tolerance) {
  ResponseContext context;
  context.lcp = {tolerance, 20000};
  return solve_frozen(step, *patient_response(response, 20000, by_itself(response)), *make_named(lcp_solvers(), solver),
                      context);
}

}  // namespace impinge::test
