#include "viewer/report/mesh_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/parameter.hpp"
#include "engine/core/shell_word.hpp"
#include "engine/io/meshes/mesh_unit.hpp"
#include "viewer/report/json_values.hpp"
#include "viewer/report/parts.hpp"

namespace impinge {
namespace {

constexpr double kWater = 1000.0;  // kg/m³

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string row(const char* name, const std::string& text) { return fmt::format("  {:<12} {}\n", name, text); }

std::string size_text(const Aabb& box) {
  const Vec3 e = box.extent();
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", e.x(), e.y(), e.z());
}

std::string question_of(const MeshReport& report) {
  if (report.says_unit || report.facts.box.is_empty()) return "";
  const double longest = report.facts.box.extent().maxCoeff();
  const std::string question = unit_question(longest);
  return question.empty() ? "" : fmt::format("{:.4g} m long: {}", longest, question);
}

std::string as_a_body(const MeshReport& report) {
  if (!report.facts.problem)
    return report.facts.degenerate > 0 && !report.mended ? "any kind, as it is; mend = true takes out what has no area"
                                                         : "any kind, as it is";
  const std::string mends =
      report.mended ? ""
                    : fmt::format("; mend = true, or impinge mesh {} --mend --out NEW.ply", shell_word(report.file));
  return fmt::format("{}: it {}{}",
                     report.facts.is_closed ? "needs mending" : "static or scripted as it is, else mended",
                     *report.facts.problem, mends);
}

std::string solid_text(const MeshFacts& f) {
  if (!f.is_closed) {
    const char* what = f.border_edges > 0                                      ? "open"
                       : f.nonmanifold_edges > 0 || f.nonmanifold_vertices > 0 ? "not manifold"
                                                                               : "not oriented";
    return fmt::format("none, it is {}; area {:.6g} m²", what, f.area);
  }
  if (f.volume < 0.0)
    return fmt::format("inside out, round {:.6g} m³ that it has for outside; area {:.6g} m²", -f.volume, f.area);
  return fmt::format("volume {:.6g} m³, mass {:.6g} kg at {} kg/m³, area {:.6g} m²", f.volume, kWater * f.volume,
                     kWater, f.area);
}

std::string skin_text(const SkinFault& fault) { return fault.what + "; " + fault.remedy; }

double percent(double before, double after) { return 100.0 * (after - before) / before + 0.0; }

/// Signed volumes count twice what two parts have in common: where that is gone, the change is told of what is left.
std::string change_text(const MeshReport& report) {
  const double before = report.mended->volume_before, after = report.mended->volume_after;
  if (report.enclosed && std::abs(after - *report.enclosed) < std::abs(after - before))
    return fmt::format(
        "{:.6g} m³ before, {:.3g} m³ of it more than once, where parts overlap; {:.6g} m³ after ({:+.2g} % "
        "of the {:.4g} m³ that they take up)",
        before, before - *report.enclosed, after, percent(*report.enclosed, after), *report.enclosed);
  std::string text = fmt::format("{:.6g} m³ before, {:.6g} m³ after", before, after);
  const bool may_overlap = report.facts.crossings > 0 && (!report.after || report.after->crossings == 0);
  if (before > 0.0)
    text +=
        fmt::format(" ({:+.3g} %{})", percent(before, after),
                    may_overlap && after < before && !report.facts.is_closed ? ", overlaps counted twice before" : "");
  return text;
}

template <class T>
std::string optional_number(const std::optional<T>& x) {
  return x ? json_number(static_cast<double>(*x)) : "null";
}

std::string facts_json(const MeshFacts& f) {
  const double volume = f.is_closed ? f.volume : NAN;
  return fmt::format(
      "{{\"min\": {}, \"max\": {}, \"vertices\": {}, \"triangles\": {}, \"coinciding_vertices\": {}, "
      "\"unused_vertices\": {}, \"area\": {}, \"closed\": {}, \"volume\": {}, \"mass\": {}, \"components\": {}, "
      "\"genus\": {}, \"border_edges\": {}, \"holes\": {}, \"nonmanifold_edges\": {}, \"nonmanifold_vertices\": {}, "
      "\"misoriented_edges\": {}, \"degenerate_triangles\": {}, \"duplicate_triangles\": {}, \"crossings\": {}, "
      "\"more_crossings\": {}, \"thinnest\": {}, \"thin_triangles\": {}, \"edge_min\": {}, \"edge_median\": {}, "
      "\"edge_max\": {}, \"problem\": {}}}",
      f.box.is_empty() ? "null" : json_vector(f.box.min), f.box.is_empty() ? "null" : json_vector(f.box.max),
      f.vertices, f.triangles, f.coinciding, f.unused, json_number(f.area), f.is_closed, json_number(volume),
      json_number(volume > 0.0 ? kWater * volume : NAN), f.components, optional_number(f.genus), f.border_edges,
      f.holes, f.nonmanifold_edges, f.nonmanifold_vertices, f.misoriented_edges, f.degenerate, f.duplicates,
      f.crossings, f.more_crossings, optional_number(f.thinnest), f.thin, json_number(f.shortest_edge),
      json_number(f.median_edge), json_number(f.longest_edge), f.problem ? json_text(*f.problem) : "null");
}

std::string report_json(const MeshReport& r) {
  if (!r.error.empty()) return fmt::format("{{\"file\": {}, \"error\": {}}}", json_text(r.file), json_text(r.error));
  std::string out = fmt::format("{{\"file\": {}, \"unit\": {}, \"says_unit\": {}, \"surface\": {}", json_text(r.file),
                                json_text(r.unit), r.says_unit, facts_json(r.facts));
  if (r.mended) {
    std::string steps;
    for (const std::string& step : r.mended->steps()) steps += (steps.empty() ? "" : ", ") + json_text(step);
    out += fmt::format(
        ", \"mend\": {{\"steps\": [{}], \"volume_before\": {}, \"enclosed_before\": {}, \"volume_after\": {}, "
        "\"largest_move\": {}, \"warning\": {}, \"problem\": {}, \"surface\": {}}}",
        steps, json_number(r.mended->volume_before), optional_number(r.enclosed), json_number(r.mended->volume_after),
        json_number(r.mended->largest_move),
        r.mended->skin_fault ? json_text(skin_text(*r.mended->skin_fault)) : "null",
        r.problem_left ? json_text(*r.problem_left) : "null", r.after ? facts_json(*r.after) : "null");
  }
  if (r.decimated)
    out += fmt::format(
        ", \"decimate\": {{\"triangles_before\": {}, \"triangles_after\": {}, \"volume_before\": {}, "
        "\"volume_after\": {}, \"farthest\": {}, \"surface\": {}}}",
        r.decimated->triangles_before, r.decimated->triangles_after, json_number(r.decimated->volume_before),
        json_number(r.decimated->volume_after), json_number(r.decimated->farthest),
        r.after ? facts_json(*r.after) : "null");
  return out + "}";
}

std::string mended_rows(const MeshReport& r) {
  std::string out;
  const std::vector<std::string> steps = r.mended->steps();
  if (steps.empty()) out += row("mended:", "nothing to do");
  for (std::size_t i = 0; i < steps.size(); ++i) out += row(i == 0 ? "mended:" : "", steps[i]);
  out += row("volume:", change_text(r));
  out += row("moved:", r.mended->largest_move > 0.0 ? fmt::format("a vertex {:.3g} m at most", r.mended->largest_move)
                                                    : "no vertex");
  if (r.mended->skin_fault) out += row("warning:", skin_text(*r.mended->skin_fault));
  if (r.problem_left) out += row("left:", "it " + *r.problem_left);
  if (r.after && r.after->crossings > 0)
    out += row("left:", fmt::format("{}{} that cross or touch: overlaps count twice; --remesh 100 makes one skin",
                                    r.after->more_crossings ? "at least " : "",
                                    counted(r.after->crossings, "pair of triangles", "pairs of triangles")));
  return out;
}

/// The end of a long name says more than its begin.
std::string shortened_path(const std::string& path, std::size_t most) {
  return path.size() <= most ? path : "..." + path.substr(path.size() - (most - 3));
}

/// Its corners, far from the origin to as many digits as tell them apart.
std::string corners_text(const Aabb& box) {
  const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()),
               extent = box.extent().maxCoeff();
  const double more = extent > 0.0 ? std::ceil(std::log10(std::max(1.0, farthest / extent))) : 0.0;
  const int digits = 4 + static_cast<int>(std::clamp(more, 0.0, 12.0));
  const auto point = [&](const Vec3& x) {
    return fmt::format("({:.{}g}, {:.{}g}, {:.{}g})", x.x(), digits, x.y(), digits, x.z(), digits);
  };
  return fmt::format("{}, {} m", point(box.min), point(box.max));
}

}  // namespace

