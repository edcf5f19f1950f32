// What came out of a sweep, a row a job: results.csv, a table for the terminal, and the errors against references.
#pragma once

#include "viewer/app/sweep_job.hpp"

namespace impinge {

struct SweepRow {
  std::string hash, reference;      ///< reference "" without one
  std::vector<std::string> values;  ///< of the varied paths
  SweepOutcome outcome;
  std::vector<std::string> cells;   ///< figures(), in the order of figure_columns(); empty where there is no figure
  double work_ms = 0.0;             ///< sum of step_ms
  double error = -1.0;              ///< metres, -1 for none
  double relative_error = -1.0;     ///< in sizes of the scene
};

/// Columns between `reason` and the errors: of the last frame and the largest of all; energies relative to frame 0.
const std::vector<std::string>& sweep_figure_columns();

/// Fills outcome, cells and work from a job's folder.
void measure_sweep_job(const std::filesystem::path& folder, SweepRow& row);

/// Distance between the surfaces that two runs exported: the root of the mean square over points and over the frames
/// that both have at the same time, for the named bodies, in metres; and the diagonal of the box around those bodies at the
/// reference's frame 0.
struct SurfaceDistance {
  double rms = -1.0, scene_size = 0.0;  ///< rms -1: no frame or no body in common
};
SurfaceDistance surface_distance(const std::filesystem::path& run, const std::filesystem::path& reference, const std::vector<std::string>& bodies);

std::string sweep_csv(const std::vector<std::string>& paths, const std::vector<SweepRow>& rows, bool has_reference);
std::string sweep_summary(const std::vector<std::string>& paths, const std::vector<SweepRow>& rows, bool has_reference);

}  // namespace impinge
