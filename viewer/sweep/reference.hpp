// What errors of a sweep are against: other settings, the finest job, or a formula; and how far in time that means
// anything.
#pragma once

#include "viewer/sweep/table.hpp"
#include "viewer/sweep/values.hpp"

namespace impinge {

/// The changes with each of `settings` (PATH=VALUE) in place of the one of that path.
std::vector<std::string> with_settings(std::vector<std::string> changes, const std::vector<std::string>& settings);

/// Whether a row says by what method something is computed, not what: response, cone solver, detection, integrator. A
/// reference has one method for all jobs, or each method would be measured against itself.
bool chooses_method(const Parameter& row);

/// PATH=VALUE of each varied row that chooses a method and that `settings` do not name, as the scene has it.
std::vector<std::string> scene_methods(const std::vector<SweepAxis>& axes, const std::vector<std::string>& settings,
                                       const Session& session);

/// Whether the path is one of the two that make Δt = simulation.frame_time / simulation.substeps.
bool is_time_step_path(const std::string& path);

/// For each row the one with the smallest Δt among those that agree with it in all other paths (with `zip`: in those
/// whose values are no numbers). Throws InputError where neither path is varied or two share the smallest.
std::vector<std::size_t> finest_rows(const std::string& place, const std::vector<SweepAxis>& axes,
                                     const std::vector<SweepRow>& rows, bool zip, const Session& session);

/// The changes with every body that moves shifted by 1e-9 of the scene's size, each in a direction of its own; bodies
/// with held nodes get that much velocity a second instead, since held nodes are named by where they start.
std::vector<std::string> perturbed_settings(const std::vector<std::string>& changes, const Session& session);

/// A formula for scenes in which bodies that move only translate.
struct AnalyticMotion {
  std::function<Vec3(const std::string& body, double time)> displacement;  ///< since time 0, metres
  bool ends_with_contact = false;                                          ///< it holds as long as there is none
};
/// A line of `impinge list cases`, and what `--reference case:NAME` stands for.
struct AnalyticCase {
  std::string name, doc;
  AnalyticMotion (*motion)(const Session&);
};
const std::vector<AnalyticCase>& analytic_cases();
/// "free_fall, sliding, bouncing"
std::string analytic_case_names();
/// Throws InputError, without a place, for an unknown name and for a scene that the formula doesn't cover.
AnalyticMotion analytic_motion(const std::string& name, const Session& session);

}  // namespace impinge