std::vector<std::string> fault_lines(const MeshFacts& f) {
  std::vector<std::string> lines;
  if (f.border_edges > 0)
    lines.push_back(fmt::format("{} round {}", counted(f.border_edges, "border edge", "border edges"),
                                counted(f.holes, "hole", "holes")));
  if (f.nonmanifold_edges > 0)
    lines.push_back(counted(f.nonmanifold_edges, "edge", "edges") + " with three triangles or more");
  if (f.nonmanifold_vertices > 0)
    lines.push_back(counted(f.nonmanifold_vertices, "vertex", "vertices") + " where sheets touch");
  if (f.misoriented_edges > 0)
    lines.push_back(counted(f.misoriented_edges, "edge", "edges") + " whose triangles face opposite ways");
  if (f.degenerate > 0) lines.push_back(counted(f.degenerate, "triangle", "triangles") + " without area");
  if (f.duplicates > 0) lines.push_back(counted(f.duplicates, "triangle", "triangles") + " twice there");
  if (f.crossings > 0)
    lines.push_back(fmt::format("{}{} that cross or touch", f.more_crossings ? "at least " : "",
                                counted(f.crossings, "pair of triangles", "pairs of triangles")));
  if (f.thin > 0)
    lines.push_back(counted(f.thin, "triangle", "triangles") + " over less than a thousandth of the size");
  return lines;
}

