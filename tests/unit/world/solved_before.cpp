// Whether a second look's solve is given up for the answer before it, which did not know what the look found.
#include <catch2/catch.hpp>

#include "engine/step/second_look.hpp"

using namespace impinge;

namespace {

/// A step of one group whose solve ended so, with this residual, m/s.
SubStep step_of(StopReason ended, double residual) {
  SubStep step;
  step.groups.resize(1);
  step.groups.front().bodies = {BodyIndex(0)};
  step.results.resize(1);
  step.results.front().response.ended = ended;
  step.results.front().verdict.natural_map = residual;
  step.results.front().verdict.relative = residual;
  return step;
}

}  // namespace

TEST_CASE("an answer that overlooks what goes in far faster than a new solve leaves is not the better one") {
  const SubStep answered = step_of(StopReason::converged, 1e-9), unanswered = step_of(StopReason::stagnated, 0.02);
  const SolvedBefore before(answered, answered.contacts({}));
  CHECK(before.was_better(unanswered, 0.0));
  CHECK(before.was_better(unanswered, 0.1));
  CHECK_FALSE(before.was_better(unanswered, 10.0));
  CHECK_FALSE(before.was_better(step_of(StopReason::converged, 1e-9), 0.0));
  CHECK_FALSE(before.was_better(step_of(StopReason::stagnated, 5e-5), 0.0));
}
