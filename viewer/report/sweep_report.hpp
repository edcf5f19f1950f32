// A sweep to look at: report.html, which needs nothing beside it (links lead into jobs/), work_precision.png and
// heat_map.png. All of it comes from results.csv, whatever columns that has, and from the folders of the jobs.
#pragma once

#include <filesystem>

#include "viewer/controller/session.hpp"

namespace impinge {

struct SweepReport {
  std::string scene;  ///< as the user named it
  bool zip = false;
  std::vector<std::string> paths;      ///< varied
  std::vector<std::string> reference;  ///< PATH=VALUE, PATH=finest or case:NAME; empty without errors
  std::string errors;                  ///< how they were taken, as describe_errors() says it; empty without errors
  std::string caution;                 ///< to be read before them, "" for nothing
  double seconds_per_run = 0.0;        ///< simulated
};

/// Reads out/results.csv and writes the report beside it; work_precision.png only if a job has an error, heat_map.png
/// only if two parameters were varied against each other. `base` is the scene that was varied. Throws InputError where
/// that fails.
void write_sweep_report(const std::filesystem::path& out, const SweepReport& report, const Session& base);

}  // namespace impinge
