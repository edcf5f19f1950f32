#include "engine/core/rows.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "engine/core/error.hpp"
#include "tests/support/random.hpp"

using namespace impinge;

namespace {

struct Example {
  bool on = true;
  int count = 4;
  double size = 0.5;
  Vec3 pull{0, -9.81, 0};
  std::string title = "drop";
  enum class Way { fast, exact } way = Way::fast;
  std::vector<std::string> layers{"meshes"};
  ParameterSet set;

  Example() {
    const Rows all(set), a = all.below("a");
    a.add("on", on, "switch");
    a.add("count", count, {1, 100}, "", "how many").formerly("a.number");
    all.add("contact.size", size, {0.0, 10.0}, "m", "how large").formerly("size").formerly("a.both");
    a.add("pull", pull, {-1e3, 1e3}, "m/s²", "which way");
    a.add("title", title, "words").formerly("a.both");
    all.add("response.method", way, {{Way::fast, "fast"}, {Way::exact, "exact"}}, "which");
    all.add("view.layers", layers, "which layers");
  }
  void put(const char* path, std::string_view text) { set.find(path)->set(parse_value(*set.find(path), text)); }
  std::string message(const char* path, std::string_view text) {
    try {
      put(path, text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

}  // namespace

TEST_CASE("a bound row reads and writes its variable") {
  Example e;
  e.put("a.on", "false");
  e.put("a.count", " 7 ");
  e.put("contact.size", "3");
  e.put("a.pull", "[1, -2.5, 3e-1]");
  e.put("a.title", "'two words'");
  e.put("response.method", "exact");
  e.put("view.layers", "[meshes, normals]");
  CHECK_FALSE(e.on);
  CHECK(e.count == 7);
  CHECK(e.size == 3.0);
  CHECK(e.pull == Vec3(1, -2.5, 0.3));
  CHECK(e.title == "two words");
  CHECK(e.way == Example::Way::exact);
  CHECK(format_value(e.set.find("response.method")->get()) == "exact");
  CHECK(format_value(e.set.find("response.method")->initial) == "fast");
  CHECK(e.layers == std::vector<std::string>{"meshes", "normals"});
  CHECK(std::get<double>(e.set.find("contact.size")->initial) == 0.5);
  e.put("a.pull", "0 -20 0");
  CHECK(e.pull == Vec3(0, -20, 0));
}

TEST_CASE("values that are not allowed are refused and change nothing") {
  Example e;
  for (const char* text : {"nan", "inf", "-inf", "1e999", "99999999999999999999999e300", "10.0000001", "-1e-300",
                           "0.5m", "", "0,5", "+-1", "true"})
    CHECK(e.message("contact.size", text) != "");
  for (const char* text : {"0", "101", "2.0", "99999999999999999999999", "x"}) CHECK(e.message("a.count", text) != "");
  for (const char* text : {"[1, 2]", "[1, 2, 3, 4]", "1 2", "[1, nan, 3]", "[1,,3]", "[1, 2, 3", "[1, 2, 2000]"})
    CHECK(e.message("a.pull", text) != "");
  CHECK(e.message("a.on", "yes") != "");
  CHECK(e.on);
  CHECK(e.size == 0.5);
  CHECK(e.count == 4);
  CHECK(e.pull == Vec3(0, -9.81, 0));
}

TEST_CASE("a message names what was found, what is allowed and the nearest name") {
  Example e;
  CHECK(e.message("contact.size", "11") == "11 is out of range for contact.size; allowed: a real number in [0, 10] m");
  CHECK(e.message("response.method", "exat") ==
        "'exat' is not known (did you mean 'exact'?) for response.method; allowed: one of fast, exact");
  CHECK(e.message("response.method", "octree") ==
        "'octree' is not known for response.method; allowed: one of fast, exact");
  CHECK(e.set.unknown_message("contact.siez") == "unknown parameter 'contact.siez'; did you mean 'contact.size'?");
  CHECK(e.set.nearest("size") == "contact.size");
  CHECK(e.set.nearest("wholly.different") == "");
}

TEST_CASE("a typed value is checked like a text") {
  Example e;
  const Parameter& size = *e.set.find("contact.size");
  CHECK(std::get<double>(checked_value(size, std::int64_t{3})) == 3.0);
  CHECK_THROWS_AS(checked_value(size, std::numeric_limits<double>::quiet_NaN()), InputError);
  CHECK_THROWS_AS(checked_value(size, std::numeric_limits<double>::infinity()), InputError);
  CHECK_THROWS_AS(checked_value(size, std::string("3")), InputError);
  CHECK_THROWS_AS(checked_value(*e.set.find("a.count"), 3.0), InputError);
  CHECK_THROWS_AS(checked_value(*e.set.find("a.pull"), Vec3(0, std::numeric_limits<double>::max(), 0)), InputError);
}

TEST_CASE("what is written reads back exactly") {
  Example e;
  e.set.add({.path = "a.free",
             .kind = ParameterKind::real,
             .unit = "",
             .range = {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()},
             .names = {},
             .doc = "",
             .initial = 0.0,
             .get = {},
             .set = {}});
  const Parameter& row = *e.set.find("a.free");
  test::Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const double value = random.sym() * std::pow(10.0, random.below(600) - 300);
    CHECK(std::get<double>(parse_value(row, format_value(value))) == value);
  }
  CHECK(format_value(0.1) == "0.1");
  CHECK(format_value(Vec3(0, -9.81, 1e-20)) == "[0, -9.81, 1e-20]");
  CHECK(format_value(std::vector<std::string>{"a", "b"}) == "[a, b]");
  CHECK(std::get<std::string>(parse_value(*e.set.find("a.title"), format_value(std::string(" x ")))) == " x ");
}

TEST_CASE("a path can be declared once only") {
  Example e;
  CHECK_THROWS_AS(Rows(e.set).add("a.on", e.on, "again"), InternalError);
  CHECK_THROWS_AS(Rows(e.set).add("a.other", e.on, "again").formerly("a.on"), InternalError);
  CHECK_THROWS_AS(Rows(e.set).add("a.number", e.on, "again"), InternalError);  // a former path is no present one
}

TEST_CASE("a former path leads to the present ones, and is none itself") {
  const Example e;
  CHECK(e.set.find("a.number") == nullptr);
  REQUIRE(e.set.renamed("a.number") != nullptr);
  CHECK(*e.set.renamed("a.number") == std::vector<std::string>{"a.count"});
  CHECK(*e.set.renamed("a.both") == std::vector<std::string>{"contact.size", "a.title"});
  CHECK(e.set.renamed("a.count") == nullptr);
  CHECK(e.set.nearest("a.numbr") == "");  // what is proposed is present
  for (const Parameter& row : e.set.all()) CHECK(e.set.renamed(row.path) == nullptr);
  CHECK(e.set.note_of_former({}) == "");
  CHECK(e.set.note_of_former({"a.number", "a.both", "a.number"}) ==
        "parameters have new paths: write contact.size and a.title for a.both, a.count for a.number");
}