std::string mesh_page(const MeshReport& r) {
  if (!r.error.empty()) return r.error + "\n";
  const MeshFacts& f = r.facts;
  std::string out = r.file + "\n";
  if (f.box.is_empty()) return out + row("problem:", f.problem.value_or("has no triangles"));
  out += row("size:", fmt::format("{}, {}", size_text(f.box), r.unit));
  out += row("from, to:", corners_text(f.box));
  if (const std::string question = question_of(r); !question.empty()) out += row("", question);
  out += row("solid:", solid_text(f));
  out += row("surface:",
             fmt::format("{} vertices{}{}, {} triangles, {}{}", r.file_vertices,
                         f.coinciding > 0 ? fmt::format(" ({} twice there)", f.coinciding) : "",
                         f.unused > 0 ? fmt::format(" ({} unused)", f.unused) : "", f.triangles,
                         counted(f.components, "part", "parts"), f.genus ? fmt::format(", genus {}", *f.genus) : ""));
  out +=
      row("edges:", fmt::format("{:.3g} to {:.3g} m, median {:.3g} m", f.shortest_edge, f.longest_edge, f.median_edge));
  if (f.thinnest) out += row("thinnest:", fmt::format("{:.3g} m", *f.thinnest));
  const std::vector<std::string> faults = fault_lines(f);
  for (std::size_t i = 0; i < faults.size(); ++i) out += row(i == 0 ? "faults:" : "", faults[i]);
  if (faults.empty()) out += row("faults:", "none");
  out += row("as a body:", as_a_body(r));
  if (r.mended) out += mended_rows(r);
  if (r.decimated) out += row("decimated:", r.decimated->text());
  if (!r.written.empty()) out += row("written:", r.written);
  return out;
}

std::string mesh_table(const std::vector<MeshReport>& reports) {
  const bool is_mended = std::any_of(reports.begin(), reports.end(), [](const MeshReport& r) { return r.mended; });
  std::string out =
      fmt::format("{:<28} {:>9} {:>8} {:>10} {:>5} {:>6} {:>6} {:>7} {}\n", "file", "triangles", "long (m)",
                  is_mended ? "mended m³" : "volume m³", "parts", "border", "multi", "crosses", "solid");
  for (const MeshReport& r : reports) {
    const std::string file = shortened_path(r.file, 28);
    if (!r.error.empty()) {
      out += fmt::format("{:<28} not read: {}\n", file, r.error);
      continue;
    }
    const MeshFacts& f = r.facts;
    const bool has_volume = is_mended ? !r.problem_left : f.is_closed;
    const double volume = is_mended ? r.mended->volume_after : f.volume;
    const char* state = is_mended ? (r.problem_left           ? "no"
                                     : r.mended->is_changed() ? "mended"
                                                              : "yes")
                                  : (f.problem ? (f.is_closed ? "no" : "open") : "yes");
    out += fmt::format("{:<28} {:>9} {:>8.4g} {:>10} {:>5} {:>6} {:>6} {:>7} {}\n", file,
                       r.decimated ? r.decimated->triangles_after : static_cast<int>(f.triangles),
                       f.box.is_empty() ? 0.0 : f.box.extent().maxCoeff(),
                       has_volume ? fmt::format("{:.4g}", volume) : "-", f.components, f.border_edges,
                       f.nonmanifold_edges, f.crossings, state);
  }
  return out;
}

std::string mesh_json(const std::vector<MeshReport>& reports) {
  if (reports.size() == 1) return report_json(reports[0]) + "\n";
  std::string out = "[";
  for (std::size_t i = 0; i < reports.size(); ++i) out += (i == 0 ? "\n  " : ",\n  ") + report_json(reports[i]);
  return out + "\n]\n";
}

}  // namespace impinge
