// What `expect` may ask of bodies, in one frame and in a range of frames, held against a throw by formula.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "tests/support/program/program.hpp"
#include "tests/support/program/refusal.hpp"
#include "tests/support/program/temp_folder.hpp"

using namespace impinge::test;

namespace {

// a frame of 1/10 s; by symplectic steps a body that falls for n of them from rest is g dt² n (n + 1)/2 lower
const char* const kThrow = R"(
[simulation]
gravity = [0, -10, 0]
frame_time = 0.1
substeps = 1
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.5 } }
position = [3, 20, -4]
velocity = [-2, 5, 0.5]
[[body]]
name = "post"
kind = "static"
shape = { box = { size = [1, 1, 1] } }
position = [-50, -60, 70]
)";

struct Runs {
  TempFolder folder;
  Runs() { folder.write("s.toml", kThrow); }
  Outcome operator()(const std::string& script, const std::vector<std::string>& more = {}) const {
    folder.write("a.script", script);
    std::filesystem::remove_all(folder / "out");
    std::vector<std::string> words = {"run", "s.toml", "--script", "a.script",   "--frames",
                                      "20",  "--out",  "out",      "--no-images"};
    words.insert(words.end(), more.begin(), more.end());
    return impinge_run(folder.path(), words);
  }
};

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("expect: positions and velocities of bodies are those of a throw") {
  const Runs runs;
  std::string script;
  for (const int n : {0, 1, 7, 20}) {
    const double t = 0.1 * n, y = 20 + 5 * t - 0.1 * n * (n + 1) / 2.0, vy = 5 - 10 * t;
    for (const auto& [name, value] : {std::pair{"position_x", 3 - 2 * t},
                                      {"position_y", y},
                                      {"position_z", -4 + t / 2},
                                      {"velocity_x", -2.0},
                                      {"velocity_y", vy},
                                      {"velocity_z", 0.5}})
      script += fmt::format("expect abs({}(ball) - {}) < 1e-9 at {}\n", name, value, n);
  }
  script += "expect abs(position_z(post) - 70) + abs(position_x(post) + 50) == 0 from 0 to 20\n";
  const Outcome good = runs(script);
  INFO(good.err);
  CHECK(good.code == 0);
  CHECK(good.err.empty());
  const Outcome off = runs("expect abs(position_y(ball) - 20.41) < 1e-3 at 1\n");  // y is 20.4
  CHECK(off.code == 1);
  CHECK(off.err.find("found position_y(ball) = 20.4") != std::string::npos);
}

TEST_CASE("expect: the force between a crate and the floor is its weight") {
  const TempFolder folder;
  folder.write("s.toml", R"(
[simulation]
gravity = [0, -10, 0]
sleeping = false
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 2] } }
material = { density = 500 }
position = [0, 0.25, 0]
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "far"
kind = "static"
shape = { box = { size = [1, 1, 1] } }
position = [50, 0, 0]
)");
  const auto run = [&](const std::string& script) {
    folder.write("a.script", script);
    return impinge_run(folder.path(), {"run", "s.toml", "--script", "a.script", "--frames", "40", "--out", "out",
                                       "--no-images", "--force", "--set", "simulation.substeps=3"});
  };
  // 500 kg, 5000 N
  const Outcome good =
      run("expect abs(force(crate,floor) - 5000) < 0.5 && force(floor,crate) == force(crate,floor) from 20 to 40\n"
          "expect force(far,crate) == 0 from 0 to 40\nexpect force(crate,floor) == 0 at 0\n");
  INFO(good.err);
  CHECK(good.code == 0);
  CHECK(run("expect force(crate,floor) > 5001 at 40\n").code == 1);
}

