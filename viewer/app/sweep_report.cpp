#include "viewer/app/sweep_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/io/file.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"

namespace impinge {

namespace {

struct Point {
  double error, ms;
  const SweepRow* row;
};

struct Line {
  std::string name;
  std::vector<Point> points;  ///< in the order of the sweep
};

// as in the plots of the panels: after Okabe & Ito
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == 0;
}

// jobs that differ only in numbers that the reference sets belong to one line
std::vector<Line> lines_of(const SweepReport& report) {
  std::vector<bool> is_setting(report.paths.size());
  for (std::size_t i = 0; i < report.paths.size(); ++i)
    is_setting[i] = std::any_of(report.reference.begin(), report.reference.end(), [&](const std::string& text) { return text.rfind(report.paths[i] + "=", 0) == 0; }) &&
                    std::all_of(report.rows.begin(), report.rows.end(), [&](const SweepRow& row) { return is_number(row.values[i]); });
  std::vector<Line> lines;
  for (const SweepRow& row : report.rows) {
    if (!(row.error > 0.0) || !(row.work_ms > 0.0)) continue;
    std::string name;
    for (std::size_t i = 0; i < report.paths.size(); ++i)
      if (!is_setting[i]) name += (name.empty() ? "" : ", ") + (is_number(row.values[i]) ? report.paths[i].substr(report.paths[i].rfind('.') + 1) + " " : "") + row.values[i];
    if (name.empty()) name = "all jobs";
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.name == name; });
    if (line == lines.end()) line = lines.insert(lines.end(), {name, {}});
    line->points.push_back({row.error, row.work_ms, &row});
  }
  return lines;
}

bool is_best(const Point& point, const std::vector<Line>& lines) {
  for (const Line& line : lines)
    for (const Point& other : line.points)
      if (other.error <= point.error && other.ms <= point.ms && (other.error < point.error || other.ms < point.ms)) return false;
  return true;
}

std::string values_of(const SweepReport& report, const SweepRow& row) {
  std::string text;
  for (std::size_t i = 0; i < report.paths.size(); ++i) text += fmt::format("{} = {}\n", report.paths[i], row.values[i]);
  return text;
}

// a logarithmic axis in pixels
struct Axis {
  double low, high, begin, end;
  double at(double value) const { return begin + (std::log10(value) - low) / (high - low) * (end - begin); }
};

Axis axis_over(double smallest, double largest, double begin, double end) {
  double low = std::log10(smallest) - 0.1, high = std::log10(largest) + 0.1;
  // room for a tick at least at each end of a decade
  if (high - low < 1.0) low = std::floor(low), high = std::ceil(high);
  return {low, high, begin, end};
}

std::string svg(const SweepReport& report, const std::vector<Line>& lines) {
  constexpr double kWidth = 900, kHeight = 520, kLeft = 80, kRight = 660, kTop = 20, kBottom = 460;
  double x0 = 1e300, x1 = 0, y0 = 1e300, y1 = 0;
  for (const Line& line : lines)
    for (const Point& p : line.points) x0 = std::min(x0, p.ms), x1 = std::max(x1, p.ms), y0 = std::min(y0, p.error), y1 = std::max(y1, p.error);
  const Axis x = axis_over(x0, x1, kLeft, kRight), y = axis_over(y0, y1, kBottom, kTop);
  std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"error against time\">\n", kWidth, kHeight);
  out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n", kLeft, kTop, kRight - kLeft, kBottom - kTop);
  for (int e = static_cast<int>(std::ceil(x.low)); e <= x.high; ++e) {
    const double at = x.at(std::pow(10.0, e));
    out += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" class=\"grid\"/><text x=\"{0:.1f}\" y=\"{3}\" class=\"middle\">1e{4}</text>\n", at, kTop, kBottom, kBottom + 18, e);
  }
  for (int e = static_cast<int>(std::ceil(y.low)); e <= y.high; ++e) {
    const double at = y.at(std::pow(10.0, e));
    out += fmt::format("<line y1=\"{0:.1f}\" y2=\"{0:.1f}\" x1=\"{1}\" x2=\"{2}\" class=\"grid\"/><text y=\"{3:.1f}\" x=\"{4}\" class=\"end\">1e{5}</text>\n", at, kLeft, kRight, at + 4, kLeft - 8, e);
  }
  out += fmt::format("<text x=\"{}\" y=\"{}\" class=\"middle\">time of all steps (ms)</text>\n", 0.5 * (kLeft + kRight), kBottom + 44);
  out += fmt::format("<text transform=\"translate(22,{}) rotate(-90)\" class=\"middle\">error: RMS over surface points and frames (m)</text>\n", 0.5 * (kTop + kBottom));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const char* color = kColors[i % std::size(kColors)];
    std::string path;
    for (const Point& p : lines[i].points) path += fmt::format("{:.1f},{:.1f} ", x.at(p.ms), y.at(p.error));
    out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", path, color);
    for (const Point& p : lines[i].points) {
      const double px = x.at(p.ms), py = y.at(p.error);
      if (is_best(p, lines)) out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\" fill=\"none\" stroke=\"#555\"/>", px, py);
      out += fmt::format("<a href=\"jobs/{}/run/\"><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"><title>{}error {:.3g} m, {:.3g} ms</title></circle></a>\n", p.row->hash, px, py, color,
                         escaped(values_of(report, *p.row)), p.error, p.ms);
    }
    const double row = kTop + 14 + 20.0 * static_cast<double>(i);
    if (row < kHeight) out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n", kRight + 20, row - 4, color, kRight + 32, row, escaped(lines[i].name));
  }
  return out + "</svg>\n";
}

