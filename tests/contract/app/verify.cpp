// impinge verify: its table counts what queries with known answers say, and damaged queries are refused at their place.
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// A vertex at (1/4, 1/4, from) that goes to height `to` through a face in the plane z = 0, or not.
std::string query(int from, int to, bool meets) {
  const std::string answer = meets ? ",1\n" : ",0\n";
  const std::string face = "0,1,0,1,0,1" + answer + "1,1,0,1,0,1" + answer + "0,1,1,1,0,1" + answer;
  const auto vertex = [&](int height) { return "1,4,1,4," + std::to_string(height) + ",2" + answer; };
  return vertex(from) + face + vertex(to) + face;
}

std::vector<std::string> verify() { return {"verify", "ccd", "--queries", "data"}; }

}  // namespace

TEST_CASE("verify ccd counts meetings, misses and alarms") {
  const TempFolder folder;
  folder.write("data/falls/vertex-face/a.csv", query(1, -1, true) + query(2, 1, false) + query(-1, 3, true));
  folder.write("data/stays/vertex-face/a.csv", query(1, 1, false));
  folder.write("data/notes.csv", "no query at all");
  const Outcome outcome = impinge_run(folder.path(), verify());
  CHECK(outcome.code == 0);
  for (const std::string line : {"falls  inclusion           2       0        1       0      0.00",
                                 "stays  inclusion           0       0        1",
                                 "all    advancement         2       0        2       0      0.00"}) {
    INFO(outcome.out);
    CHECK(outcome.out.find(line) != std::string::npos);
  }
  // an answer that isn't so: a query that cannot meet is said to meet
  folder.write("data/falls/vertex-face/b.csv", query(4, 3, true));
  const Outcome wrong = impinge_run(folder.path(), verify());
  CHECK(wrong.code == 1);
  CHECK(wrong.err.find("meetings are missed") != std::string::npos);
  // and one that meets is said not to
  folder.write("data/falls/vertex-face/b.csv", query(1, -1, false));
  const Outcome alarm = impinge_run(folder.path(), verify());
  CHECK(alarm.code == 0);
  CHECK(alarm.out.find("falls  inclusion           2       0        2       1     50.00") != std::string::npos);
}

TEST_CASE("verify ccd refuses damaged queries at their place") {
  const TempFolder folder;
  const auto refused = [&](const std::string& text, const std::string& place, const std::string& what) {
    folder.write("data/set/edge-edge/q.csv", text);
    check_refused(folder, verify(), "data/set/edge-edge/" + place, what);
  };
  const std::string whole = query(1, -1, true);
  refused("1,2,3\n", "q.csv:1:1: ", "3 values");
  refused(whole.substr(0, whole.size() - 14), "q.csv:", "eight");
  refused("1,0" + whole.substr(3), "q.csv:1:3: ", "denominator of 0");
  refused("x,1" + whole.substr(3), "q.csv:1:1: ", "'x'");
  refused("nan,1" + whole.substr(3), "q.csv:1:1: ", "nan");
  std::string mixed = whole;
  mixed[mixed.size() - 2] = '0';
  refused(mixed, "q.csv:8:", "another answer");
  folder.write("other/a.csv", whole);
  check_refused(folder, {"verify", "ccd", "--queries", "other"}, "other: ", "no queries");
  check_refused(folder, {"verify", "ccd", "--queries", "nowhere"}, "nowhere: ", "No such file");
}
