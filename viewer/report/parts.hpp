// Parts of a sweep's report, each made from the table and the jobs' folders.
#pragma once

#include <filesystem>

#include "viewer/panels/overlay/heat_table.hpp"
#include "viewer/panels/overlay/plot.hpp"
#include "viewer/report/html.hpp"
#include "viewer/report/table.hpp"

namespace impinge {

std::string json_text(const std::string& text);  ///< with its quotes; never holds "</"

/// What the plots show before anybody chooses; -1: no such column.
struct ReportChoice {
  int x = -1, y = -1, measure = -1;
  bool has_errors = false;
};
ReportChoice choose_columns(const ReportTable& table);

/// Error against time, a line for each combination of the values that lines don't go along (ReportColumn::is_joined).
Plot work_precision_plot(const ReportTable& table, const ReportChoice& choice, const std::string& title);

/// The first two parameters that were varied against each other, the others at their first values; false if there are
/// none.
bool heat_table_of(const ReportTable& table, const ReportChoice& choice, const std::string& title, HeatTable& heat);

/// Small copies of chosen frames of each job, as JSON; "null" where no job has pictures. `frame_time` in seconds; 0: it
/// differs from job to job.
std::string frames_json(const ReportTable& table, const std::filesystem::path& out, double frame_time);

/// What the jobs modelled and left out, and the table of `impinge info --ablation` where out/ablation.csv has one.
std::string model_html(const ReportTable& table, const std::filesystem::path& out);
std::string ablation_html(const std::filesystem::path& out, const std::string& scene);

/// Machine, versions and the noise of the timings.
std::string machine_html(const ReportTable& table, const std::filesystem::path& out);

}  // namespace impinge
