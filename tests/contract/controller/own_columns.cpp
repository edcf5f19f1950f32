// record.columns: columns of stats.csv that a scene asks for, held against a throw by formula and a weight.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/support/program/debug_session.hpp"
#include "tests/support/program/sweep_results.hpp"

using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

// a frame of 1/10 s; by symplectic steps a body that falls for n of them from rest is g dt² n (n + 1)/2 lower
const std::string kThrown = R"([simulation]
gravity = [0, -10, 0]
frame_time = 0.1
substeps = 1
sleeping = false
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.5 } }
position = [3, 20, -4]
velocity = [-2, 5, 0.5]
[[body]]
name = "slab"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
material = { density = 500 }
position = [20, 0.25, 0]
)";
const std::string kColumns =
    "\n[record]\ncolumns = [\"x = position_x(ball)\", \"y=position_y(ball)\", \"push = force(floor,slab)\", "
    "\"twice = 2 * velocity_y(ball) + contacts\", \"late = time_s > 0.45\"]\n";

struct Folder {
  TempFolder folder;
  Folder() { folder.write("s.toml", kThrown + kColumns), folder.write("plain.toml", kThrown); }
  Outcome run(const std::string& out, int frames, const std::vector<std::string>& more = {},
              const std::string& scene = "s.toml") const {
    std::vector<std::string> words = {"run",     scene,        "--out", out, "--frames", std::to_string(frames),
                                      "--quiet", "--no-images"};
    words.insert(words.end(), more.begin(), more.end());
    return impinge_run(folder.path(), words);
  }
};

std::string first_line(const fs::path& file) {
  const std::string text = slurp(file);
  return text.substr(0, text.find('\n'));
}

/// Its rows without times.
std::vector<Row> timeless_rows(const fs::path& file) {
  std::vector<Row> rows = csv_rows(file);
  for (Row& row : rows) std::erase_if(row, [](const auto& cell) { return cell.first.ends_with("_ms"); });
  return rows;
}

}  // namespace

TEST_CASE("own columns: they are what a throw and a weight are by formula, and stand behind all others") {
  const Folder f;
  REQUIRE(f.run("out", 12).code == 0);
  REQUIRE(f.run("plain", 12, {}, "plain.toml").code == 0);
  const std::string plain = first_line(f.folder / "plain/stats.csv");
  CHECK(first_line(f.folder / "out/stats.csv") == plain + ",x,y,push,twice,late");
  const std::vector<Row> rows = csv_rows(f.folder / "out/stats.csv");
  REQUIRE(rows.size() == 13);
  for (int n = 0; n <= 12; ++n) {
    CAPTURE(n);
    const Row& row = rows[static_cast<std::size_t>(n)];
    const double t = 0.1 * n, vy = 5 - 10 * t;
    CHECK(std::stod(row.at("x")) == Approx(3 - 2 * t).epsilon(1e-13));
    CHECK(std::stod(row.at("y")) == Approx(20 + 5 * t - 0.05 * n * (n + 1)).epsilon(1e-13));
    CHECK(std::stod(row.at("twice")) == Approx(2 * vy + std::stod(row.at("contacts"))).margin(1e-12));
    // 500 kg/m³ of 0.5 m³, to ten times lcp.tolerance; frame 0 has no response
    CHECK(std::stod(row.at("push")) == Approx(n == 0 ? 0.0 : 2500.0).epsilon(1e-7));
    CHECK(row.at("late") == (n >= 5 ? "1" : "0"));
  }
  // and nothing else is another
  std::vector<Row> others = timeless_rows(f.folder / "out/stats.csv");
  for (Row& row : others)
    for (const char* own : {"x", "y", "push", "twice", "late"}) row.erase(own);
  CHECK(others == timeless_rows(f.folder / "plain/stats.csv"));
}

