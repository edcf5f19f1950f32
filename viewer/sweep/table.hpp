// What came out of a sweep, a row a job: results.csv and a table for the terminal.
#pragma once

#include "viewer/sweep/job.hpp"
#include "viewer/tables/stats_table.hpp"

namespace impinge {

struct SweepRow {
  std::string hash, reference;      ///< reference "" without one
  std::string perturbed;            ///< the reference's run from a start aside, "" without one
  std::vector<std::string> values;  ///< of the varied paths
  SweepOutcome outcome;
  std::vector<std::string> cells;  ///< of sweep_figure_columns(); empty where there is no figure
  std::vector<std::string> more;   ///< of SweepTable::more
  std::string step_cpu_ms;         ///< of all steps, the median of repeats; "" where it isn't known
  std::string unsafe_motions;      ///< in all frames
  std::string doubts;              ///< why the answer isn't to be trusted, "" if the run found nothing
  double work_ms = 0.0;            ///< sum of step_ms, the median of repeats
  double error = -1.0;             ///< metres, -1 for none
  double relative_error = -1.0;    ///< in sizes of the scene
};

/// The shape of the table.
struct SweepTable {
  std::vector<std::string> paths;  ///< varied
  bool has_reference = false;
  std::vector<std::string> more;  ///< columns after the errors
};

/// Columns between `reason` and the errors: of the last frame and the largest of all; energies and momenta relative to
/// frame 0.
const std::vector<std::string>& sweep_figure_columns();
/// Columns of errors beside error_rms_m and error_relative, and those of repeats, in the order of SweepTable::more.
const std::vector<std::string>& sweep_error_columns();
const std::vector<std::string>& sweep_spread_columns();
/// Whether results.csv has, or may have, a column of that name.
bool is_sweep_column(const std::string& name);

/// The whole frames of a run's stats.csv; empty where there is none. Figures stand in the order of figure_names(true):
/// those of a judge are no numbers where nobody judged. Behind them the scene's own columns.
std::vector<StatsLine> sweep_stats(const std::filesystem::path& run);

/// What a job's folder says: outcome, figures, times as medians over the repeats and their spreads (largest less
/// smallest).
struct SweepMeasure {
  std::vector<std::vector<StatsLine>> runs;  ///< the job's own first, then the repeats'
  std::vector<std::string> spreads;          ///< of sweep_spread_columns()
};
/// Fills outcome, cells and work. A repeat whose states differ from the first run's makes the outcome `unequal`, with
/// where.
SweepMeasure measure_sweep_job(const std::filesystem::path& folder, int repeats, SweepRow& row);

/// Where a figure stands in a line of sweep_stats().
inline std::size_t sweep_figure(std::string_view name) { return figure_index(name, true); }

double median(std::vector<double> values);

/// Three digits for people to read, as the report's pages write them: 4690, 0.0365, 8.11e-06; whole numbers below a
/// million whole.
std::string three_digits(double value);

std::string sweep_csv(const SweepTable& table, const std::vector<SweepRow>& rows);
std::string sweep_summary(const SweepTable& table, const std::vector<SweepRow>& rows);

}  // namespace impinge
