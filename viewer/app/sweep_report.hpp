// A sweep to look at: report.html, which needs nothing beside it, and work_precision.png.
#pragma once

#include "viewer/app/sweep_table.hpp"

namespace impinge {

struct SweepReport {
  std::string scene;                   ///< as the user named it
  std::string command;                 ///< what was varied, in one line
  std::vector<std::string> paths;      ///< varied
  std::vector<std::string> reference;  ///< PATH=VALUE, empty without errors
  std::vector<SweepRow> rows;
  double seconds_per_run = 0.0;        ///< simulated: the window that errors are means over
};

/// The table with links to the runs, and error against time where there are errors: a line for each combination of the
/// values that are no numbers or that the reference leaves alone, those that nothing beats in both ringed.
std::string sweep_html(const SweepReport& report);

/// Writes report.html, and work_precision.png if at least one job has an error. Throws InputError where that fails.
void write_sweep_report(const std::filesystem::path& out, const SweepReport& report);

}  // namespace impinge
