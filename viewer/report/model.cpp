// The report's sections on what was modelled: by the jobs' run.toml and stats.csv; and the ablation that somebody made.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/io/file.hpp"
#include "engine/io/paths.hpp"
#include "viewer/report/parts.hpp"
#include "viewer/study/model_report.hpp"
#include "viewer/sweep/table.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

struct Needed {
  double dofs = 0, bodies = 0, contacts_mean = 0, contacts_max = 0, iterations = 0;
  std::size_t frames = 0, without_contact = 0, with_sleepers = 0;
  double parts_ms[6] = {};  ///< broad, narrow, assembly, response, integration, looks back
};

constexpr const char* kParts[] = {"broad_ms", "narrow_ms", "assemble_ms", "response_ms", "integrate_ms", "guard_ms"};

// frame 0 is detection only and doesn't count
bool read_needed(const fs::path& stats, Needed& needed) {
  if (!is_file(stats)) return false;
  const auto lines = parse_csv(read_file(stats, std::uint64_t{1} << 32));
  if (lines.size() < 2) return false;
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(lines[0].begin(), lines[0].end(), name) - lines[0].begin());
  };
  const auto value = [&](const std::vector<std::string>& line, std::size_t at) {
    return at < line.size() ? std::strtod(line[at].c_str(), nullptr) : 0.0;
  };
  const std::size_t contacts = column("contacts"), asleep = column("asleep"), iterations = column("lcp_iterations");
  needed.dofs = value(lines[1], column("dofs"));
  needed.bodies = value(lines[1], column("bodies"));
  for (std::size_t i = 2; i < lines.size(); ++i) {
    if (lines[i].size() != lines[0].size()) break;
    ++needed.frames;
    const double now = value(lines[i], contacts);
    needed.contacts_mean += now;
    needed.contacts_max = std::max(needed.contacts_max, now);
    needed.without_contact += now == 0.0 ? 1 : 0;
    needed.with_sleepers += value(lines[i], asleep) > 0.0 ? 1 : 0;
    needed.iterations += value(lines[i], iterations);
    for (std::size_t k = 0; k < std::size(kParts); ++k) needed.parts_ms[k] += value(lines[i], column(kParts[k]));
  }
  if (needed.frames > 0)
    needed.contacts_mean /= static_cast<double>(needed.frames), needed.iterations /= static_cast<double>(needed.frames);
  return true;
}

std::string rows_text(const Needed& needed, const ModelFacts& facts) {
  const double most = 3.0 * needed.contacts_max + facts.attachment_rows(),
               least = needed.contacts_max + facts.attachment_rows();
  if (!facts.friction) return fmt::format("{:.0f}", least);
  return facts.frictionless ? fmt::format("{:.0f} to {:.0f}", least, most) : fmt::format("{:.0f}", most);
}

std::string share_text(const Needed& needed) {
  double sum = 0.0;
  for (const double ms : needed.parts_ms) sum += ms;
  std::string text;
  for (const double ms : needed.parts_ms)
    text += fmt::format("<td class=\"number\">{}</td>", sum > 0.0 ? fmt::format("{:.0f} %", 100.0 * ms / sum) : "");
  return text;
}

std::string line_html(const ModelLine& line) {
  return fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th><td>{}</td></tr>\n", line.used ? "used" : "left",
                     line.stage, (line.used ? "" : "left out: ") + html_text(line.what));
}

}  // namespace

