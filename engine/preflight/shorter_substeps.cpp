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

std::string enough_damping(const Parameters& parameters) {
  const double beta = kEnoughDamping * parameters.simulation.time_step();
  const double digit = std::pow(10.0, std::floor(std::log10(beta)) - 1.0);  // the second one
  return fmt::format("material.damping = [0, {:.2g}]", std::ceil(beta / digit) * digit);
}

}  // namespace impinge
