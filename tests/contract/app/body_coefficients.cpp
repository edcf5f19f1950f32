// A body's friction and restitution: one range, whoever writes them, and a word that gives them back to the scene.
#include <catch2/catch.hpp>

#include <sstream>

#include "engine/core/archive.hpp"
#include "engine/response/response.hpp"
#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"
#include "viewer/controller/session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

constexpr const char* kScene = R"([simulation]
sleeping = false
[contact]
friction = 0.3
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
friction = 0.3
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
position = [0, 0.25, 0]
)";

/// The pair's coefficient in each frame that has contacts, from contacts.csv.
std::map<int, double> friction_by_frame(const TempFolder& folder, const std::string& out) {
  std::istringstream text(slurp(folder / (out + "/contacts.csv")));
  std::map<int, double> result;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; column <= 19 && std::getline(cells, cell, ','); ++column)
      if (column == 19) result[std::stoi(line)] = std::stod(cell);
  }
  return result;
}

}  // namespace

TEST_CASE("a body's friction below 0 is refused by script, ramp, debugger and --set alike") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto by_script = [&](const std::string& line, const std::string& place) {
    folder.write("a.script", line + "\n");
    check_refused(folder, {"run", "s.toml", "--no-images", "--frames", "3", "--out", "no", "--script", "a.script"},
                  "a.script:" + place + ": ", "[0, 100]");
  };
  by_script("at 1 set body.crate.friction -0.5", "1:30");
  by_script("at 1 set body.crate.friction -1", "1:30");
  by_script("from 1 to 3 ramp body.crate.friction -1 0.8", "1:38");
  check_refused(folder, {"check", "s.toml", "--set", "body.crate.friction=-1"},
                "--set body.crate.friction=-1: ", "[0, 100]");
  check_refused(folder, {"sweep", "s.toml", "--vary", "body.crate.friction=-1,0.5", "--frames", "1", "--out", "no"},
                "--vary body.crate.friction=-1,0.5: ", "[0, 100]");
  folder.write("d.script", "step 1\nset body.crate.restitution -1\n");
  check_refused(folder, {"debug", "s.toml", "--headless", "--script", "d.script"}, "d.script:2:28: ", "[0, 1]");
  folder.write("a.script", "from 1 to 3 ramp body.crate.friction scene 0.8\n");
  check_refused(folder, {"check", "s.toml", "--script", "a.script"}, "a.script:1:38: ", "from number to number");
}

TEST_CASE("the word scene gives a body's coefficient back to the scene") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  folder.write(
      "a.script",
      "at 3 set body.crate.friction 1.2\nat 6 set body.crate.friction scene\nat 8 set contact.friction 0.48\n");
  const Outcome outcome = impinge_run(folder.path(), {"run", "s.toml", "--script", "a.script", "--frames", "9",
                                                      "--no-images", "--contacts", "--out", "o"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const std::map<int, double> friction = friction_by_frame(folder, "o");
  CHECK(friction.at(2) == Approx(0.3));
  CHECK(friction.at(4) == Approx(0.6));  // of 0.3 and 1.2 the geometric mean
  CHECK(friction.at(7) == Approx(0.3));
  CHECK(friction.at(9) == Approx(std::sqrt(0.3 * 0.48)));
  // the same word in a scene and by --set
  folder.write("own.toml", std::string(kScene) + "friction = 1.2\n");
  REQUIRE(impinge_run(folder.path(), {"run", "own.toml", "--set", "body.crate.friction=scene", "--frames", "2",
                                      "--no-images", "--contacts", "--out", "own"})
              .code == 0);
  CHECK(friction_by_frame(folder, "own").at(2) == Approx(0.3));
}

TEST_CASE("a coefficient that is the scene's is so again in a state that is restored") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  Session session(folder / "s.toml", {}, "", {64, 64, false});
  const Parameter& row = *session.rows().find("body.crate.friction");
  for (int k = 0; k < 2; ++k) session.advance();
  ByteWriter inherited, own;
  session.save(inherited);
  row.set(parse_value(row, "0.7"));
  session.save(own);
  ByteReader back(inherited.bytes());
  session.restore(back);
  CHECK(format_value(row.get()) == "scene");
  ByteReader forth(own.bytes());
  session.restore(forth);
  CHECK(format_value(row.get()) == "0.7");
}

TEST_CASE("a restitution that the response does not use is told by check and info, and no other is") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kScene) + "restitution = 0.9\n");
  for (const Entry<Response>& response : responses()) {
    const std::string name(response.name);
    const std::vector<std::string> set = {"--set", "response.method=" + name};
    const auto out_of = [&](const char* command) {
      std::vector<std::string> words = {command, "s.toml"};
      words.insert(words.end(), set.begin(), set.end());
      return impinge_run(folder.path(), words).out;
    };
    const std::string checked = out_of("check"), told = out_of("info");
    CAPTURE(name, checked, told);
    const bool is_told = checked.find("ignored-restitution: 'crate' has a restitution of 0.9") != std::string::npos;
    CHECK(is_told == !response.make()->uses_restitution());
    CHECK((told.find(name + " does not use it") != std::string::npos) == is_told);
  }
}
