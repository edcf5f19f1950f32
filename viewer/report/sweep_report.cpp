#include "viewer/report/sweep_report.hpp"

#include <fmt/format.h>

#include <map>

#include "engine/io/file.hpp"
#include "viewer/draw/color_map.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"
#include "viewer/report/summary.hpp"

namespace impinge {

const std::map<std::string, std::string>& page_sources();  // of viewer/app/report, embedded by the build

namespace {

namespace fs = std::filesystem;

constexpr const char* kScripts[] = {"common.js", "plot.js", "heat_map.js", "frames.js", "table.js", "job.js"};

std::string heat_json() {
  std::string json;
  for (const Color& c : heat_colors())
    json += fmt::format("{}[{:.0f},{:.0f},{:.0f}]", json.empty() ? "" : ",", 255.0f * c.r, 255.0f * c.g, 255.0f * c.b);
  return "[" + json + "]";
}

std::string name_json(const ReportTable& table, int column) {
  return column < 0 ? "\"\"" : json_text(table.columns[static_cast<std::size_t>(column)].name);
}

std::string data_json(const SweepReport& report, const ReportTable& table, const ReportChoice& choice,
                      const std::string& frames) {
  std::string json = "{\"columns\":[";
  for (const ReportColumn& c : table.columns)
    json += fmt::format(
        "{}{{\"name\":{},\"label\":{},\"unit\":{},\"doc\":{},\"kind\":\"{}\",\"numeric\":{},\"main\":{},\"distinct\":{}"
        ",\"joined\":{}}}",
        &c == table.columns.data() ? "" : ",\n", json_text(c.name), json_text(c.label), json_text(c.unit),
        json_text(c.doc), kind_name(c.kind), c.is_numeric, c.is_main, c.distinct, c.is_joined);
  json += "],\n\"rows\":[";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    json += fmt::format("{}{{\"hash\":{},\"status\":{},\"reason\":{},\"doubts\":{},\"cells\":[", i == 0 ? "" : ",\n",
                        json_text(table.cell(i, "hash")), json_text(table.cell(i, "status")),
                        json_text(table.cell(i, "reason")), json_text(table.cell(i, "doubts")));
    for (std::size_t c = 0; c < table.columns.size(); ++c) json += (c == 0 ? "" : ",") + json_text(table.rows[i][c]);
    json += "]}";
  }
  json += "],\n\"reference\":[";
  for (std::size_t i = 0; i < report.reference.size(); ++i)
    json += (i == 0 ? "" : ",") + json_text(report.reference[i]);
  return json + fmt::format("],\n\"plot\":{{\"x\":{},\"y\":{},\"measure\":{}}},\n\"heat\":{},\n\"frames\":{}}}",
                            name_json(table, choice.x), name_json(table, choice.y), name_json(table, choice.measure),
                            heat_json(), frames);
}

std::string definitions_html(const ReportTable& table) {
  std::string html = "<table class=\"plain\"><tbody>\n";
  for (const ReportColumn& c : table.columns)
    if (!c.doc.empty())
      html += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td>{}{}</td></tr>\n", html_text(c.name),
                          html_text(c.doc), c.unit.empty() ? "" : " (" + html_text(c.unit) + ")");
  return html + "</tbody></table>\n";
}

std::string plots_html(const ReportChoice& choice, bool has_heat) {
  std::string html = fmt::format(
      "<div class=\"pair{}\">\n<section>\n<h2>{}</h2>\n<p class=\"note\">A point is a job; a click opens it. "
      "{}</p>\n<div id=\"plot\"></div>\n</section>\n",
      has_heat ? " two" : "", choice.has_errors ? "Error against time" : "One figure against another",
      "Ringed, on the dashed front: no other job is at most as large in both and smaller in one. Crossed out: in "
      "doubt, and no part of the front.");
  if (has_heat)
    html +=
        "<section>\n<h2>Two parameters</h2>\n<p class=\"note\">A cell is a job; a click opens it. Dark is little, "
        "bright is much; the number says how much. A red cross: in doubt.</p>\n<div id=\"heat\"></div>\n</section>\n";
  return html + "</div>\n";
}

