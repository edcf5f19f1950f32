// Where the sweep ran, and how far its times can be trusted.
#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <thread>

#include "engine/core/error.hpp"
#include "engine/io/paths.hpp"
#include "viewer/image/png.hpp"
#include "viewer/report/parts.hpp"

namespace impinge {

namespace {

namespace fs = std::filesystem;

// what follows `key` and its separators on the first line that begins with it
std::string line_of(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(key, 0) == 0) {
      const std::size_t begin = line.find_first_not_of(" \t:=\"", key.size()), end = line.find_last_not_of(" \"");
      return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
    }
  return "";
}

std::string renderer_of(const ReportTable& table, const fs::path& out) {
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const fs::path file = out / "jobs" / table.cell(i, "hash") / "run/frames/000000.png";
    if (!is_file(file)) continue;
    try {
      for (const auto& [key, text] : read_png_text(file))
        if (key == "impinge:renderer") return text;
    } catch (const InputError&) {
      continue;
    }
  }
  return "";
}

std::string noise(const ReportTable& table) {
  double sum = 0.0, most = 0.0;
  int count = 0;
  std::string names;
  for (const ReportColumn& column : table.columns) {
    if (column.kind != ReportColumn::spread) continue;
    const int spread = table.column(column.name), time = table.column(column.name.substr(7));
    if (time < 0) continue;
    names += (names.empty() ? "" : ", ") + column.name;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const double share = table.number(i, spread) / table.number(i, time);
      if (!std::isfinite(share)) continue;
      sum += share, most = std::max(most, share), ++count;
    }
  }
  if (count == 0)
    return "One run each: the noise of the times isn't known from this sweep, and small differences between them mean "
           "nothing. <code>--repeat K</code> measures it.";
  return fmt::format(
      "Each job was run several times; times are medians, and {} say how far the runs lie apart: {:.1f} % of the time "
      "on average, {:.1f} % at most. Bars at the plot's points show it.",
      html_text(names), 100.0 * sum / count, 100.0 * most);
}

}  // namespace

std::string machine_html(const ReportTable& table, const fs::path& out) {
  utsname system{};
  uname(&system);
  const std::string renderer = renderer_of(table, out), processor = line_of("/proc/cpuinfo", "model name"),
                    os = line_of("/etc/os-release", "PRETTY_NAME");
  std::string html = "<table class=\"plain\"><tbody>\n";
  const auto line = [&](const char* name, const std::string& text) {
    if (!text.empty()) html += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", name, text);
  };
  line("processor",
       html_text(fmt::format("{}, {} threads; a job has one", processor.empty() ? system.machine : processor,
                             std::thread::hardware_concurrency())));
  line("system", html_text(fmt::format("{}, {} {}", os.empty() ? "unknown" : os, system.sysname, system.release)));
  line("program", html_text(fmt::format("impinge {}, compiled by {}", IMPINGE_VERSION,
#ifdef __clang__
                                        "Clang " __clang_version__
#else
                                        "GCC " __VERSION__
#endif
                                        )));
  line("pictures", html_text(renderer));
  line("noise of the times", noise(table));
  line("where",
       "this table is of the machine that wrote the report; jobs may have run on others that share the folder");
  return html + "</tbody></table>\n";
}

}  // namespace impinge