std::string table(const SweepReport& report) {
  std::string out = "<table id=\"jobs\"><thead><tr><th>job</th>";
  for (const std::string& path : report.paths) out += fmt::format("<th>{}</th>", escaped(path));
  out += "<th>status</th><th>reason</th>";
  for (const std::string& name : sweep_figure_columns()) out += fmt::format("<th>{}</th>", name);
  if (!report.reference.empty()) out += "<th>error_rms_m</th><th>error_relative</th>";
  out += "</tr></thead><tbody>\n";
  const auto number = [](double value) { return value < 0 ? std::string() : fmt::format("{:.4g}", value); };
  for (const SweepRow& row : report.rows) {
    out += fmt::format("<tr class=\"{0}\"><td><a href=\"jobs/{1}/run/\">{2}</a></td>", status_name(row.outcome.status), row.hash, row.hash.substr(0, 8));
    for (const std::string& value : row.values) out += fmt::format("<td>{}</td>", escaped(value));
    out += fmt::format("<td>{}</td><td>{}</td>", status_name(row.outcome.status), escaped(row.outcome.reason));
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const bool is_text = sweep_figure_columns()[i] == "state_hash" || row.cells[i].empty();
      out += fmt::format("<td>{}</td>", is_text ? row.cells[i] : fmt::format("{:.4g}", std::strtod(row.cells[i].c_str(), nullptr)));
    }
    if (!report.reference.empty()) out += fmt::format("<td>{}</td><td>{}</td>", number(row.error), number(row.relative_error));
    out += "</tr>\n";
  }
  return out + "</tbody></table>\n";
}

constexpr const char* kStyle = R"(body{font:14px/1.45 sans-serif;margin:2em;color:#222}table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:2px 10px;border-bottom:1px solid #ddd;text-align:left;white-space:nowrap}th{cursor:pointer;background:#f4f4f4}
tr.diverged td,tr.failed td,tr.crashed td,tr.refused td{background:#fdeee6}svg{max-width:1000px;width:100%;font:13px sans-serif}
.frame{fill:none;stroke:#888}.grid{stroke:#e4e4e4}.middle{text-anchor:middle}.end{text-anchor:end}.wide{overflow-x:auto})";

// a click on a column's head sorts by it, again turns it round
constexpr const char* kScript = R"(document.querySelectorAll('#jobs th').forEach((head,i)=>head.addEventListener('click',()=>{
const body=document.querySelector('#jobs tbody'),up=head.dataset.up!=='1';head.dataset.up=up?'1':'0';
const value=r=>r.cells[i].textContent,all=[...body.rows].sort((a,b)=>{const x=value(a),y=value(b),n=Number(x)-Number(y);
return (x!==''&&y!==''&&!isNaN(n)?n:x.localeCompare(y))*(up?1:-1);});body.append(...all);}));)";

}  // namespace

std::string sweep_html(const SweepReport& report) {
  const std::vector<Line> lines = lines_of(report);
  const auto done = std::count_if(report.rows.begin(), report.rows.end(), [](const SweepRow& row) { return row.outcome.status == SweepOutcome::done; });
  std::string out = fmt::format("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: a sweep</title><style>{1}</style></head><body>\n<h1>{0}: a sweep</h1>\n", escaped(report.scene), kStyle);
  out += fmt::format("<p>{} jobs, {} of them done; {}. impinge {}.</p>\n", report.rows.size(), done, escaped(report.command), IMPINGE_VERSION);
  if (!lines.empty()) {
    std::string settings;
    for (const std::string& text : report.reference) settings += (settings.empty() ? "" : ", ") + text;
    out += fmt::format("<h2>Error against time</h2>\n<p>The error of a job is its distance from the same job with {}, the root of the mean square over the surface points of the moving bodies and over the frames of the "
                       "same time within {:.3g} s. Contacts make motion chaotic: over long windows the error says when two runs parted, not how exact they are. Ringed: no other job is both faster and more exact. "
                       "A point opens its run.</p>\n{}",
                       escaped(settings), report.seconds_per_run, svg(report, lines));
  }
  out += fmt::format("<h2>Jobs</h2>\n<p>A click on a head sorts. Columns that end in _ms are times.</p>\n<div class=\"wide\">{}</div>\n<script>{}</script>\n</body></html>\n", table(report), kScript);
  return out;
}

void write_sweep_report(const std::filesystem::path& out, const SweepReport& report) {
  const std::vector<Line> lines = lines_of(report);
  if (!lines.empty()) {
    Plot plot;
    plot.title = report.scene + ": error against time";
    plot.x_label = "time of all steps, ms";
    plot.y_label = "error: RMS over surface points and frames, m";
    for (const Line& line : lines) {
      PlotSeries& series = plot.series.emplace_back();
      series.name = line.name;
      for (const Point& p : line.points) series.points.push_back(Vec2(p.ms, p.error));
    }
    write_png(out / "work_precision.png", paint_plots({plot}, 1280, 720).front());
  }
  write_file(out / "report.html", sweep_html(report));
}

}  // namespace impinge
