// What of a sub-step's answer the next ones need.
#pragma once

#include "engine/step/sleeping.hpp"
#include "engine/step/sub_step.hpp"

namespace impinge {

/// Keeps the impulses that the next sub-step starts from; sleepers keep theirs for the day they wake.
void remember_impulses(const Bodies& bodies, std::span<const GroupResult> results, ContactCache& cache);

/// What the results' contacts carry, to start another solve from.
ContactCache impulses_of(std::span<const GroupResult> results);

/// (body, scripted body) of all contacts that were solved.
std::vector<BodyEnds> find_supports(const Bodies& bodies, std::span<const GroupResult> results);

/// By body, how fast recovery from overlap moved it, m/s; the groups' results in their order.
std::vector<double> push_out_speeds(const Bodies& bodies, std::span<const CollisionGroup> groups,
                                    std::span<const GroupResult> results);

}  // namespace impinge
