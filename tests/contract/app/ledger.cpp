// ledger.csv of a run, and conditions that ask of it.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <cmath>
#include <map>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& text) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    return cells;
  };
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = split(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = split(line);
    REQUIRE(cells.size() == names.size());
    for (Row& row = rows.emplace_back(); const std::string& name : names) row[name] = cells[row.size()];
  }
  return rows;
}

Outcome run(const TempFolder& folder, const std::string& out, int frames, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"run",     "s.toml",     "--out", out, "--frames", std::to_string(frames),
                                    "--quiet", "--no-images"};
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

const std::vector<std::string> kKept = {"--set", "record.ledger=true"};

}  // namespace

TEST_CASE("a run writes its books where it is asked, they add up to its figures, and its states are the same") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(run(folder, "plain", 60).code == 0);
  REQUIRE(run(folder, "kept", 60, kKept).code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "plain/ledger.csv"));
  const std::vector<Row> books = rows_of(slurp(folder / "kept/ledger.csv")),
                         plain = rows_of(slurp(folder / "plain/stats.csv")),
                         kept = rows_of(slurp(folder / "kept/stats.csv"));
  REQUIRE(plain.size() == 61);
  int frames = 0;
  double turnover = 0.0, open = 0.0, friction = 0.0;
  for (Row row : books) {
    const auto number = [&row](const std::string& name) { return std::stod(row.at(name)); };
    double sum = 0.0;
    for (const char* source : {"damping", "impact", "friction", "attachment", "script", "push_out", "held_back",
                               "sleep", "solver", "integrator"})
      sum += number(std::string(source) + "_J"), turnover = std::max(turnover, std::abs(sum));
    open = std::max(open, std::abs(number("closing_J")));
    const double rise = number("kinetic_rise_J") + number("potential_rise_J") + number("elastic_rise_J");
    CHECK(rise - sum == Approx(number("closing_J")).margin(1e-9 * (std::abs(rise) + 1.0)));
    if (row["body"] != "*") continue;
    friction += number("friction_J");
    const auto frame = static_cast<std::size_t>(std::stoi(row["frame"]));
    CHECK(static_cast<int>(frame) == ++frames);
    // what stats.csv says of the two frames
    for (const std::string name : {"kinetic", "potential"})
      CHECK(number(name + "_rise_J") ==
            Approx(std::stod(kept[frame].at(name + "_J")) - std::stod(kept[frame - 1].at(name + "_J"))).margin(1e-8));
    CHECK(kept[frame].at("state_hash") == plain[frame].at("state_hash"));
  }
  CHECK(frames == 60);
  CHECK(friction < -0.1);
  CHECK(open <= 1e-9 * turnover);
}

TEST_CASE("the books of a run that was cut off and goes on are those of one that wasn't") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(run(folder, "whole", 40, kKept).code == 0);
  REQUIRE(run(folder, "parts", 20, kKept).code == 0);
  std::vector<std::string> resumed = kKept;
  resumed.emplace_back("--resume");
  REQUIRE(run(folder, "parts", 40, resumed).code == 0);
  CHECK(slurp(folder / "parts/ledger.csv") == slurp(folder / "whole/ledger.csv"));
}

TEST_CASE("a condition may ask for what a source did, and says which there are") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("good.script", "expect energy_from(gravity) > 0 at 5\nexpect energy_from(friction, crate) <= 0 at 30\n");
  folder.write("wrong.script", "expect energy_from(frictoin) > 0 at 5\n");
  std::vector<std::string> with_good = kKept, with_wrong = kKept;
  with_good.insert(with_good.end(), {"--script", "good.script"});
  with_wrong.insert(with_wrong.end(), {"--script", "wrong.script"});
  CHECK(run(folder, "a", 30, with_good).code == 0);
  const Outcome wrong = run(folder, "b", 30, with_wrong);
  INFO(wrong.err);
  CHECK(wrong.code == 2);
  CHECK(wrong.error_lines() == 1);
  CHECK(wrong.err.find("wrong.script:1:20: unknown source 'frictoin'") != std::string::npos);
  CHECK(wrong.err.find("did you mean 'friction'?") != std::string::npos);
  // where no books are kept nothing could hold, and nothing is made; a script may have them kept
  const Outcome without = run(folder, "c", 30, {"--script", "good.script"});
  INFO(without.err);
  CHECK(without.code == 2);
  CHECK(without.error_lines() == 1);
  CHECK(without.err.find("good.script:1:") == 0);
  CHECK(without.err.find("add --set record.ledger=true") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder / "c"));
  folder.write("own.script", "at 0 set record.ledger true\n" + slurp(folder / "good.script"));
  CHECK(run(folder, "d", 30, {"--script", "own.script"}).code == 0);
  folder.write("break.script", "break when energy_from(impact) < -1\n");
  CHECK(run(folder, "e", 30, {"--script", "break.script"}).code == 2);
}

TEST_CASE("the debugger finds the sub-step in which a source passes a bound, and plots sources") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write(
      "a.script",
      "step 40\nfind energy_from(impact,crate) < -1\npanel plot +energy_from(impact) +energy_from(impact,crate)\n"
      "seek 40\nplots p.csv\npanel front ledger\nshot a.png\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script", {"--out", "o", "--answers"});
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.out.find("energy_from(impact,crate) < -1 first holds in frame ") != std::string::npos);
  CHECK(outcome.out.find(", sub-step ") != std::string::npos);
  REQUIRE(run(folder, "run", 60, kKept).code == 0);
  std::map<int, double> impact;
  for (Row row : rows_of(slurp(folder / "run/ledger.csv")))
    if (row["body"] == "*") impact[std::stoi(row["frame"])] = std::stod(row["impact_J"]);
  std::istringstream table(slurp(folder / "o/p.csv"));
  std::string line;
  std::getline(table, line);
  CHECK(line.find("energy_from(impact),\"energy_from(impact,crate)\"") != std::string::npos);
  int compared = 0;
  while (std::getline(table, line)) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    const int frame = std::stoi(cells[0]);
    if (frame == 0) continue;
    REQUIRE(cells.size() == 7);
    CHECK(std::stod(cells[5]) == impact.at(frame));
    ++compared;
  }
  CHECK(compared == 40);
}
