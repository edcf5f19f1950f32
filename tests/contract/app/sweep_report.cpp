// What a sweep leaves to look at: report.html, used in a real browser, its pictures, and the ablation of `impinge
// info`.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <sys/wait.h>

#include <cstdlib>
#include <map>
#include <set>

#include "engine/core/rows.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/sweep_results.hpp"
#include "viewer/image/png.hpp"
#include "viewer/present/plot_picture.hpp"
#include "viewer/report/parts.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

/// The text between two marks, the first time they stand in that order.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return "";
  return text.substr(begin + from.size(), text.find(to, begin + from.size()) - begin - from.size());
}

/// A program's exit code and what it said.
Outcome program(const std::string& command) {
  const TempFolder streams;
  const int status = std::system(fmt::format("{} > {} 2>&1", command, (streams / "out").string()).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(streams / "out"), ""};
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

}  // namespace

TEST_CASE("the report of a sweep works in a browser, asks for nothing outside and says nothing on the console") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  folder.write("a.script", "expect kinetic_J < 1e6 at 3\n");  // the fastest crate fails it: a row with its reason
  REQUIRE(impinge_run(folder.path(),
                      {"sweep", "s.toml", "--script", "a.script", "--vary", "contact.friction=0,0.3,0.6", "--vary",
                       "simulation.substeps=1,2,4", "--vary", "body.crate.velocity=[1,0,0],[1e5,0,0]", "--reference",
                       "simulation.substeps=8", "--frames", "6", "--size", "320x180", "--out", "out"})
              .code == 1);
  CHECK(fs::exists(folder / "out/work_precision.png"));
  CHECK(read_png(folder / "out/heat_map.png").width == 1280);
  const std::string page = slurp(folder / "out/report.html");
  CHECK(page.find("a.script:1:1") != std::string::npos);  // the reason
  CHECK(page.find("http://") == std::string::npos);
  CHECK(page.find("https://") == std::string::npos);
  const Outcome used = program(fmt::format("python3 {}/tests/tools/report_in_browser.py {}", IMPINGE_SOURCE_DIR,
                                           (folder / "out/report.html").string()));
  if (used.code == 77 || used.code == 127) {
    WARN("not opened: this test needs python3 and chromium");
    return;
  }
  INFO(used.out);
  CHECK(used.code == 0);
  CHECK(used.out.find("FAILED") == std::string::npos);
  CHECK(count_of(used.out, "ok ") > 20);
}

TEST_CASE("the report gives each picture's range of colours, since each chooses its own") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  const auto ranges = [&](const std::string& out, const std::string& max) {
    REQUIRE(impinge_run(folder.path(),
                        {"sweep", "s.toml", "--set", "view.layer.heat=true", "--set", "view.heat.max=" + max, "--set",
                         "simulation.gravity=[0,0,0]", "--vary", "body.crate.velocity=[0,3,0],[0,30,0]", "--frames",
                         "1", "--size", "320x180", "--out", out})
                .code == 0);
    const std::string page = slurp(folder / out / "report.html");
    std::set<std::string> texts;
    for (std::size_t at = 0; (at = page.find("\"speed, ", at)) != std::string::npos; ++at)
      texts.insert(page.substr(at + 1, page.find('"', at + 1) - at - 1));
    return texts;
  };
  // 1, 2 or 5 times a power of ten above 3 and 30
  CHECK(ranges("own", "0") == std::set<std::string>{"speed, 0 to 5 m/s", "speed, 0 to 50 m/s"});
  CHECK(ranges("same", "40") == std::set<std::string>{"speed, 0 to 40 m/s"});
}