std::string model_html(const ReportTable& table, const fs::path& out) {
  struct Job {
    std::size_t row;
    std::vector<ModelLine> lines;
    ModelFacts facts;
    Needed needed;
    bool has_figures;
  };
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const fs::path run = out / "jobs" / table.cell(i, "hash") / "run";
    Parameters parameters;
    Job job{i, {}, {}, {}, false};
    if (!read_recorded_model(run / "run.toml", parameters, job.facts)) continue;
    job.lines = model_lines(parameters, job.facts);
    job.has_figures = read_needed(run / "stats.csv", job.needed);
    jobs.push_back(std::move(job));
  }
  if (jobs.empty()) return "<p>No job has written its run.toml.</p>\n";
  const auto same = [](const ModelLine& a, const ModelLine& b) {
    return a.stage == b.stage && a.used == b.used && a.what == b.what;
  };
  std::vector<bool> common(jobs.front().lines.size(), true);
  for (const Job& job : jobs)
    for (std::size_t k = 0; k < common.size(); ++k) common[k] = common[k] && same(job.lines[k], jobs.front().lines[k]);

  const ModelFacts& facts = jobs.front().facts;
  std::string html = fmt::format(
      "<p>The scene has {} deformable, {} dynamic, {} scripted and {} static bodies. Scripted and static ones have no "
      "degrees of freedom.</p>\n",
      facts.deformable, facts.dynamic, facts.scripted, facts.fixed);
  html += "<h3>The same in every job</h3>\n<table class=\"plain\"><tbody>\n";
  for (std::size_t k = 0; k < common.size(); ++k)
    if (common[k]) html += line_html(jobs.front().lines[k]);
  html +=
      "</tbody></table>\n<h3>Job by job</h3>\n<p>Rows are those of the contact problem in the frame that had most "
      "contacts: three a contact with friction, one without. A frame without contact has no "
      "collision group, no system and no solve; sleeping bodies have none either. The last six columns are shares of "
      "the simulation time.</p>\n<div class=\"wide\"><table id=\"modelled\"><thead><tr><th>job</th>";
  for (std::size_t k = 0; k < common.size(); ++k)
    if (!common[k]) html += fmt::format("<th>{}</th>", jobs.front().lines[k].stage);
  for (const char* head :
       {"degrees of freedom", "rows, most", "contacts, mean", "iterations a frame", "frames without contact",
        "frames with sleepers", "broad phase", "narrow phase", "assembly", "response", "integration", "looks back"})
    html += fmt::format("<th class=\"number\">{}</th>", head);
  html += "</tr></thead><tbody>\n";
  std::vector<int> numbers;  // what is varied and shows in no line of the model
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].kind == ReportColumn::varied && table.columns[c].is_numeric && table.columns[c].distinct > 1)
      numbers.push_back(static_cast<int>(c));
  for (const Job& job : jobs) {
    const std::string& hash = table.cell(job.row, "hash");
    const std::string name =
        numbers.empty() ? "" : "<small>" + html_text(table.job_name(job.row, numbers)) + "</small>";
    html += fmt::format("<tr><th scope=\"row\"><a href=\"#job-{}\">{}</a>{}</th>", hash, hash.substr(0, 8), name);
    for (std::size_t k = 0; k < common.size(); ++k)
      if (!common[k])
        html += fmt::format("<td class=\"what\">{}{}</td>",
                            job.lines[k].used ? "" : "left out: ", html_text(job.lines[k].what));
    const Needed& n = job.needed;
    if (job.has_figures)
      html += fmt::format(
          "<td class=\"number\">{:.0f}</td><td class=\"number\">{}</td><td class=\"number\">{:.4g}</td><td "
          "class=\"number\">{:.4g}</td><td class=\"number\">{} of {}</td><td class=\"number\">{} of {}</td>{}",
          n.dofs, rows_text(n, job.facts), n.contacts_mean, n.iterations, n.without_contact, n.frames, n.with_sleepers,
          n.frames, share_text(n));
    else
      html += "<td colspan=\"11\">no frame was made</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string ablation_html(const fs::path& out, const std::string& scene) {
  const fs::path file = out / "ablation.csv";
  if (!is_file(file))
    return fmt::format(
        "<p>Not measured in this sweep. <code>impinge info {} --ablation --out {}</code> runs the scene with each "
        "economy switched off; the same sweep once more then shows the table here.</p>\n",
        html_text(scene), html_text(out.string()));
  const auto lines = parse_csv(read_file(file, std::uint64_t{1} << 24));
  std::string html =
      "<p>The scene as it is in its file, and with each economy switched off. Difference: the largest distance of a "
      "body from where it is otherwise (root of the mean square over its surface), in sizes of the scene. "
      "Ratio and difference are to the scene as it is over the same frames. Times are those of the processor; the "
      "second row shows their noise.</p>\n<div class=\"wide\"><table id=\"ablation\"><thead><tr><th>left out</th><th "
      "class=\"number\">frames</th><th class=\"number\">time a frame <small>ms</small></th><th "
      "class=\"number\">ratio</th><th class=\"number\">difference</th><th>modelled "
      "instead</th><th>settings</th></tr></thead><tbody>\n";
  const auto figure = [](const std::string& text) {
    return text.empty() ? std::string() : three_digits(std::strtod(text.c_str(), nullptr));
  };
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].size() != 8) continue;
    const auto& cell = lines[i];
    const bool was_run = !cell[7].empty();
    html += fmt::format(
        "<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
        "class=\"number\">{}</td><td class=\"number\">{}</td><td>{}{}</td><td>{}</td></tr>\n",
        html_text(cell[0]), was_run ? html_text(cell[3]) : "", was_run ? figure(cell[7]) : html_text(cell[6]),
        figure(cell[4]), was_run ? figure(cell[5]) : "", html_text(cell[1]),
        was_run && !cell[6].empty() ? "; " + html_text(cell[6]) : "",
        cell[2].empty() || cell[0].rfind("all of", 0) == 0 ? "" : "<code>" + html_text(cell[2]) + "</code>");
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace impinge
