// Errors of a run against a reference, from what both wrote, and the window of time in which they mean something.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "viewer/sweep/reference.hpp"

namespace impinge {

/// Seconds from the start over which errors are taken, and why so long.
struct ErrorWindow {
  double seconds = std::numeric_limits<double>::infinity();
  std::string reason;  ///< one line
};

/// The time up to which the run that started aside stays within 1e-3 scene sizes of the reference, with how fast they
/// part.
ErrorWindow automatic_window(const std::filesystem::path& reference, const std::filesystem::path& perturbed,
                             const std::vector<std::string>& bodies);

/// Errors over the frames that both runs have at the same time within the window; -1 where there is nothing to compare.
/// Points of surfaces with other triangles than the reference's are compared with what is nearest at the start.
struct SweepErrors {
  double rms = -1.0;       ///< m: root of the mean square over surface points of the bodies and over frames
  double relative = -1.0;  ///< rms over the diagonal of the box around the bodies at the start
  /// N: root of the mean square over frames of the difference of net contact forces, all pairs of bodies together
  double force = -1.0;
  double force_relative = -1.0;  ///< over the same of the reference's forces
  double penetration = 0.0;      ///< m: largest of the run less largest of the reference
  double energy = -1.0;          ///< J: largest difference of a frame
  double momentum = -1.0;        ///< N·s: largest difference of a frame
  double seconds = 0.0;          ///< of the last frame compared
  double apart = -1.0;           ///< m: largest distance of points matched by where they begin; -1 where none had to be
  std::string mismatch;          ///< why the surfaces have no points to compare, "" if they have
  bool exist() const { return rms >= 0.0; }
};
SweepErrors sweep_errors(const std::filesystem::path& run, const std::filesystem::path& reference,
                         const std::vector<std::string>& bodies, double window);

/// The same against a formula: positions only. The surfaces of the run's own frame 0 are what moves.
SweepErrors analytic_errors(const std::filesystem::path& run, const AnalyticMotion& motion,
                            const std::vector<std::string>& bodies, ErrorWindow& window);

}  // namespace impinge
