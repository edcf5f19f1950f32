#include "viewer/study/methods_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "engine/core/error.hpp"
#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"

namespace impinge {

namespace fs = std::filesystem;

std::vector<int> early_stops(int most) {
  std::vector<int> stops;
  for (int k = 1; k < most; k *= 2) stops.push_back(k);
  return stops;
}

namespace {

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

TablePrinter::TablePrinter(bool has_bodies) : has_bodies_(has_bodies) {
  fmt::print("{:<42}{:>11}{}{:>11}{:>11}{:>13}{:>11}{:>9}{}{:>11}  {}\n", "method", "iterations",
             has_bodies ? "  outer" : "", "ms", "residual", "natural map", "relative", "contact",
             has_bodies ? "   momentum" : "", "distance", "stop");
}

void TablePrinter::row(const MethodReport& r) {
  std::string name = r.method;
  if (const std::size_t at = name.find('-'); at != std::string::npos) {
    if (name.substr(0, at) != response_) fmt::print("{}\n", response_ = name.substr(0, at));
    name = "  " + name.substr(at + 1);
  }
  const auto figure = [](double value) { return std::isfinite(value) ? fmt::format("{:.2e}", value) : "-"; };
  const std::string outer = has_bodies_ ? fmt::format("{:>7}", r.outer_iterations) : "",
                    momentum = has_bodies_ ? fmt::format("{:>11}", figure(r.momentum)) : "";
  fmt::print("{:<42}{:>11}{}{:>11.2f}{:>11}{:>13}{:>11}{:>9}{}{:>11}  {}\n", name, r.iterations, outer, r.ms,
             figure(r.residual), figure(r.natural_map), figure(r.natural_map_relative), r.worst_contact, momentum,
             (r.distance_is_bound ? "<" : "") + figure(r.distance), r.stop_reason);
  std::fflush(stdout);
}

namespace {

std::string methods_table(const StepReport& report) {
  std::string text =
      "method,iterations,ms,residual,stop_reason,natural_map_m_per_s,natural_map_relative,worst_contact,"
      "complementarity_J,cone_violation_Ns,outer_iterations,"
      "momentum_m_per_s,distance_to_exact\n";
  for (const MethodReport& r : report.methods)
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.method, r.iterations, r.ms, cell(r.residual),
                        r.stop_reason, cell(r.natural_map), cell(r.natural_map_relative), r.worst_contact,
                        cell(r.complementarity), cell(r.cone_violation), r.outer_iterations, cell(r.momentum),
                        cell(r.distance));
  return text;
}

Plot history_plot(const StepReport& report) {
  Plot plot{report.title + ": residual by iteration", "iteration", report.residual_label, {}, true};
  for (const MethodReport& r : report.methods) {
    if (r.history.empty()) continue;
    PlotSeries series{r.method, {}};
    for (std::size_t k = 0; k < r.history.size(); ++k) series.points.emplace_back(static_cast<double>(k), r.history[k]);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot work_plot(const StepReport& report) {
  Plot plot{report.title + ": error against time, by stopping early",
            "time, ms",
            report.plots_distance ? report.distance_label : report.residual_label,
            {},
            false};
  for (const MethodReport& r : report.methods) {
    PlotSeries series{r.method, {}};
    for (const WorkPoint& p : r.work) series.points.emplace_back(p.ms, report.plots_distance ? p.distance : p.residual);
    if (!series.points.empty()) plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

void write_report(const fs::path& folder, const StepReport& report) {
  make_folder(folder);
  std::string work = "method,iterations_allowed,ms,residual,distance_to_exact\n";
  for (const MethodReport& r : report.methods) {
    if (r.lambda.empty()) continue;
    std::string text = "contact," + report.solution_head + "r_n,r_t1,r_t2\n";
    for (std::size_t i = 0; i < r.lambda.size(); ++i)
      text += fmt::format("{},{}{},{},{}\n", i, report.solution_columns[i], r.lambda[i].x(), r.lambda[i].y(),
                          r.lambda[i].z());
    write_file(folder / ("solution_" + r.method + ".csv"), text);
    text = "iteration,residual\n";
    for (std::size_t i = 0; i < r.history.size(); ++i) text += fmt::format("{},{}\n", i, cell(r.history[i]));
    write_file(folder / ("history_" + r.method + ".csv"), text);
    for (const WorkPoint& p : r.work)
      work += fmt::format("{},{},{},{},{}\n", r.method, p.iterations_allowed, p.ms, cell(p.residual), cell(p.distance));
  }
  write_file(folder / "work_precision.csv", work);
  const std::vector<Image> pictures = paint_plots({history_plot(report), work_plot(report)}, 1280, 720);
  write_png(folder / "history.png", pictures[0]);
  write_png(folder / "work_precision.png", pictures[1]);
  write_file(folder / "methods.csv", methods_table(report));  // last: whoever finds it finds the rest
}

}  // namespace impinge