TEST_CASE("expect: a range holds in every frame of it, ends included") {
  const Runs runs;
  // y is 20 + n/2 - n (n + 1)/20: 20 in frame 9, 19.5 in frame 10, 18.9 in frame 11
  CHECK(runs("expect position_y(ball) >= 19.9 from 0 to 9\n").code == 0);
  CHECK(runs("expect position_y(ball) < 19.9 from 10 to 20\n").code == 0);
  CHECK(runs("expect position_y(ball) >= 19.9 from 0 to 10\n").code == 1);
  CHECK(runs("expect position_y(ball) < 19.9 from 9 to 9\n").code == 1);
  const Outcome late = runs("expect position_y(ball) >= 19.2 from 3 to 15\n");
  CHECK(late.code == 1);
  CHECK(late.err.find("a.script:1:1: frame 11: expected position_y(ball) >= 19.2 in frames 3 to 15; found "
                      "position_y(ball) = 18.9") != std::string::npos);
  CHECK(late.err.find("a.script:1:1: expected position_y(ball) >= 19.2 in frames 3 to 15: failed in 5 of these, last "
                      "in frame 15") != std::string::npos);
  CHECK(count(late.err, "a.script:1:1") == 2);
  // the run ends within the second, before the third
  const Outcome beyond = runs(
      "expect bodies == 2 from 0 to 20\nexpect bodies == 2 from 10 to 30\n"
      "expect bodies == 3 from 21 to 30\n");
  CHECK(beyond.code == 0);
  CHECK(count(beyond.err, "not checked") == 2);
  CHECK(beyond.err.find("a.script:2:1: expected in frames 10 to 30, and not checked after the last frame 20") !=
        std::string::npos);
}

TEST_CASE("expect: without --frames a run goes on to the end of a range") {
  const Runs runs;
  runs.folder.write("a.script", "expect bodies == 2 from 2 to 245\n");
  const Outcome outcome =
      impinge_run(runs.folder.path(), {"run", "s.toml", "--script", "a.script", "--out", "out", "--no-images"});
  CHECK(outcome.code == 0);
  CHECK(count(slurp(runs.folder / "out/stats.csv"), "\n") == 247);  // heading, frames 0 to 245; alone it would be 240
}

TEST_CASE("expect: what is not finite fulfils nothing, and is named") {
  const Runs runs;
  const auto failed = [&](const std::string& condition, const std::string& why) {
    CAPTURE(condition);
    const Outcome outcome = runs("expect " + condition + " at 2\n");
    CHECK(outcome.code == 1);
    CAPTURE(outcome.err);
    CHECK(outcome.err.find("frame 2: expected " + condition + "; " + why) != std::string::npos);
  };
  failed("1/0 > 1", "found that inf stands left of '>', and what is not finite is no answer");
  failed("1 > -1/0", "found that -inf stands right of '>'");
  failed("0/0 < 1", "found that not a number stands left of '<'");
  failed("!(0/0 < 1)", "found that not a number stands left of '<'");
  failed("1/0 == 1/0", "found that inf stands left of '=='");
  failed("bodies/0 > 1", "found bodies = 2: inf stands left of '>'");
  failed("bodies == 3 || contacts/0 > 1", "found bodies = 2, contacts = 0: not a number stands left of '>'");
  failed("bodies == 2 && contacts/contacts != 5", "found bodies = 2, contacts = 0: not a number stands left of '!='");
  failed("1 > 2", "it asks of nothing that could change");
  // what is decided without it
  CHECK(runs("expect bodies == 2 || contacts/0 > 1 at 2\nexpect !(bodies == 3 && contacts/0 > 1) at 2\n").code == 0);
}

