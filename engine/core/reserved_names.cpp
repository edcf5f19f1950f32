#include "engine/core/reserved_names.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace impinge {

namespace {

using Word = std::pair<std::string_view, std::string_view>;
constexpr Word kReserved[] = {
    {"response.method", "constraint_anticipation"},
    {"response.method", "iterative_constraint_anticipation"},
    {"response.method", "penalty"},
    {"response.method", "sequential_impulse"},
    {"response.method", "simultaneous_impulse"},
    {"broad_phase.method", "brute_force"},
    {"broad_phase.method", "sweep_and_prune"},
    {"broad_phase.method", "bvh"},
    {"narrow_phase.method", "brute_force"},
    {"narrow_phase.method", "spatial_hash"},
    {"narrow_phase.method", "bvh"},
    {"narrow_phase.method", "distance_field"},
    {"narrow_phase.method", "continuous"},
    {"simulation.integrator", "linearly_implicit_euler"},
    {"simulation.integrator", "implicit_euler"},
    {"simulation.integrator", "newmark"},
    {"simulation.integrator", "symplectic_euler"},
    {"lcp.method", "projected_gauss_seidel"},
    {"material.model", "linear"},
    {"material.model", "corotational"},
    {"material.model", "fixed_corotated"},
    {"material.model", "stvk"},
    {"material.model", "neo_hookean"},
    {"material.model", "mass_spring"},
};

}  // namespace

bool is_reserved_name(std::string_view path, std::string_view name) {
  return std::find(std::begin(kReserved), std::end(kReserved), Word{path, name}) != std::end(kReserved);
}

}  // namespace impinge
