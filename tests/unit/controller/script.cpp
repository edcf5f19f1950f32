#include "viewer/controller/script.hpp"

#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "engine/core/rows.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

struct Known {
  double friction = 0.3;
  int sweeps = 10, other_sweeps = 10;
  Vec3 gravity{0, -10, 0};
  bool fixed = false;
  std::vector<std::string> layers{"meshes"};
  ParameterSet set;
  Known() {
    const Rows rows(set);
    rows.add("contact.friction", friction, {0, 10}, "", "");
    rows.add("lcp.sweeps", sweeps, {0, 1000}, "", "").formerly("lcp.rounds").formerly("both");
    rows.add("lcp.other_sweeps", other_sweeps, {0, 1000}, "", "").formerly("both");
    rows.add("simulation.gravity", gravity, {-100, 100}, "m/s²", "");
    Parameter row;
    row.path = "start.only";
    row.kind = ParameterKind::boolean;
    row.live = false;
    row.initial = false;
    row.get = [this] { return ParameterValue(fixed); };
    row.set = [this](const ParameterValue& v) { fixed = std::get<bool>(v); };
    set.add(row);
    Parameter list;
    list.path = "view.layers";
    list.kind = ParameterKind::text_list;
    list.names = {"meshes", "contacts"};
    list.initial = layers;
    set.add(list);
  }
};

const std::vector<std::string> kFigures = {"a", "b", "contacts"};

Script script(const Known& rows, const std::vector<std::string>& lines) {
  return Script("t.script", "", lines, rows.set, kFigures);
}

bool holds(const std::string& text, std::vector<double> values) {
  const std::string file = "x";
  return Expression({text, &file, 1, 1}, kFigures).holds(values);
}

bool refused(const std::string& text) {
  const std::string file = "x";
  try {
    Expression({text, &file, 1, 1}, kFigures);
    return false;
  } catch (const InputError&) {
    return true;
  }
}

}  // namespace

TEST_CASE("commands come with their frame, in the order of the lines") {
  const Known rows;
  const Script s = script(rows, {"at 2 set contact.friction 0.5 # why", "", "at 0 layer +contacts -meshes",
                                 "at 2 camera eye [1, 2, 3]", "at 2 camera fit", "at 0 set start.only true"});
  CHECK(s.commands_at(1).empty());
  REQUIRE(s.commands_at(2).size() == 3);
  CHECK(format_command(s.commands_at(2)[0]) == "set contact.friction 0.5");
  CHECK(format_command(s.commands_at(2)[1]) == "camera eye 1 2 3");
  CHECK(format_command(s.commands_at(2)[2]) == "camera fit");
  CHECK(format_command(s.commands_at(0)[0]) == "layer +contacts -meshes");
  CHECK(s.last_frame() == 2);
  CHECK_THROWS_AS(script(rows, {"at 1 set start.only true"}), InputError);
}

TEST_CASE("a ramp is linear and reaches both ends exactly") {
  const Known rows;
  const Script s =
      script(rows, {"from 5 to 12 ramp contact.friction 0.1 0.7", "from 5 to 7 ramp simulation.gravity 0 -10 0 1 -20 3",
                    "from 3 to 7 ramp lcp.sweeps 10 15", "from 9 to 9 ramp contact.friction 1 2"});
  const auto value = [&](int frame, std::size_t i) { return std::get<SetCommand>(s.commands_at(frame).at(i)).value; };
  CHECK(s.commands_at(2).empty());
  CHECK(std::get<double>(value(5, 0)) == 0.1);
  CHECK(std::get<double>(value(12, 0)) == 0.7);
  for (int k = 5; k <= 12; ++k)
    CHECK(std::get<double>(value(k, 0)) == Approx(0.1 + 0.6 * (k - 5) / 7.0).epsilon(1e-14));
  CHECK(std::get<Vec3>(value(6, 1)) == Vec3(0.5, -15, 1.5));
  CHECK(std::get<std::int64_t>(value(3, 0)) == 10);
  CHECK(std::get<std::int64_t>(value(4, 0)) == 11);
  CHECK(std::get<std::int64_t>(value(7, 2)) == 15);
  CHECK(std::get<double>(value(9, 1)) == 2.0);
  CHECK(s.commands_at(13).empty());
}

TEST_CASE("a former path is read as the present ones, and known to have been used") {
  const Known rows;
  const Script s = script(rows, {"at 1 set lcp.rounds 7", "at 2 set both 8", "from 3 to 4 ramp both 0 10"});
  const auto lines = [&](int frame) {
    std::string all;
    for (const Command& command : s.commands_at(frame)) all += format_command(command) + "; ";
    return all;
  };
  CHECK(lines(1) == "set lcp.sweeps 7; ");
  CHECK(lines(2) == "set lcp.sweeps 8; set lcp.other_sweeps 8; ");
  CHECK(lines(4) == "set lcp.sweeps 10; set lcp.other_sweeps 10; ");
  CHECK(rows.set.note_of_former(s.former_paths()) ==
        "parameters have new paths: write lcp.sweeps and lcp.other_sweeps for both, lcp.sweeps for lcp.rounds");
  CHECK(script(rows, {"at 1 set lcp.sweeps 7"}).former_paths().empty());
  CHECK_THROWS_AS(script(rows, {"at 1 set lcp.rounds 1001"}), InputError);
}

