#include "viewer/report/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "viewer/sweep/table.hpp"

namespace impinge {

namespace {

std::string code(const std::string& text) { return "<code>" + html_text(text) + "</code>"; }

std::string item(const char* head, const std::string& text) {
  return fmt::format("<li><b>{}</b> {}</li>\n", head, text);
}

std::string varied_text(const SweepReport& report, const ReportTable& table) {
  std::string text;
  for (const std::string& path : report.paths) {
    const int c = table.column(path);
    if (c < 0) continue;
    const ReportColumn& column = table.columns[static_cast<std::size_t>(c)];
    std::vector<std::string> values;
    for (const auto& row : table.rows)
      if (std::find(values.begin(), values.end(), row[static_cast<std::size_t>(c)]) == values.end())
        values.push_back(row[static_cast<std::size_t>(c)]);
    if (values.size() > 12) values = {values[0], values[1], values[2], "…", values[values.size() - 2], values.back()};
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + (value == "…" ? value : code(value));
    text += fmt::format("{}{}{}: {}", text.empty() ? "" : "; ", code(path),
                        column.unit.empty() ? "" : " (" + html_text(column.unit) + ")", list);
  }
  return text + (report.zip                ? ". Their first values together, then the second ones, and so on."
                 : report.paths.size() > 1 ? ". Every combination is a job."
                                           : ". Each value is a job.");
}

// answers that the jobs' own runs don't trust
std::string doubts_text(const ReportTable& table) {
  int doubted = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) doubted += table.cell(i, "doubts").empty() ? 0 : 1;
  if (doubted == 0) return "";
  return fmt::format(
      " <b>{} {} in doubt</b>: what {} runs found stands beside {} in the table of jobs, and {} no part in what is "
      "best.",
      doubted, doubted == 1 ? "is" : "are", doubted == 1 ? "its" : "their", doubted == 1 ? "it" : "them",
      doubted == 1 ? "it has" : "they have");
}

std::string jobs_text(const ReportTable& table) {
  std::map<std::string, int> count;
  for (std::size_t i = 0; i < table.rows.size(); ++i) ++count[table.cell(i, "status")];
  std::string text;
  const int done = count["done"];
  if (done == static_cast<int>(table.rows.size())) return fmt::format("{}, all done.", done);
  for (const auto& [status, number] : count)
    if (status != "done") text += fmt::format(", {} {}", number, status);
  return fmt::format("{}: {} done{}. What went wrong stands beside each in the table of jobs.", table.rows.size(), done,
                     text);
}

// the lines of describe_errors(), `head: text` each
std::string errors_items(const std::string& lines, const std::string& after_reference) {
  std::string html;
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    const std::string line = lines.substr(begin, end - begin);
    if (line.rfind("errors: ", 0) == 0)
      html += item("Reference:", "each job is measured " + html_text(line.substr(8)) + "." + after_reference);
    if (line.rfind("window: ", 0) == 0) html += item("Window of the errors:", html_text(line.substr(8)) + ".");
    begin = end + 1;
  }
  return html;
}

// what a job and its reference have in common hides from the error
std::string own_text(const ReportTable& table) {
  std::string own;
  int count = 0;
  for (const ReportColumn& column : table.columns)
    if (column.kind == ReportColumn::varied && !column.in_reference && column.distinct > 1)
      own += (count++ == 0 ? "" : ", ") + code(column.name);
  if (count == 0) return "";
  return fmt::format(
      " {} {} the same in a job and its reference, so the error doesn't show how far the answers for different values "
      "lie apart. The residual judges all jobs alike.",
      own, count == 1 ? "is" : "are");
}

std::string extremes_text(const ReportTable& table, const ReportChoice& choice) {
  const std::vector<bool> best = table.best(choice.x, choice.y);
  std::vector<int> varied;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].kind == ReportColumn::varied && table.columns[c].distinct > 1)
      varied.push_back(static_cast<int>(c));
  int fastest = -1, closest = -1, count = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (!best[i]) continue;
    ++count;
    if (fastest < 0 || table.number(i, choice.x) < table.number(static_cast<std::size_t>(fastest), choice.x))
      fastest = static_cast<int>(i);
    if (closest < 0 || table.number(i, choice.y) < table.number(static_cast<std::size_t>(closest), choice.y))
      closest = static_cast<int>(i);
  }
  if (count == 0) return "";
  const auto job = [&](int row) {
    const auto i = static_cast<std::size_t>(row);
    return fmt::format("<a href=\"#job-{}\">{}</a> ({} ms, error {} m)", table.cell(i, "hash"),
                       html_text(table.job_name(i, varied)), three_digits(table.number(i, choice.x)),
                       three_digits(table.number(i, choice.y)));
  };
  const std::string noise =
      table.column("spread_step_ms") >= 0
          ? ""
          : " Times are of one run each, so small differences between them mean nothing (<code>--repeat</code>).";
  if (fastest == closest) return fmt::format("{} is both the fastest and the most exact.{}", job(fastest), noise);
  return fmt::format(
      "{} of the jobs are beaten by no other in both time and error. Fastest of all: {}. Most exact: {}.{}", count,
      job(fastest), job(closest), noise);
}

}  // namespace

std::string summary_html(const SweepReport& report, const ReportTable& table, const ReportChoice& choice,
                         const Session& base) {
  const Parameters& p = base.world().parameters;
  std::string html = "<ul class=\"summary\">\n";
  html += item("Varied:", varied_text(report, table));
  html += item("Jobs:", jobs_text(table) + doubts_text(table));
  const bool varies_time =
      std::find(report.paths.begin(), report.paths.end(), "simulation.frame_time") != report.paths.end();
  if (varies_time)
    html += item("Window:",
                 "as many frames in every job, but the length of a frame is varied, so the simulated time differs from "
                 "job to job. Figures are of all of it.");
  else
    html += item("Window:", fmt::format("{:.4g} s of simulated time, in frames of {:.4g} s. Figures are of all of it.",
                                        report.seconds_per_run, p.simulation.frame_time));
  if (report.reference.empty()) {
    html +=
        item("Reference:", "none was given, so there are no errors. <code>--reference PATH=VALUE</code> names one.");
  } else {
    html += errors_items(report.errors, own_text(table));
    html += item("Error:",
                 "the root of the mean square distance between the surfaces of a job and of its reference, over the "
                 "surface points of all moving bodies and over all frames of the same time, in metres. The relative "
                 "error is in sizes of the scene, the diagonal of the box round these bodies at frame 0. Contacts make "
                 "motion chaotic: over a long window the error says when two runs parted, not how exact they are.");
  }
  if (choice.has_errors)
    if (const std::string best = extremes_text(table, choice); !best.empty()) html += item("Best:", best);
  return html + "</ul>\n";
}

}  // namespace impinge