/// Each job chose the range of its bar by its own frames, unless somebody gave one to all.
std::string colours_note(const ViewSettings& view) {
  ViewSettings settings = view;
  ParameterSet rows;
  settings.bind(rows);
  std::string open;
  for (const char* layer : {"stress", "strain", "heat"}) {
    const Parameter* most = rows.find(fmt::format("view.{}.max", layer));
    if (settings.is_on(layer) && most != nullptr && std::get<double>(most->get()) == 0.0)
      open += fmt::format("{}<code>--set {}=...</code>", open.empty() ? "" : ", ", most->path);
  }
  return open.empty() ? "" : " The bar's range is each picture's own: " + open + " gives all jobs the same colours.";
}

std::string page(const SweepReport& report, const ReportTable& table, const ReportChoice& choice, const Session& base,
                 const fs::path& out, bool has_heat) {
  const double frame_time =
      table.column("simulation.frame_time") < 0 ? base.world().parameters.simulation.frame_time : 0.0;
  const std::string frames = frames_json(table, out, frame_time), title = html_text(report.scene) + ": a sweep";
  const auto& sources = page_sources();
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><link rel=\"icon\" "
      "href=\"data:,\"><title>{}</title>\n<style>\n{}</style></head><body>\n<h1>{}</h1>\n",
      title, sources.at("page.css"), title);
  if (!report.caution.empty()) html += "<p class=\"caution\"><b>Caution:</b> " + html_text(report.caution) + ".</p>\n";
  html += summary_html(report, table, choice, base);
  html +=
      "<noscript><p>This page draws its plots and its table of jobs by JavaScript, which is switched off. The figures "
      "are in <a href=\"results.csv\">results.csv</a>.</p></noscript>\n";
  if (choice.x >= 0 && choice.y >= 0) html += plots_html(choice, has_heat);
  if (frames != "null")
    html +=
        "<h2>Pictures</h2>\n<p class=\"note\">The same frame of every job. The copies here are small and part of this "
        "page; a job shows where the full ones are." +
        colours_note(base.view().settings()) + "</p>\n<div id=\"frames\"></div>\n";
  html += "<h2>Jobs</h2>\n<p class=\"note screen\">A click on a head sorts, on a job opens it.</p>\n";
  if (choice.has_errors)
    html +=
        "<p class=\"note\">◆ no other job is both faster and more exact. Bold: the smallest time or error of all jobs "
        "that are done and not in doubt. <small>ref</small>: a job that is its own reference, so it has no "
        "error.</p>\n";
  html += "<div id=\"table\"></div>\n<h2>What was modelled, and what was left out</h2>\n" + model_html(table, out);
  html += "<h3>What leaving things out is worth</h3>\n" + ablation_html(out, report.scene);
  html += "<h2>Machine, versions, noise</h2>\n" + machine_html(table, out);
  html += "<h2>What the columns mean</h2>\n" + definitions_html(table);
  html += "<dialog id=\"job\"></dialog>\n<script id=\"data\" type=\"application/json\">" +
          data_json(report, table, choice, frames) + "</script>\n<script>\n";
  for (const char* script : kScripts) html += sources.at(script);
  return html + "</script>\n</body></html>\n";
}

}  // namespace

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '<')
      out += "\\u003c";  // a page's data must not end its script
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + "\"";
}

void write_sweep_report(const fs::path& out, const SweepReport& report, const Session& base) {
  const ReportTable table = read_report_table(read_file(out / "results.csv", std::uint64_t{1} << 32), report.paths,
                                              report.reference, base.rows());
  const ReportChoice choice = choose_columns(table);
  if (choice.has_errors)
    write_png(out / "work_precision.png",
              paint_plots({work_precision_plot(table, choice, report.scene)}, 1280, 720).front());
  HeatTable heat;
  const bool has_heat = heat_table_of(table, choice, report.scene, heat);
  if (has_heat) write_png(out / "heat_map.png", paint_heat_table(heat, 1280, 720));
  write_file(out / "report.html", page(report, table, choice, base, out, has_heat));
}

}  // namespace impinge