TEST_CASE("expect: of a body that is deleted, or yet to be added, nothing holds, and why is said") {
  const Runs runs;
  const std::string script = "at 3 delete ball\nat 6 add late like ball at 0 0 0\n";
  const auto failed = [&](const std::string& condition, int frame, const std::string& why) {
    CAPTURE(condition, frame);
    const Outcome outcome = runs(fmt::format("{}expect {} at {}\n", script, condition, frame));
    CHECK(outcome.code == 1);
    CAPTURE(outcome.err);
    CHECK(outcome.err.find(fmt::format("a.script:3:1: frame {}: expected {}; found ", frame, condition)) !=
          std::string::npos);
    CHECK(outcome.err.find(why) != std::string::npos);
  };
  for (const char* figure :
       {"position_x(ball)", "speed(ball)", "velocity_y(ball)", "energy(ball)", "gap(ball,post)", "gap(post,ball)"})
    for (const char* sign : {"< 1e9", "> -1e9"})
      failed(fmt::format("{} {}", figure, sign), 3, "= nan: not a number stands left of '");
  failed("speed(ball) < 1", 3, ", and 'ball' was deleted in frame 3");
  failed("speed(ball) < 1", 20, ", and 'ball' was deleted in frame 3");
  failed("position_y(late) < 1", 5, ", and 'late' is not there yet");
  failed("gap(late,ball) > 0", 8, ", and 'ball' was deleted in frame 3");
  // while they are there, and what is 0 of two that don't touch
  const Outcome good =
      runs(script +
           "expect abs(position_x(ball) - 2.6) < 1e-9 at 2\nexpect abs(position_z(late)) < 10 from 6 to 20\n"
           "expect contacts(ball,post) + depth(ball,post) + force(ball,post) == 0 from 0 to 20\n"
           "expect contacts(ball,late) + depth(ball,late) + force(ball,late) == 0 from 0 to 20\n");
  INFO(good.err);
  CHECK(good.code == 0);
}

TEST_CASE("expect: only a body that deforms may be asked about itself") {
  const Runs runs;
  for (const char* function : {"depth", "gap", "contacts", "force"}) {
    const std::string line = fmt::format("expect {}(ball,ball) < 1 at 2", function);
    const Outcome outcome = runs(line + "\n");
    CAPTURE(line, outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.err.rfind(fmt::format("a.script:1:{}: 'ball' a second time", line.find(",ball") + 2), 0) == 0);
    CHECK(outcome.err.find("name another one") != std::string::npos);
    CHECK(count(outcome.err, "\n") == 1);
  }
  runs.folder.write("s.toml", std::string(kThrow) + R"(
[[body]]
name = "jelly"
kind = "deformable"
shape = { box = { size = [1, 1, 1] } }
volume = { lattice = { cells = 2 } }
material = { density = 1000, young = 1e6, poisson = 0.3 }
position = [9, 9, 9]
)");
  const Outcome soft = runs("expect contacts(jelly,jelly) == 0 && depth(ball,post) == 0 at 2\n");
  CAPTURE(soft.err);
  CHECK(soft.code == 0);
}

TEST_CASE("expect: forms that are none are refused at their place") {
  const Runs runs;
  const auto refused = [&](const std::string& line, const std::string& where, const std::string& remedy) {
    CAPTURE(line);
    const Outcome outcome = runs(line + "\n");
    CHECK(outcome.code == 2);
    CAPTURE(outcome.err);
    CHECK(count(outcome.err, "\n") == 1);
    CHECK(outcome.err.find("a.script:1:" + where + ": ") != std::string::npos);
    CHECK(outcome.err.find(remedy) != std::string::npos);
  };
  refused("expect bodies == 2 from 9 to 3", "30", "swap the frames");
  refused("expect bodies == 2 at 3..9", "23", "write from A to B");
  refused("expect bodies == 2 from 3 till 9", "1", "or from A to B");
  refused("expect bodies == 2", "1", "or from A to B");
  refused("expect image x.png from 3 to 9", "20", "a line for each frame");
  refused("expect abs(bodies > 2) == 1 at 3", "19", "abs");
  refused("expect abs(bodies < 2 at 3", "19", "abs");
  refused("expect abs() < 2 at 3", "12", "mend");
  refused("expect position_y(bal) < 2 at 3", "19", "did you mean 'ball'?");
  refused("expect position(ball) < 2 at 3", "8", "did you mean 'position_");
  refused("expect body.ball.position.y < 2 at 3", "8", "position_y(A)");
  refused("expect position_y(ball,post) < 2 at 3", "23", "one body");
}
