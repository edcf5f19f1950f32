// What a run says of a soft body that came to cross itself.
#include <catch2/catch.hpp>

#include <cstdio>

#include "tests/support/program/sweep_results.hpp"
#include "tests/support/program/twisted_strip.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kCrosses = "note:     'strip' crosses itself";

/// The output of a run of 30 frames, without a guard of its motions where that is said.
Outcome wind_up(const TempFolder& folder, double turns, const std::string& continuous) {
  folder.write("s.toml", twisted_strip(turns));
  return impinge_run(folder.path(), {"run", "s.toml", "--frames", "30", "--no-images", "--out", "o", "--set",
                                     "simulation.substeps=1", "--set", "narrow_phase.continuous=" + continuous});
}

}  // namespace

TEST_CASE(
    "a run says of a body that is to keep off itself from which frame on it crosses itself, and in how many places") {
  const TempFolder folder;
  const Outcome outcome = wind_up(folder, 4.0, "off");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  const std::size_t at = outcome.out.find(kCrosses);
  REQUIRE(at != std::string::npos);
  int first = 0, worst = 0, most = 0;
  REQUIRE(std::sscanf(outcome.out.c_str() + at,
                      "note:     'strip' crosses itself from frame %d on, in frame %d with %d", &first, &worst,
                      &most) == 3);
  const std::vector<Row> rows = csv_rows(folder / "o" / "stats.csv");
  REQUIRE(rows.size() == 31);
  int first_in_table = 0, most_in_table = 0;
  for (int frame = 30; frame >= 0; --frame) {
    const int count = std::stoi(rows[static_cast<std::size_t>(frame)].at("self_crossings"));
    if (count > 0) first_in_table = frame;
    most_in_table = std::max(most_in_table, count);
  }
  CHECK(first == first_in_table);
  CHECK(first > 0);
  CHECK(most == most_in_table);
  CHECK(std::stoi(rows.at(static_cast<std::size_t>(worst)).at("self_crossings")) == most);
}

TEST_CASE("a run says nothing of crossings of a body that keeps off itself") {
  const TempFolder folder;
  const Outcome outcome = wind_up(folder, 1.0, "auto");
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.out.find(kCrosses) == std::string::npos);
}
