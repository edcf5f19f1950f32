// Stage 2 of a sub-step: what is moved along a given path gets the velocity that brings it on.
#pragma once

#include "engine/bodies/bodies.hpp"

namespace impinge {

/// Scripted bodies and held nodes move from where they are at `time` to where they are at time + h, s. Of what is left
/// of displacements asked for by parameters, `share` is covered (1: all).
void drive(Bodies& bodies, double time, double h, double share);

/// Puts scripted bodies where they are at `time`.
void place(Bodies& bodies, double time);

}  // namespace impinge