TEST_CASE("a sweep without reference, pictures and a second parameter has a report without their sections") {
  const TempFolder folder;
  folder.write("s.toml", kCrateScene);
  REQUIRE(impinge_run(folder.path(), {"sweep", "s.toml", "--vary", "contact.friction=0,0.3", "--frames", "2",
                                      "--no-images", "--out", "out"})
              .code == 0);
  const std::string page = slurp(folder / "out/report.html");
  CHECK(!fs::exists(folder / "out/work_precision.png"));
  CHECK(!fs::exists(folder / "out/heat_map.png"));
  CHECK(page.find("id=\"heat\"") == std::string::npos);
  CHECK(page.find("id=\"frames\"") == std::string::npos);
  CHECK(page.find("none was given") != std::string::npos);
  CHECK(page.find("One run each") != std::string::npos);
  // one body of six degrees of freedom, and friction only in the second job
  const std::string modelled = between(page, "id=\"modelled\"", "</table>");
  CHECK(count_of(modelled, "<td class=\"number\">6</td>") == 2);
  CHECK(count_of(modelled, "left out: no body has any, so contacts have one row") == 1);
}

TEST_CASE("the report takes whatever columns the table has, and nothing in it can end the page's data") {
  ParameterSet rows;
  double friction = 0.3;
  Rows(rows).add("contact.friction", friction, {0.0, 100.0}, "", "Coulomb coefficient.");
  const std::string csv =
      "hash,contact.friction,status,reason,step_ms,spread_step_ms,error_rms_m,my_force_N,note,wall_ms\n"
      "aa,0,done,,10,1,1e-3,5,x,20\n"
      "bb,1,done,,20,1,1e-4,6,y,30\n"
      "cc,2,done,,20,1,2e-4,7,z,30\n"
      "dd,3,diverged,\"frame 3, a \"\"body\"\" of </script>, 2 lines\nhere\",,,,,,\n";
  const ReportTable table = read_report_table(csv, {"contact.friction"}, {"contact.friction=9"}, rows);
  REQUIRE(table.rows.size() == 4);
  CHECK(table.cell(3, "reason") == "frame 3, a \"body\" of </script>, 2 lines\nhere");
  const auto column = [&](const char* name) { return table.columns[static_cast<std::size_t>(table.column(name))]; };
  CHECK(column("contact.friction").kind == ReportColumn::varied);
  CHECK(column("contact.friction").in_reference);
  CHECK(column("contact.friction").doc == "Coulomb coefficient.");
  CHECK(column("my_force_N").is_numeric);
  CHECK(column("my_force_N").unit == "N");
  CHECK(column("my_force_N").label == "my force");
  CHECK(column("my_force_N").is_main);
  CHECK(!column("note").is_numeric);
  CHECK(column("spread_step_ms").kind == ReportColumn::spread);
  CHECK(column("error_rms_m").distinct == 4);
  CHECK(table.best(table.column("step_ms"), table.column("error_rms_m")) ==
        std::vector<bool>{true, true, false, false});
  CHECK(html_text(table.cell(3, "reason")).find('<') == std::string::npos);
  CHECK(json_text(table.cell(3, "reason")) == "\"frame 3, a \\\"body\\\" of \\u003c/script>, 2 lines\\u000ahere\"");
  const TempFolder folder;
  CHECK(machine_html(table, folder.path())
            .find("spread_step_ms say how far the runs lie apart: 6.7 % of the time on average, 10.0 % at most") !=
        std::string::npos);
}

