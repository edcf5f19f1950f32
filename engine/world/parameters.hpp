// Every parameter of the model, declared once: member, path, unit, range, default, meaning (parameters.cpp). What belongs
// to one method is that method's own: it keeps and declares it, below its name.
#pragma once

#include "engine/contact/contact_settings.hpp"
#include "engine/core/method_set.hpp"
#include "engine/detection/broadphase/broad_phase.hpp"
#include "engine/detection/triangles/narrow_phase.hpp"
#include "engine/integrators/deformable_integrator.hpp"
#include "engine/response/response.hpp"
#include "engine/step/detect.hpp"
#include "engine/step/motion_guard.hpp"
#include "engine/step/respond.hpp"

namespace impinge {

struct Parameters {
  struct Simulation {
    double frame_time = 1.0 / 60.0;
    int substeps = 4;
    Vec3 gravity{0.0, -9.81, 0.0};
    MethodSet<DeformableIntegrator> integrator{integrators()};
    VelocityTime velocities = VelocityTime::end;
    bool sleeping = true;
    Threshold sleep_speed{4.9e-5};  ///< part of √(g·size) of a body
    Threshold sleep_time{2.4};      ///< part of √(size/g) of a body
    LinearSolverChoice linear_solver;
    double time_step() const { return frame_time / substeps; }  ///< Δt of every formula
  } simulation;
  ContactSettings contact;
  struct Broad {
    MethodSet<BroadPhase> method{broad_phases()};
  } broad_phase;
  struct Narrow {
    MethodSet<NarrowPhase> method{narrow_phases()};
    Continuous continuous = Continuous::when_needed;
  } narrow_phase;
  struct Responses {
    MethodSet<Response> method{responses()};
  } response;
  struct Lcp {
    MethodSet<LcpSolver> method{lcp_solvers()};
    double tolerance = 1e-8;
    int max_iterations = 1000;
  } lcp;

  /// What is kept of frames; nothing of it changes one.
  struct Record {
    bool ledger = false;
  } record;

  /// Declares the rows `simulation.*`, `contact.*`, `broad_phase.method`, … The set refers to this object.
  void bind(ParameterSet& set);
  /// Those that frames depend on: all but `record.*`.
  void bind_model(ParameterSet& set);
};

/// Values by path, former ones too, as a frozen step holds them. Paths that this program lacks are passed over: they are
/// of methods that it can't run either. Throws InputError for a value that isn't allowed.
void take_settings(std::span<const RowText> values, Parameters& parameters);

/// What the parameters tell a cone solver, a response, time integration, and the stages that detect and solve. They refer
/// to the parameters.
LcpSettings lcp_settings(const Parameters& parameters);
ResponseContext response_context(const Parameters& parameters);
TimeIntegration time_integration(const Parameters& parameters);
Detecting detecting(const Parameters& parameters);
/// Which motions are looked at: as narrow_phase.continuous says, and for "auto" the method.
Continuous watching(const Parameters& parameters);
Solving solving(const Parameters& parameters);

}  // namespace impinge