TEST_CASE("conditions follow the usual rules of precedence") {
  CHECK(holds("1 + 2 * 3 == 7", {0, 0, 0}));
  CHECK(holds("(1 + 2) * 3 == 9", {0, 0, 0}));
  CHECK(holds("8 / 4 / 2 == 1", {0, 0, 0}));
  CHECK(holds("5 - 3 - 1 == 1", {0, 0, 0}));
  CHECK(holds("-a < b && contacts >= 3", {1, 0, 3}));
  CHECK(holds("a > 1 || b > 1 && contacts > 1", {2, 0, 0}));
  CHECK_FALSE(holds("(a > 1 || b > 1) && contacts > 1", {2, 0, 0}));
  CHECK(holds("!(a > 1) && !b > 5 || a != a + 1", {0, 0, 0}));
  CHECK(holds("a > 1e-3", {2e-3, 0, 0}));
  CHECK(holds("abs(a) + abs( b - 7 ) * 2 == 11 && -abs(-a) == -3 && abs(abs(-2)) == 2", {-3, 3, 0}));
  CHECK_FALSE(holds("abs(a - b) < 5", {-3, 3, 0}));
  for (const char* text : {"a > 1", "a < 1", "a == a", "a != a", "a >= 0"})
    CHECK_FALSE(holds(text, {std::numeric_limits<double>::quiet_NaN(), 0, 0}));
  for (const char* text : {"",          "a",         "a >",           "> a",    "a > 1 2",         "a > (1",
                           "a > 1)",    "a = 1",     "a & b",         "x > 1",  "a > 1 > 2",       "(a > 1) + 1 > 0",
                           "a && b",    "1e999 > a", "a > 1 ||",      "!a",     "abs(a > 1) == 1", "abs a > 1",
                           "abs(a > 1", "abs() > 1", "abs(a, b) > 1", "abs > 1"}) {
    INFO(text);
    CHECK(refused(text));
  }
  CHECK(refused(fmt::format("{0}a > 1{1}", std::string(1000, '('), std::string(1000, ')'))));
  CHECK(refused(fmt::format("{}(a > 1)", std::string(1000, '!'))));
}

TEST_CASE("conditions may ask of bodies, by names that may hold a minus") {
  static const std::string file = "c";
  ExpressionWords words;
  words.names = kFigures;
  words.bodies = {"floor", "b-1", "b"};
  const auto read = [&](std::string_view text) { return Expression({text, &file, 1, 1}, words); };
  const auto refusal = [&](std::string_view text) -> std::string {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Expression two = read("contacts(floor, b-1) - contacts > 2 && speed( b ) < 1 || contacts(floor,b-1) == 9");
  REQUIRE(two.terms().size() == 2);  // asked once, however often it is named
  CHECK(two.terms()[0].function == BodyFunction::contacts);
  CHECK(two.terms()[0].a == 0);
  CHECK(two.terms()[0].b == 1);
  CHECK(two.terms()[1].a == 2);
  CHECK(two.holds(std::vector<double>{0, 0, 1, 4, 0.5}));
  CHECK_FALSE(two.holds(std::vector<double>{0, 0, 1, 3, 0.5}));
  CHECK(two.holds(std::vector<double>{0, 0, 1, 9, 5.0}));
  CHECK(two.describe(std::vector<double>{0, 0, 1, 4, 0.5}, kFigures) ==
        "contacts(floor,b-1) = 4, contacts = 1, speed(b) = 0.5");
  CHECK(read("depth(b,floor) + gap(b, floor) - energy(b-1) >= -1").terms().size() == 3);
  CHECK(refusal("depth(bb,floor) > 0") == "c:1:7: unknown body 'bb'; bodies: floor, b-1, b; use one of them");
  CHECK(refusal("spead(b) > 0").find("did you mean 'speed'?") != std::string::npos);
  CHECK(refusal("speed(b, floor) > 0").find("one body") != std::string::npos);
  CHECK(refusal("depth(b) > 0").find("two bodies") != std::string::npos);
  CHECK(refusal("depth(b, floor > 0").find("')' should stand here") != std::string::npos);
  CHECK(refusal("depth(b, 3) > 0").find("unknown body '3'") != std::string::npos);
  CHECK(refusal("depth > 0").find("unknown figure 'depth'") != std::string::npos);
  CHECK(refused("contacts(a,b) > 0"));  // where there are no bodies to speak of
}

TEST_CASE("damaged scripts are refused or read, never more") {
  const Known rows;
  const std::string lines[] = {"from 5 to 12 ramp contact.friction 0.1 0.7",
                               "at 2 set simulation.gravity [0, -10, 0]",
                               "at 2 camera orbit 30 -5.5",
                               "expect contacts > 0 && (a + 1) * 2 < b at 120",
                               "expect abs(a - 1) < 2 from 10 to 120",
                               "break when a / b >= 1e-3",
                               "at 0 layer +contacts -meshes"};
  test::Random random(5);
  int bad = 0, good = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string line = lines[random.below(7)];
    for (int n = 1 + random.below(3); n > 0 && !line.empty(); --n) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(line.size())));
      if (random.below(3) == 0)
        line.erase(at, 1 + random.below(3));
      else
        line[at] = " 0123456789-+.e[]()<>=!&|#\"atx"[random.below(30)];
    }
    try {
      script(rows, {line});
      ++good;
    } catch (const InputError& error) {
      REQUIRE(std::string(error.what()).rfind("t.script:1:", 0) == 0);
      ++bad;
    }
  }
  CHECK(bad > 1000);
  CHECK(good > 100);
}