TEST_CASE("a formula is the truth for every job: a line a method, along the time step, and no caution") {
  ParameterSet rows;
  const std::string csv =
      "hash,response.method,simulation.substeps,contact.friction,status,reason,step_ms,error_rms_m,wall_ms,doubts\n"
      "aa,penalty,1,0.1,done,,10,1e-3,20,\nbb,penalty,2,0.1,done,,20,5e-4,30,\n"
      "cc,quick,1,0.1,done,,5,1e-4,20,it blew up\ndd,quick,2,0.2,done,,20,1e-4,30,\n";
  const std::vector<std::string> paths = {"response.method", "simulation.substeps", "contact.friction"};
  const ReportTable table = read_report_table(csv, paths, {"case:sliding"}, rows);
  const auto joined = [&](const ReportTable& of) {
    std::string names;
    for (const ReportColumn& column : of.columns)
      if (column.is_joined) names += (names.empty() ? "" : " ") + column.name;
    return names;
  };
  CHECK(joined(table) == "simulation.substeps");
  CHECK(joined(read_report_table(csv, paths, {"contact.friction=1"}, rows)) == "contact.friction");
  for (const std::string& path : paths) CHECK(table.columns[static_cast<std::size_t>(table.column(path))].in_reference);
  const ReportChoice choice = choose_columns(table);
  CHECK(work_precision_plot(table, choice, "s").series.size() == 3);
  // what is in doubt neither is best nor beats another
  CHECK(table.best(choice.x, choice.y) == std::vector<bool>{true, false, false, true});
  // and both pictures say which it is
  const Plot plot = work_precision_plot(table, choice, "s");
  CHECK(plot.doubtful == std::vector<Vec2>{Vec2(5, 1e-4)});
  CHECK(plot.best.size() == 2);
  HeatTable heat;
  REQUIRE(heat_table_of(table, choice, "s", heat));
  CHECK(heat.rows == std::vector<std::string>{"penalty", "quick"});
  CHECK(heat.doubtful == std::vector<bool>{false, false, true, false});
  const auto red = [](const Image& image) {
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::uint8_t* p = image.pixel(x, y);
        count += p[0] > 150 && p[1] < 60 && p[2] < 70;
      }
    return count;
  };
  Plot sure = plot;
  sure.doubtful.clear();
  HeatTable certain = heat;
  certain.doubtful.assign(4, false);
  CHECK(red(paint_plots({sure}, 640, 360).front()) == 0);
  CHECK(red(paint_heat_table(certain, 640, 360)) == 0);
  CHECK(red(paint_plots({plot}, 640, 360).front()) > 20);
  CHECK(red(paint_heat_table(heat, 640, 360)) > 20);
}

TEST_CASE(
    "of several values that the reference sets a line goes along one, and those beside it have lines of their own") {
  ParameterSet rows;
  const auto table_of = [&](const std::vector<std::string>& paths, const std::vector<std::string>& values,
                            const std::vector<std::string>& reference) {
    std::string csv =
        "hash," + fmt::format("{}", fmt::join(paths, ",")) + ",status,reason,step_ms,error_rms_m,doubts\n";
    for (std::size_t i = 0; i < values.size(); ++i)
      csv += fmt::format("a{},{},done,,{},{}e-3,\n", i, values[i], 3 + i, 9 - i);
    return read_report_table(csv, paths, reference, rows);
  };
  const auto lines_of = [](const ReportTable& table) {
    std::vector<std::string> lines;
    for (const PlotSeries& s : work_precision_plot(table, choose_columns(table), "s").series)
      lines.push_back(fmt::format("{}: {}", s.name, s.points.size()));
    return lines;
  };
  const std::vector<std::string> product = {"0,1", "0,2", "0,4", "4,1", "4,2", "4,4"};
  const std::vector<std::string> both = {"contact.second_looks=0", "simulation.substeps=64"};
  using Lines = std::vector<std::string>;
  // the time step, whichever stands first
  CHECK(lines_of(table_of({"contact.second_looks", "simulation.substeps"}, product, both)) ==
        Lines{"second_looks 0: 3", "second_looks 4: 3"});
  CHECK(lines_of(table_of({"simulation.substeps", "contact.second_looks"}, {"1,0", "1,4", "2,0", "2,4"}, both)) ==
        Lines{"second_looks 0: 2", "second_looks 4: 2"});
  // without it the one with the most values, and what the reference leaves alone as ever
  CHECK(lines_of(table_of({"contact.second_looks", "lcp.tolerance"}, product,
                          {"contact.second_looks=8", "lcp.tolerance=1e-12"})) ==
        Lines{"second_looks 0: 3", "second_looks 4: 3"});
  CHECK(lines_of(table_of({"contact.second_looks", "simulation.substeps"}, product, {"contact.second_looks=8"})) ==
        Lines{"substeps 1: 2", "substeps 2: 2", "substeps 4: 2"});
  // what changes only with it doesn't tell lines apart
  CHECK(lines_of(table_of({"lcp.tolerance", "simulation.substeps"}, {"1e-3,1", "1e-4,2", "1e-5,4"},
                          {"lcp.tolerance=1e-12", "simulation.substeps=64"})) == Lines{"all jobs: 3"});
}