TEST_CASE("own columns: a run that goes on, a replay, a debugger and its bundle have the same bits") {
  const Folder f;
  REQUIRE(f.run("whole", 20).code == 0);
  const std::vector<Row> whole = timeless_rows(f.folder / "whole/stats.csv");
  REQUIRE(f.run("parts", 7).code == 0);
  REQUIRE(f.run("parts", 20, {"--resume"}).code == 0);
  CHECK(timeless_rows(f.folder / "parts/stats.csv") == whole);
  CHECK(impinge_run(f.folder.path(), {"replay", "parts"}).code == 0);
  CHECK(impinge_run(f.folder.path(), {"compare", "parts", "whole"}).code == 0);
  CHECK(impinge_run(f.folder.path(), {"why", "parts", "--pair", "floor", "slab"}).code == 0);
  // other columns are another run
  CHECK(f.run("parts", 20, {"--resume", "--set", "record.columns=[\"x = position_x(ball)\"]"}).code == 2);

  f.folder.write("b.script", "seek 9\nbundle b.tar\n");
  REQUIRE(debug(f.folder, "s.toml", "b.script").code == 0);
  const Outcome again = impinge_run(f.folder.path(), {"replay", "b.tar"});
  INFO(again.err);
  CHECK(again.code == 0);
  CHECK(again.out.find("10 frames repeated") != std::string::npos);
  // with a line by hand, which makes the later frames others; and a body more, which may change places
  f.folder.write("c.script",
                 "seek 5\nadd second like ball at 3 40 9\nseek 9\nbundle c.tar\nback\nset contact.friction 0\n"
                 "step 3\nbundle d.tar\n");
  const Outcome by_hand = debug(f.folder, "parts", "c.script");
  INFO(by_hand.err + by_hand.out);
  REQUIRE(by_hand.code == 0);
  for (const char* bundle : {"c.tar", "d.tar"}) CHECK(impinge_run(f.folder.path(), {"replay", bundle}).code == 0);

  // a bundle that is made smaller loses a body that only a column speaks of
  const Outcome less =
      impinge_run(f.folder.path(), {"shrink", "b.tar", "--when", "position_y(ball) > 20.5", "--out", "less.tar"});
  INFO(less.err + less.out);
  REQUIRE(less.code == 0);
  CHECK(impinge_run(f.folder.path(), {"replay", "less.tar"}).code == 0);
  CHECK(less.out.find("slab") == std::string::npos);
}

TEST_CASE("own columns: a body that is deleted has no more figures than one that is yet to be added") {
  const Folder f;
  f.folder.write("a.script", "at 4 delete ball\nat 6 add late like slab at 40 0.25 0\n");
  const std::string columns =
      "record.columns=[x=position_x(ball), v=speed(ball), late=position_x(late), fast=speed(ball) > 1]";
  REQUIRE(f.run("out", 9, {"--script", "a.script", "--set", columns}, "plain.toml").code == 0);
  const std::vector<Row> rows = csv_rows(f.folder / "out/stats.csv");
  REQUIRE(rows.size() == 10);
  for (int n = 0; n <= 9; ++n) {
    CAPTURE(n);
    const Row& row = rows[static_cast<std::size_t>(n)];
    if (n < 4) {
      CHECK(std::stod(row.at("x")) == Approx(3 - 0.2 * n).epsilon(1e-13));
      CHECK(std::stod(row.at("v")) == Approx(std::hypot(-2.0, 5.0 - n, 0.5)).epsilon(1e-13));
    } else {
      CHECK(row.at("x") == "nan");
      CHECK(row.at("v") == "nan");
    }
    CHECK(row.at("fast") == (n < 4 ? "1" : "0"));
    if (n < 6)
      CHECK(row.at("late") == "nan");
    else
      CHECK(std::stod(row.at("late")) == Approx(40.0));
  }
}

