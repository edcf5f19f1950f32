// Every parameter of the model, declared once: member, path, unit, range, default, meaning (parameters.cpp).
#pragma once

#include "engine/core/parameter.hpp"

namespace impinge {

struct Parameters {
  struct Simulation {
    double frame_time = 1.0 / 60.0;
    int substeps = 4;
    Vec3 gravity{0.0, -9.81, 0.0};
    std::string integrator = "linearly_implicit_euler";
    bool sleeping = true;
    double sleep_speed = 1e-4;
    double sleep_time = 0.5;
    std::string linear_solver = "automatic";
    double time_step() const { return frame_time / substeps; }  ///< Δt of every formula
  } simulation;
  struct Contact {
    std::string points = "proximity";
    double activation_distance = 1e-3;
    double friction = 0.3;
    double restitution = 0.0;
    double restitution_threshold = 0.01;
    double max_push_out = 1.0;
    std::string push_out = "split";
    bool warm_start = true;
  } contact;
  struct Named {
    std::string method;
  };
  Named broad_phase{"sweep_and_prune"};
  Named narrow_phase{"spatial_hash"};
  struct Response {
    std::string method = "constraint_anticipation";
    std::string form = "accelerated";
    std::string stop = "residual";
    int max_iterations = 2000;
    int impulse_iterations = 200;
    std::string penalty_form = "implicit";
    double penalty_stiffness = 0.0;
    double penalty_damping = 0.0;
    double penalty_slip_speed = 1e-3;
    double soft_frequency = 30.0;
    double soft_damping_ratio = 10.0;
    int soft_iterations = 2;
    int soft_relax_iterations = 1;
  } response;
  struct Lcp {
    std::string method = "automatic";
    double tolerance = 1e-8;
    int max_iterations = 1000;
  } lcp;

  /// Declares the rows `simulation.*`, `contact.*`, `broad_phase.method`, … The set refers to this object.
  void bind(ParameterSet& set);
};

}  // namespace impinge