TEST_CASE("a time axis of less than a decade has more than two labels") {
  // grid lines that cross the middle of the picture: of y there are none as thin
  const auto lines_across = [](double first, double last) {
    Plot plot;
    plot.series = {{"all jobs", {{first, 3e-4}, {last, 3e-4}}}};
    plot.marks_all = true;
    const Image image = paint_plots({plot}, 1280, 720).front();
    int lines = 0;
    for (int x = 1; x < image.width; ++x) {
      const auto is_grid = [&](int at) {
        const std::uint8_t* p = image.pixel(at, 90);
        return p[0] > 215 && p[0] < p[1] && p[1] < p[2] && p[2] < p[0] + 12;  // the pale grey of the grid
      };
      lines += is_grid(x) && !is_grid(x - 1);
    }
    return lines;
  };
  CHECK(lines_across(3.9, 8.4) >= 3);
  CHECK(lines_across(1.1, 1.9) >= 3);
  CHECK(lines_across(110.0, 250.0) >= 3);
  CHECK(lines_across(1.0, 400.0) >= 6);
  CHECK(lines_across(1.0, 400.0) <= 9);
  CHECK(lines_across(1e-3, 1e5) <= 9);  // decades alone
}

TEST_CASE("an ablation runs the scene with each economy off, and the sweep's report shows it") {
  const TempFolder folder;
  folder.write("s.toml", replaced(kCrateScene, "velocity = [1, 0, 0]\n", "velocity = [1, 0, 0]\nfriction = 0\n"));
  REQUIRE(impinge_run(folder.path(), {"sweep", "s.toml", "--vary", "contact.friction=0,0.3", "--frames", "2",
                                      "--no-images", "--out", "out"})
              .code == 0);
  CHECK(slurp(folder / "out/report.html").find("id=\"ablation\"") == std::string::npos);
  const Outcome outcome = impinge_run(folder.path(), {"info", "s.toml", "--ablation", "--frames", "8", "--out", "out"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  std::map<std::string, std::vector<std::string>> rows;
  const auto lines = parse_csv(slurp(folder / "out/ablation.csv"));
  for (std::size_t i = 1; i < lines.size(); ++i) rows[lines[i][0]] = lines[i];
  CHECK(lines[0].back() == "frame_ms");
  CHECK(rows.at("as it is")[5] == "0");
  CHECK(rows.at("as it is, once more")[5] == "0");  // the same bits
  CHECK(rows.at("broad phase")[5] == "0");          // finds the same pairs
  CHECK(rows.at("sleeping")[3] == "8");
  CHECK(rows.at("rows of friction 0")[2] == "body.crate.friction=1e-9");
  CHECK(std::stod(rows.at("rows of friction 0")[5]) < 1e-6);
  CHECK(std::stod(rows.at("coarse time steps")[5]) > 1e-6);  // gravity alone moves it otherwise
  CHECK(rows.at("narrow phase")[6] == "no use here");
  CHECK(rows.at("one system a group")[6] == "always");
  CHECK(rows.at("one system a group")[7].empty());
  CHECK(rows.at("all of these at once")[2].find("simulation.sleeping=false") != std::string::npos);
  REQUIRE(impinge_run(folder.path(), {"sweep", "s.toml", "--vary", "contact.friction=0,0.3", "--frames", "2",
                                      "--no-images", "--out", "out"})
              .code == 0);
  const std::string table = between(slurp(folder / "out/report.html"), "id=\"ablation\"", "</table>");
  CHECK(count_of(table, "<tr><th scope=\"row\">") == rows.size());

  check_refused(folder, {"info", "s.toml", "--frames", "3"}, "command line: ", "--ablation");
  check_refused(folder, {"info", "s.toml", "--ablation", "--frames", "0"}, "command line: ", "at least one frame");
  folder.write(
      "still.toml",
      "[[body]]\nname = \"floor\"\nkind = \"static\"\nshape = { plane = { normal = [0, 1, 0], offset = 0 } }\n");
  check_refused(folder, {"info", "still.toml", "--ablation"}, "still.toml: ", "nothing in it can move");
}