TEST_CASE("own columns: a sweep's columns, table and report take them, and its jobs' hashes hold them") {
  const Folder f;
  const auto sweep = [&](const std::string& out, const std::string& scene, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--vary", "body.ball.velocity=[-2,5,0],[1,5,0],[4,5,0]", "--frames", "10"};
    words.insert(words.end(), more.begin(), more.end());
    return impinge_run(f.folder.path(), SweepFiles::words(out, words, scene));
  };
  const Outcome made = sweep("out", "plain.toml",
                             {"--set", "record.columns=[x=position_x(ball), push=force(floor,slab)]", "--column",
                              "end=last(x)", "--column", "way=max(x) - min(x)", "--column", "weight_N=mean(push)"});
  INFO(made.err);
  REQUIRE(made.code == 0);
  const std::vector<Row> rows = sweep_results(f.folder / "out");
  REQUIRE(rows.size() == 3);
  const double speeds[] = {-2, 1, 4};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::stod(rows[i].at("end")) == Approx(3 + speeds[i]).epsilon(1e-13));
    CHECK(std::stod(rows[i].at("way")) == Approx(std::abs(speeds[i])).epsilon(1e-13));
    CHECK(std::stod(rows[i].at("weight_N")) == Approx(2500.0 * 10 / 11).epsilon(1e-7));
  }
  CHECK(slurp(f.folder / "out/report.html").find("{\"name\":\"end\",\"label\":\"end\"") != std::string::npos);
  // other columns are other jobs, with the same states
  REQUIRE(sweep("plain", "plain.toml", {}).code == 0);
  const std::vector<Row> plain = sweep_results(f.folder / "plain");
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(plain[i].at("hash") != rows[i].at("hash"));
    CHECK(plain[i].at("state_hash") == rows[i].at("state_hash"));
  }
  // from the scene itself, with a reference; and a job alone
  REQUIRE(sweep("scene", "s.toml", {"--reference", "simulation.substeps=4", "--column", "end=last(x)"}).code == 0);
  CHECK(column(sweep_results(f.folder / "scene"), "end") == column(rows, "end"));
  CHECK(impinge_run(f.folder.path(), {"sweep", "--job", rows[0].at("hash"), "--out", "out"}).code == 0);
}

TEST_CASE("own columns: what can't be is refused at its place") {
  const Folder f;
  const auto refused = [&](const std::string& item, const std::string& contains) {
    f.folder.write("bad.toml", kThrown + "[record]\ncolumns = [" + item + "]\n");
    check_refused(f.folder, {"run", "bad.toml", "--out", "no"}, "bad.toml:23:11: ", contains);
  };
  refused("\"x = position_x(bal)\"",
          "record.columns:1:16: unknown body 'bal'; bodies: floor, ball, slab; did you mean");
  refused("\"x = position(ball)\"", "unknown function 'position'");
  refused("\"x = contact\"", "unknown figure 'contact'");
  refused("\"position_x(ball)\"", "no NAME = EXPR");
  refused("\"2x = 1\"", "no digit first");
  refused("\"x y = 1\"", "'x y' as a name");
  refused("\"contacts = 1\"", "a second column 'contacts'");
  refused("\"judged_penetration_m = 1\"", "a second column");
  refused("\"x = 1\", \"x = 2\"", "a second column 'x'");
  refused("\"x = step_ms\"", "end in _ms");
  refused("\"x_ms = contacts\"", "end in _ms");
  refused("\"x = \"", "a number, a figure's name or '('");
  refused("\"x = judged_penetration_m\"", "unknown figure 'judged_penetration_m'");
  check_refused(f.folder, {"run", "plain.toml", "--out", "no", "--set", "record.columns=x=force(floor,slap)"},
                "--set record.columns=x=force(floor,slap): ", "did you mean 'slab'?");
  check_refused(f.folder, {"run", "plain.toml", "--out", "no", "--set", "record.columns=x=energy_from(gravity)"},
                "--set record.columns=", "record.ledger");
  f.folder.write("a.script", "at 0 set record.columns [x=position_x(ball)]\n");
  check_refused(f.folder, {"run", "plain.toml", "--script", "a.script", "--out", "no"},
                "a.script:1:", "record.columns in a script");
  const std::vector<std::string> vary = {"--vary", "contact.friction=0,1"};
  const auto words = [&](const std::vector<std::string>& more, const std::string& start, const std::string& contains) {
    std::vector<std::string> all = SweepFiles::words("no", more, "plain.toml");
    all.insert(all.end(), vary.begin(), vary.end());
    check_refused(f.folder, all, start, contains);
  };
  words({"--column", "a=last(position_x(ball))"},
        "--column a=last(position_x(ball)): ", "--set 'record.columns=[\"a = position_x(ball)\"]'");
  words({"--column", "a=last(x)"}, "--column:1:3: ", "unknown figure 'last(x)'");
  words({"--vary", "record.columns=[x=1],[y=1]"}, "--vary record.columns=", "the same in all jobs");
}
