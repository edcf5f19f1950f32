// Figures of single bodies and pairs over the frames: in the timeline, as a table, and as trails in the view.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::vector<std::vector<std::string>> table(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) rows.push_back(split(line));
  return rows;
}

}  // namespace

TEST_CASE("the table of plots has what a fall by formula and contacts.csv have") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "panel plot -contacts -max_penetration_m -kinetic_J\n"
               "panel plot +speed(ball) +contacts(crate,floor) +gap(floor,crate) +depth(crate) +contacts(crate)\n"
               "panel plot +velocity_y(ball) +position_y(ball)\n"
               "step 60\nback 10\nplots p.csv\npanel axis log\nshot end.png\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script", {"--out", "one", "--record", "r.script"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const auto rows = table(slurp(folder / "one/p.csv"));
  REQUIRE(rows.size() == 62);
  CHECK(rows[0] == std::vector<std::string>{"frame", "time_s", "speed(ball)", "contacts(crate,floor)",
                                            "gap(floor,crate)", "depth(crate)", "contacts(crate)", "velocity_y(ball)",
                                            "position_y(ball)"});
  for (int frame = 0; frame <= 8; ++frame) {  // nothing touches the ball yet
    CHECK(std::abs(std::stod(rows[frame + 1][2]) - 9.81 * frame / 60.0) < 1e-9);
    CHECK(std::abs(std::stod(rows[frame + 1][7]) + 9.81 * frame / 60.0) < 1e-9);
    const double n = 2.0 * frame, dt = 1.0 / 120.0;  // sub-steps of kRigid
    CHECK(std::abs(std::stod(rows[frame + 1][8]) - std::stod(rows[1][8]) + 9.81 * dt * dt * n * (n + 1) / 2) < 1e-9);
  }

  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "run", "--frames", "60", "--no-images", "--contacts"})
              .code == 0);
  const auto contacts = table(slurp(folder / "run/contacts.csv"));
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(contacts[0].begin(), contacts[0].end(), name) - contacts[0].begin());
  };
  std::map<int, std::pair<int, double>> of_pair, of_crate;  // count, least gap
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    const auto take = [&](std::map<int, std::pair<int, double>>& all) {
      auto& [count, gap] = all.try_emplace(std::stoi(contacts[i][0]), 0, 1e300).first->second;
      ++count;
      gap = std::min(gap, std::stod(contacts[i][column("gap_m")]));
    };
    const std::string a = contacts[i][column("body_a")], b = contacts[i][column("body_b")];
    if (a == "floor" && b == "crate") take(of_pair);
    if (a == "crate" || b == "crate") take(of_crate);
  }
  CHECK(of_pair.size() > 10);
  for (int frame = 0; frame <= 60; ++frame) {
    CAPTURE(frame);
    const std::vector<std::string>& row = rows[static_cast<std::size_t>(frame) + 1];
    const auto pair = of_pair.find(frame), crate = of_crate.find(frame);
    CHECK(std::stoi(row[3]) == (pair == of_pair.end() ? 0 : pair->second.first));
    CHECK(row[4].empty() == (pair == of_pair.end()));
    if (pair != of_pair.end()) CHECK(std::stod(row[4]) == Approx(pair->second.second).epsilon(1e-12));
    const double depth = crate == of_crate.end() ? 0.0 : std::max(0.0, -crate->second.second);
    CHECK(std::stod(row[5]) == Approx(depth).epsilon(1e-12));
    CHECK(std::stoi(row[6]) == (crate == of_crate.end() ? 0 : crate->second.first));
  }

  const Outcome again = debug(folder, "s.toml", "r.script", {"--out", "two"});
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(slurp(folder / "two/p.csv") == slurp(folder / "one/p.csv"));
  CHECK(slurp(folder / "two/end.png") == slurp(folder / "one/end.png"));
}

TEST_CASE("trails and a ghost are seen, follow the frame, and go away") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "step 40\npanel scroll console 0\nshot plain.png\npanel trails on\nshot trails.png\npanel trails off\n"
               "panel ghost 0\nshot ghost.png\npanel ghost off\nshot again.png\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script", {"--out", "o"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  // the view alone: the console tells what was done
  const auto view = [&](const char* name) {
    const Image whole = read_png(folder.path() / "o" / name);
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < 400; ++y)
      pixels.insert(pixels.end(), whole.pixel(240, y), whole.pixel(240, y) + 3 * (whole.width - 520));
    return pixels;
  };
  CHECK((view("again.png") == view("plain.png")));
  CHECK((view("trails.png") != view("plain.png")));
  CHECK((view("ghost.png") != view("plain.png")));
  CHECK((view("ghost.png") != view("trails.png")));
}

TEST_CASE("a figure of a body that is not there is one message") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const std::pair<const char*, const char*> cases[] = {
      {"panel plot +speed(bal)\n",
       "a.script:1:13: 'speed(bal)'; contacts(a), contacts(a,b), depth(a), depth(a,b), gap(a), gap(a,b), force(a), "
       "force(a,b), speed(a), position_x(a), position_y(a), position_z(a), velocity_x(a), velocity_y(a), "
       "velocity_z(a), "
       "energy_from(source), energy_from(source,a) of bodies floor, crate, ball, without blanks, are wanted; mend the "
       "name"},
      {"panel plot +speed(ball,crate)\n", "a.script:1:13: 'speed(ball,crate)'; "},
      {"panel plot +sped(ball)\n", "a.script:1:13: 'sped(ball)'; "},
      {"panel plot speed(ball)\n", "a.script:1:12: 'speed(ball)'; +COLUMN or -COLUMN is wanted; "},
      {"plots a.png\n", "a.script:1:7: 'a.png'; a file name that ends in .csv is wanted; add .csv"},
      {"panel ghost x\n", "a.script:1:13: "},
  };
  for (const auto& [line, message] : cases) {
    CAPTURE(line);
    folder.write("a.script", line);
    check_refused(debug(folder, "s.toml", "a.script"), message);
  }
}
