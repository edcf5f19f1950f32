// Scene text as a tree: what it holds, where everything stands, and what is refused before a parser sees it.
#include "engine/io/scene/toml.hpp"

#include <catch2/catch.hpp>

#include "engine/core/error.hpp"
#include "engine/io/scene/toml_prescan.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

std::string refusal(const std::string& text) {
  try {
    parse_toml("s", text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void check_refused(const std::string& text, const std::string& place, const std::string& contains) {
  const std::string message = refusal(text);
  INFO(text.substr(0, 200));
  INFO(message);
  CHECK(message.rfind("s:" + place + ": ", 0) == 0);
  CHECK(message.find(contains) != std::string::npos);
}

std::string times(int count, const std::string& text) {
  std::string out;
  for (int i = 0; i < count; ++i) out += text;
  return out;
}

/// "a 1:1 1:5 b 2:3 2:7": each key with its place and its value's, in the tree's order.
void list_places(const TomlNode& node, std::string& out) {
  for (const TomlEntry& entry : node.entries) {
    out += fmt::format("{} {} {}\n", entry.key, entry.place.substr(2), entry.value.place.substr(2));
    list_places(entry.value, out);
  }
  for (const TomlNode& item : node.items) {
    out += fmt::format("- {}\n", item.place.substr(2));
    list_places(item, out);
  }
}

}  // namespace

TEST_CASE("every key and value of a text knows its line and character") {
  const std::string text =
      "# ä\n"
      "[view]\n"
      "camera = { eye = [3, 2, 4], target.x = 1 }\n"
      "name = 'ä', \n";
  CHECK(refusal(text).rfind("s:4:11: broken TOML", 0) == 0);  // counted in characters

  std::string places;
  list_places(parse_toml("s",
                         "[view]\r\n"
                         "camera = { eye = [3, -2.5], 'a b' = true } # [\r\n"
                         "x.y.z = \"\"\"a\n[b]\n\"\"\"\n"
                         "[[body]]\n"
                         "  name = 'ä' # ö\n"
                         "[body.material]\n"
                         "young = 1e5\n"
                         "[[body]]\n"
                         "[c.d]\n"
                         "e = [ # one\n"
                         "  { k = 1 },\n"
                         "]\n"),
              places);
  CHECK(places ==
        "view 1:2 1:1\n"
        "camera 2:1 2:10\n"
        "eye 2:12 2:18\n"
        "- 2:19\n"
        "- 2:22\n"
        "a b 2:29 2:37\n"
        "x 3:1 3:1\n"
        "y 3:3 3:3\n"
        "z 3:5 3:9\n"
        "body 6:3 6:1\n"
        "- 6:1\n"
        "name 7:3 7:10\n"
        "material 8:7 8:1\n"
        "young 9:1 9:9\n"
        "- 10:1\n"
        "c 11:2 11:1\n"
        "d 11:4 11:1\n"
        "e 12:1 12:5\n"
        "- 13:3\n"
        "k 13:5 13:9\n");
}

TEST_CASE("a table's entries stand in the order of the text") {
  const TomlNode root = parse_toml("s", "z = 1\na = 2\n[m]\nb = 3\n[g]\n");
  std::string order;
  for (const TomlEntry& entry : root.entries) order += entry.key;
  CHECK(order == "zamg");
}

TEST_CASE("values are what TOML 1.0 says") {
  const TomlNode root = parse_toml("s", R"(
t = [ "a\tb\"\\\u00e4\U0001F600", 'C:\n"', """
first \
   second ""quoted""", """""x""""", '''
raw\n''', "" ]
i = [ 0, +17, -1_000, 0xDEAD_beef, 0o755, 0b1101, 9223372036854775807, -9223372036854775808 ]
r = [ 1.0, +1e5, -2.5E-3, 6.02_2e+2_3, 0.0, -0.0, 1e06, 5e-324, 1.7976931348623157e308, 0.1 ]
n = [ inf, +inf, -inf, nan ]
f = [ true, false ]
d = [ 1979-05-27, 07:32:00, 1979-05-27T07:32:00.999, 1979-05-27 07:32:00Z, 2000-02-29t23:59:60+05:30 ]
"a b".c . 'd.e' = { x = 1, y.z = [ { w = {} } ] }
)");
  const auto list = [&](const char* key) -> const std::vector<TomlNode>& { return root.find(key)->value.items; };
  CHECK(list("t")[0].string == "a\tb\"\\\xC3\xA4\xF0\x9F\x98\x80");
  CHECK(list("t")[1].string == "C:\\n\"");
  CHECK(list("t")[2].string == "first second \"\"quoted");
  CHECK(list("t")[3].string == "\"\"x\"\"");
  CHECK(list("t")[4].string == "raw\\n");
  CHECK(list("t")[5].string == "");
  const std::int64_t whole[] = {0, 17, -1000, 0xDEADBEEF, 0755, 13, 9223372036854775807, -9223372036854775807 - 1};
  for (std::size_t k = 0; k < std::size(whole); ++k) {
    CHECK(list("i")[k].kind == TomlNode::integer);
    CHECK(list("i")[k].whole == whole[k]);
  }
  const double real[] = {1.0, 1e5, -2.5e-3, 6.022e23, 0.0, -0.0, 1e6, 5e-324, 1.7976931348623157e308, 0.1};
  for (std::size_t k = 0; k < std::size(real); ++k) {
    CHECK(list("r")[k].kind == TomlNode::real);
    CHECK(list("r")[k].number == real[k]);
    CHECK(std::signbit(list("r")[k].number) == std::signbit(real[k]));
  }
  CHECK(list("n")[1].number == std::numeric_limits<double>::infinity());
  CHECK(list("n")[2].number == -std::numeric_limits<double>::infinity());
  CHECK(std::isnan(list("n")[3].number));
  CHECK((list("f")[0].flag && !list("f")[1].flag));
  for (const TomlNode& date : list("d")) CHECK(date.kind == TomlNode::other);
  const TomlNode& inner = root.find("a b")->value.find("c")->value.find("d.e")->value;
  CHECK(inner.find("x")->value.whole == 1);
  CHECK(inner.find("y")->value.find("z")->value.items[0].find("w")->value.entries.empty());
}

TEST_CASE("tables may be opened as TOML 1.0 allows, and not otherwise") {
  for (const char* good : {
           "[a.b]\n[a]\n",
           "[a.b.c]\n[a]\nd = 1\n",
           "[a]\nb.c = 1\nb.d = 2\n[a.b.e]\n",
           "[[a]]\n[[a]]\n[a.b]\n[[a.c]]\n[[a.c]]\n",
           "[a.b]\nx = 1\n[a]\nb2.y = 1\n",
           "[a.b.c]\n[a]\nb.d = 1\n",
           "a.b = 1\na.c = 2\n",
           "a = { b.c = 1, b.d = 2 }\n",
           "\"\" = 1\n1 = 2\n3.5 = 1\n",
           "[\"a\".b]\n['a'.c]\n",
       }) {
    INFO(good);
    CHECK(refusal(good) == "");
  }
  check_refused("a = 1\na = 2\n", "2:5", "'a' already exists, in line 1");
  check_refused("a = 1\n\"a\" = 2\n", "2:7", "'a' already exists, in line 1");
  check_refused("[a]\n[b]\n[a]\n", "3:1", "'a' already exists, in line 1");
  check_refused("[a]\nb = 1\n[a.b]\n", "3:1", "'b' already exists, in line 2");
  check_refused("[a]\nb = 1\n[a.b.c]\n", "3:1", "'b' already exists, in line 2");
  check_refused("[[a]]\n[a]\n", "2:1", "'a' already exists, in line 1");
  check_refused("[a]\n[[a]]\n", "2:1", "'a' already exists, in line 1");
  check_refused("[a.b]\n[[a]]\n", "2:1", "'a' already exists, in line 1");
  check_refused("a = [ { b = 1 } ]\n[[a]]\n", "2:1", "'a' already exists, in line 1");
  check_refused("a = { b = 1 }\n[a]\n", "2:1", "'a' already exists, in line 1");
  check_refused("a = { b = 1 }\na.c = 1\n", "2:7", "'a' already exists, in line 1");
  check_refused("a = { b = { c = 1 }, b.d = 1 }\n", "1:28", "'b' already exists, in line 1");
  check_refused("a = { b = 1, b = 2 }\n", "1:18", "'b' already exists, in line 1");
  check_refused("[a]\nb.c = 1\n[a.b]\n", "3:1", "'b' already exists, in line 2");
  check_refused("[a.b.c]\nz = 9\n[a]\nb.c.t = 1\n", "4:9", "'c' already exists, in line 1");
  // of many keys too, where they are found by an index
  std::string many;
  for (int i = 0; i < 200; ++i) many += fmt::format("k{} = {}\n", i, i);
  const TomlNode root = parse_toml("s", many);
  REQUIRE(root.entries.size() == 200);
  for (int i = 0; i < 200; ++i) CHECK(root.entries[i].key == fmt::format("k{}", i));
  for (const int i : {0, 14, 15, 16, 17, 199})
    check_refused(many + fmt::format("k{} = 1\n", i),
                  fmt::format("201:{}", i < 10    ? 6
                                        : i < 100 ? 7
                                                  : 8),
                  fmt::format("'k{}' already exists, in line {}", i, i + 1));
}

TEST_CASE("text that is no TOML is refused where that shows") {
  check_refused("a = \n", "1:5", "the line's end where a value should stand");
  check_refused("[a\nb = 1\n", "1:1", "not closed by ']'");
  check_refused("[[a]\nb = 1\n", "1:1", "not closed by ']]'");
  check_refused("[ [a]]\n", "1:3", "'[' where a key should stand");
  check_refused("[[)b]]\n", "1:3", "')' where a key should stand");
  check_refused("a = 1\n  [b.\n", "2:6", "the line's end where a key should stand");
  check_refused("[]\n", "1:2", "']' where a key should stand");
  check_refused("a\n", "1:2", "the line's end where '=' should follow the key");
  check_refused("a b = 1\n", "1:3", "'b' where '=' should follow the key");
  check_refused("= 1\n", "1:1", "'=' where a key should stand");
  check_refused("a..b = 1\n", "1:3", "'.' where a key should stand");
  check_refused("a = 1\n\xC3\xA4 = 1\n", "2:1", "'\xC3\xA4' where a key should stand");
  check_refused("a = 1 b = 2\n", "1:7", "'b' where the line should end");
  check_refused("[a] b = 2\n", "1:5", "'b' where the line should end");
  check_refused("a = '\xC3\xA4' 1\n", "1:9", "'1' where the line should end");
  check_refused("a = -0.'\xC3\xA4' = 1\n", "1:5", "'-0.' is no number");
  check_refused("a = \"x\nb = 1\n", "1:5", "not closed by \" on its line");
  check_refused("a = 1\nb = \"\"\"x\n\n", "2:5", "not closed by \"\"\"");
  check_refused("a = \"\\q\"\n", "1:7", "'q', which it can't escape");
  check_refused("a = \"\\u12x4\"\n", "1:10", "'x' instead of a hexadecimal digit of 4");
  check_refused("a = \"\\ud800\"\n", "1:12", "U+D800 is no character");
  check_refused("a = \"\\U00110000\"\n", "1:16", "U+110000 is no character");
  check_refused("a = \"\x01\"\n", "1:6", "a control character, U+0001");
  check_refused("a = 1 # \x7F\n", "1:9", "a control character, U+007F");
  check_refused("a = '''x\ry'''\n", "1:9", "a control character, U+000D");
  check_refused(std::string("a = 1\nb\0c = 2\n", 13), "2:2", "U+0000 where '='");
  check_refused("a = [1, 2\n", "1:5", "not closed by ']'");
  check_refused("a = [1 2]\n", "1:8", "'2' where ',' or ']' should follow");
  check_refused("a = [,1]\n", "1:6", "',' where a value should stand");
  check_refused("a = { b = 1,\n c = 2 }\n", "1:13", "the line's end where a key should stand");
  check_refused("a = { b = 1, }\n", "1:14", "'}' where a key should stand");
  check_refused("a = { b = 1\n}\n", "1:12", "inline table, which is of one line");
  for (const char* word : {"01",         "1_",
                           "1__0",       "+-1",
                           "1.",         ".5",
                           "1.e3",       "1e",
                           "1e+",        "0x",
                           "0xG",        "-0x1",
                           "0b2",        "1.2.3",
                           "0o8",        "1e5.0",
                           "1979-13-01", "1979-02-29",
                           "24:00:00",   "1979-05-27T07:32",
                           "07:32:00Z",  "1979-05-27T07:32:00+25:00"})
    check_refused("a = " + std::string(word) + "\n", "1:5", std::string("'") + word + "' is no number");
  for (const char* word : {"tru", "True", "infinity", "abc", "a.b", "_1"})
    check_refused("a = " + std::string(word) + "\n", "1:5",
                  std::string("'") + word + "' is no value; texts stand in quotes");
  CHECK(refusal("a = " + std::string(2000, 'x') + "\n").size() < 400);
  CHECK(refusal("'" + std::string(5000, 'k') + "' = 1\n'" + std::string(5000, 'k') + "' = 2\n").size() < 400);
}

TEST_CASE("integers beyond 64 bits are refused as they stand there, never taken for others") {
  check_refused("a = 1\nb = 99999999999999999999\n", "2:5", "'99999999999999999999' is out of range");
  for (const char* word : {"9223372036854775808", "-9223372036854775809", "+9_223_372_036_854_775_808",
                           "0x8000000000000000", "0xFFFFFFFFFFFFFFFFF",
                           "0b1"
                           "0000000000000000000000000000000"
                           "00000000000000000000000000000000",
                           "99999999999999999999999"}) {
    const std::string shown =
        std::string(word).size() > 40 ? std::string(word).substr(0, 20) : std::string(word) + "' is";
    check_refused("a = [ 1, " + std::string(word) + " ]\n", "1:10", "'" + shown);
  }
  const TomlNode root = parse_toml("s",
                                   "a = 9223372036854775807\nb = -9223372036854775808\nc = 0x7FFFFFFFFFFFFFFF\n"
                                   "d = 99999999999999999999.0\ne = 9e18\n");
  CHECK(root.find("a")->value.whole == std::numeric_limits<std::int64_t>::max());
  CHECK(root.find("b")->value.whole == std::numeric_limits<std::int64_t>::min());
  CHECK(root.find("c")->value.whole == std::numeric_limits<std::int64_t>::max());
  CHECK(root.find("d")->value.number == 99999999999999999999.0);
  CHECK(root.find("e")->value.number == 9e18);
}

TEST_CASE("real numbers beyond 64 bits are the nearest there is, for the key's own range to refuse") {
  const TomlNode root = parse_toml("s",
                                   "a = 1e999\nb = -1e999\nc = 99999999999999999999e300\n\n"
                                   "e = 1e-999\nf = [ 1e400, 2.5 ]\n"
                                   "h = 0.00001e-99999999999999999999\ni = 123456.7e+99999999999999999999\n");
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(root.find("a")->value.number == infinity);
  CHECK(root.find("b")->value.number == -infinity);
  CHECK(root.find("c")->value.number == infinity);
  CHECK(root.find("e")->value.number == 0.0);
  CHECK(root.find("f")->value.items[0].number == infinity);
  CHECK(root.find("f")->value.items[1].place == "s:6:14");
  CHECK(root.find("h")->value.number == 0.0);
  CHECK(root.find("i")->value.number == infinity);
}

TEST_CASE("text that is not UTF-8 is refused with its place, wherever it stands") {
  check_refused("[[body]]\nname = '\xD8'\xD8\n", "2:9", "0xD8 is not UTF-8");  // a literal text, cut off
  check_refused(
      "a = 'K\xE4"
      "fer'\n",
      "1:7", "not UTF-8");
  check_refused("a = \"\xC0\xAF\"\n", "1:6", "not UTF-8");
  check_refused("# \xC3\xA4 \xE4\na = 1\n", "1:5", "not UTF-8");
  check_refused("\xE4 = 1\n", "1:1", "not UTF-8");
  check_refused("a = '''\n\n \xED\xA0\x80'''\n", "3:2", "not UTF-8");
  check_refused(times(3000, "# a remark of some length, and then another\n") + "k = '\xE4'\n", "3001:6", "not UTF-8");
  check_refused("\xFF\xFE[\0a\0]\0", "1:1", "UTF-16");
  CHECK_THROWS_AS(parse_toml_value("'\xD8'", "--set a"), InputError);
  CHECK_THROWS_AS(parse_toml_value("word\xFF", "--set a"), InputError);
  CHECK_THROWS_AS(parse_toml_value("[a, \xFF]", "--set a"), InputError);
}

TEST_CASE("depth counts brackets, dotted keys and table heads") {
  const auto taken = [](const std::string& text) {
    INFO(text.substr(0, 400));
    CHECK(refusal(text) == "");
  };
  const int most = kMostTomlDepth;
  const auto key = [](int parts) { return "k" + times(parts - 1, ".k"); };
  taken("a = " + times(most, "[") + times(most, "]") + "\n");
  check_refused("a = " + times(most + 1, "[") + times(most + 1, "]") + "\n", "1:69", "nested deeper");
  taken(key(most) + " = 1\n");
  check_refused(key(most + 1) + " = 1\n", "1:128", "nested deeper");
  taken("[" + key(most) + "]\n");
  check_refused("[" + key(most + 1) + "]\n", "1:129", "nested deeper");
  check_refused(key(12000) + " = 1\n", "1:128", "nested deeper");
  check_refused("[[" + key(20000) + "]]\n", "1:128", "nested deeper");
  // together
  taken("[" + key(30) + "]\nx = 1\n" + key(30) + " = [[[[1]]]]\n");
  check_refused("[" + key(30) + "]\nx = 1\n" + key(30) + " = [[[[[1]]]]]\n", "3:67", "nested deeper");
  taken("[" + key(60) + "]\n[b]\n" + key(60) + " = 1\n");  // the next head begins anew
  check_refused("a = {" + key(40) + " = {" + key(40) + " = 1}}\n", "1:132", "nested deeper");
  taken("a = [{" + key(40) + " = 1.5}, {" + key(40) + " = 2.5}, " + times(60, "[") + times(60, "]") + "]\n");
  taken("a = {" + key(40) + " = 1, " + "b." + key(40) + " = 2}\nc = 1.5\n" + times(200, "d") + " = 1\n");
  // what stands in texts and remarks is no bracket and no dot
  taken("a = '" + times(100, "[") + times(100, ".") + "'\n\"" + times(100, "b.") + "\" = 1 # " + times(100, "[{."));
  taken("a = \"\"\"\n" + times(100, "[\n") + "\"\"\"\"\"\n" + key(60) + " = ['''\n" + times(100, "k.") + "''']\n");
  // one or two marks before the three that end a text belong to it: what follows is not in a text
  check_refused("a = [\"\"\"x\"\"\"\", " + times(80, "[") + "1" + times(80, "]") + "]\n", "1:79", "nested deeper");
  check_refused("a = ['''x''''', {" + key(80) + " = 1}]\n", "1:141", "nested deeper");
}

namespace {

/// Random nested values, no key twice, and the deepest level that a value of theirs has.
struct RandomValues {
  Random random;
  int deepest = 0, keys = 0;

  std::string key(int& parts) {
    parts = random.below(4) == 0 ? 2 + random.below(3) : 1;
    std::string text = fmt::format("k{}", ++keys);
    for (int i = 1; i < parts; ++i) text += random.below(3) == 0 ? " . 'p.[x'" : ".p";
    return text;
  }
  /// At level `here`, with values in it down to `below` levels lower: one of them, the others lie less deep.
  std::string value(int here, int below) {
    deepest = std::max(deepest, here);
    if (below <= 0) return random.below(2) == 0 ? "1.5e3" : "\"[[{a.b = \\\" #\"";
    const bool array = random.below(2) == 0;
    const int count = 1 + random.below(3), deep = random.below(count);
    std::string text = array ? "[" : "{";
    for (int i = 0; i < count; ++i) {
      int parts = 1;
      if (!array) text += key(parts) + " = ";
      text += value(here + 1 + (parts > 1 ? parts : 0), i == deep ? below - 1 : random.below(2));
      if (i + 1 < count) text += array ? ", # [{\n" : ", ";
    }
    return text + (array ? "]" : "}");
  }
};

}  // namespace

TEST_CASE("random nested values are taken up to the depth and refused beyond it") {
  RandomValues values{Random(11)};
  int taken = 0, refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text;
    values.deepest = 0;
    const int head = values.random.below(30);
    if (head > 0) text = "[h" + times(head - 1, ".h") + "]\n";
    text += "v = " + values.value(head, values.random.below(i % 2 == 0 ? 8 : 60)) + "\n";
    const int deepest = values.deepest;
    const std::string message = refusal(text);
    INFO(text);
    INFO(message);
    CHECK((message.find("nested deeper") != std::string::npos) == (deepest > kMostTomlDepth));
    CHECK((message.empty() || deepest > kMostTomlDepth));
    (message.empty() ? taken : refused)++;
  }
  CHECK(taken > 50);
  CHECK(refused > 50);
}
