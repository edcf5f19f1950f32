#include "engine/preflight/shorter_substeps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace impinge {
namespace {

constexpr double kMostSubsteps = 1000;  // that the parameter takes

}  // namespace

std::string shorter_substeps(const Parameters& parameters, double times) {
  const double substeps = std::ceil(parameters.simulation.substeps * times);
  return substeps <= kMostSubsteps ? fmt::format("simulation.substeps = {:.0f}", substeps)
                                   : fmt::format("divide simulation.frame_time by {:.0f}", std::ceil(times));
}

}  // namespace impinge
