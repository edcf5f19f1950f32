// impinge list: readable at 100 columns, filtered, and for programs.
#include <catch2/catch.hpp>

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge::test;

namespace {

const char* const kTopics[] = {"parameters",    "layers",    "responses",   "lcp_solvers",    "broad_phases",
                               "narrow_phases", "materials", "integrators", "linear_solvers", "cases",
                               "figures",       "shapes",    "warnings",    "sources",        "body_figures"};

std::size_t letters(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// The texts of a key in JSON, as Python's own reader has them: one a line.
std::vector<std::string> json_texts(const TempFolder& folder, const std::string& json, const std::string& key) {
  folder.write("list.json", json);
  const Outcome read =
      program_run("/usr/bin/python3", folder.path(),
                  {"-c", "import json\nfor x in json.load(open('list.json')): print(x['" + key + "'])"});
  CAPTURE(read.err);
  REQUIRE(read.code == 0);
  std::vector<std::string> texts;
  std::istringstream lines(read.out);
  for (std::string line; std::getline(lines, line);) texts.push_back(line);
  return texts;
}

std::set<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  std::set<std::string> all;
  for (std::string word; words >> word;) all.insert(word);
  return all;
}

}  // namespace

TEST_CASE("list: no line is longer than 100 letters, and wrapping loses no word") {
  const TempFolder folder;
  for (const char* topic : kTopics) {
    CAPTURE(topic);
    const Outcome text = impinge_run(folder.path(), {"list", topic}),
                  json = impinge_run(folder.path(), {"list", topic, "--json"});
    REQUIRE(text.code == 0);
    REQUIRE(json.code == 0);
    std::istringstream lines(text.out);
    for (std::string line; std::getline(lines, line);) {
      CAPTURE(line);
      CHECK(letters(line) <= 100);
      CHECK_FALSE(line.ends_with(' '));
    }
    const std::set<std::string> words = words_of(text.out);
    for (const std::string& meaning : json_texts(folder, json.out, "meaning"))
      for (const std::string& word : words_of(meaning)) {
        CAPTURE(word);
        CHECK(words.contains(word));
      }
  }
}

TEST_CASE("list: a filter leaves what holds the word, in any case of letters") {
  const TempFolder folder;
  const auto names = [&](const std::vector<std::string>& words) {
    std::vector<std::string> all = {"list"};
    all.insert(all.end(), words.begin(), words.end());
    all.emplace_back("--json");
    const Outcome outcome = impinge_run(folder.path(), all);
    CAPTURE(outcome.err);
    REQUIRE(outcome.code == 0);
    return json_texts(folder, outcome.out,
                      words[0] == "parameters" ? "path"
                      : words[0] == "figures"  ? "column"
                                               : "name");
  };
  const std::vector<std::string> all = names({"parameters"}), friction = names({"parameters", "FRICTION"});
  CHECK(all.size() > 100);
  CHECK(friction.size() < 20);
  CHECK(std::count(friction.begin(), friction.end(), "contact.friction") == 1);
  CHECK(names({"responses", "quick"}) == std::vector<std::string>{"quick"});
  CHECK(names({"figures", "judged_"}) ==
        std::vector<std::string>{"judged_penetration_m", "judged_intersections", "judged_depth_m"});
  check_refused(folder, {"list", "parameters", "contact.frction"},
                "command line: nothing in the list of parameters holds", "did you mean 'contact.friction'?");
}

TEST_CASE("list: parameters that can't change while running say so, in words and in JSON") {
  const TempFolder folder;
  const Outcome text = impinge_run(folder.path(), {"list", "parameters"});
  const auto facts_of = [&](const std::string& path) {
    const std::size_t at = text.out.find("\n" + path + " ");
    CAPTURE(path);
    REQUIRE(at != std::string::npos);
    return text.out.substr(at + 1, text.out.find('\n', at + 1) - at - 1);
  };
  const auto json = impinge_run(folder.path(), {"list", "parameters", "--json"}).out;
  for (const char* path : {"body.NAME.mass", "body.DEFORMABLE.self_collision", "body.DEFORMABLE.material.element"}) {
    CHECK(facts_of(path).ends_with(", fixed with the scene"));
    const std::string item = json.substr(json.find(std::string("\"") + path + "\""));
    CHECK(item.substr(0, item.find('}')).find("\"live\": false") != std::string::npos);
  }
  CHECK(facts_of("record.columns").ends_with(", set at frame 0 only"));
  for (const char* path : {"body.NAME.velocity", "body.NAME.friction", "contact.friction", "response.method"})
    CHECK(facts_of(path).find("fixed") == std::string::npos);
}

TEST_CASE("list: JSON has numbers as numbers and choices as lists") {
  const TempFolder folder;
  folder.write("list.json", impinge_run(folder.path(), {"list", "parameters", "--json"}).out);
  const Outcome read = program_run(
      "/usr/bin/python3", folder.path(),
      {"-c",
       "import json\n"
       "rows = {x['path']: x for x in json.load(open('list.json'))}\n"
       "assert rows['contact.friction']['default'] == 0.3 and rows['contact.friction']['high'] == 100\n"
       "assert rows['simulation.gravity']['default'] == [0, -9.81, 0]\n"
       "assert rows['contact.activation_distance']['default'] == 'auto' == "
       "rows['contact.activation_distance']['word']\n"
       "assert rows['simulation.sleeping']['default'] is True\n"
       "assert 'quick' in rows['response.method']['names']\n"
       "assert 'start-overlap' in rows['check.silence']['names'] and rows['check.silence']['default'] == []\n"
       "assert not rows['check.silence']['live']\n"});
  CAPTURE(read.err);
  CHECK(read.code == 0);
}

TEST_CASE("list warnings: scenes/README.md tells of every one") {
  const std::string page = slurp(std::filesystem::path(IMPINGE_SOURCE_DIR) / "scenes/README.md");
  const TempFolder folder;
  std::istringstream list(impinge_run(folder.path(), {"list", "warnings"}).out);
  int codes = 0;
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line[0] == ' ') continue;  // goes on with what it means
    const std::string code = line.substr(0, line.find(' '));
    CAPTURE(code);
    CHECK(page.find("`" + code + "`") != std::string::npos);
    ++codes;
  }
  CHECK(codes > 20);
}
