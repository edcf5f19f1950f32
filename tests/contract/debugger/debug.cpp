// The debugger without a screen: what a script does, it does every time, and so does what it recorded.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <map>
#include <sstream>

#include "engine/core/archive.hpp"
#include "tests/support/program/debug_session.hpp"
#include "viewer/debugger/debugger.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kSoft = R"([simulation]
substeps = 2
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = -0.15 } }
[[body]]
name = "beam"
kind = "deformable"
shape = { box = { size = [0.6, 0.12, 0.12] } }
volume = { lattice = { cells = 6 } }
material = { young = 1e5, poisson = 0.4, density = 1000, damping = [1, 0.01] }
)";

std::vector<std::string> lines_with(const std::string& text, const std::string& beginning) {
  std::vector<std::string> found;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(beginning)) found.push_back(line);
  return found;
}

/// Not printed: they are no texts.
bool same(const std::string& a, const std::string& b) { return !a.empty() && a == b; }

constexpr const char* kSession = R"(# everything that a hand can do
at 6 layer +normals
ui click layers/aabbs
ui click transport/play
ui wait 12
shot early.png
ui click transport/play
ui drag parameters/contact.friction 0.3
ui click transport/step
step 20
ui click parameters/search
ui text fric
ui key enter
ui click console/line
ui text set simulation.gravity 0 -12 0
ui key enter
step 15
ui click contacts/sort:gap
ui click contacts/sort:gap
ui click contacts/row:0
ui move 480 200
ui press left
ui move 500 190
ui move 540 180
ui release left
ui wheel 2
ui press right
ui move 530 170
ui release right
ui drag transport/frame 20
ui drag transport/frame 30
ui key right
ui key f1
ui key f1
shot end.png
)";

}  // namespace

TEST_CASE("a session by clicks, drags and typing ends the same each time, as does its recording") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", kSession);
  std::vector<Outcome> outcomes;
  for (const char* out : {"one", "two", "three"}) {
    outcomes.push_back(debug(folder, "s.toml", "a.script", {"--out", out, "--record", std::string(out) + ".script"}));
    INFO(outcomes.back().err);
    REQUIRE(outcomes.back().code == 0);
  }
  const auto [frame, hash] = end_of(outcomes[0]);
  CHECK(frame == 31);  // seek 30, key right
  const std::string picture = slurp(folder / "one/end.png"), early = slurp(folder / "one/early.png");
  REQUIRE(picture.size() > 10'000);
  for (const char* again : {"two", "three"}) {
    CHECK(same(slurp(folder.path() / again / "end.png"), picture));
    CHECK(same(slurp(folder.path() / again / "early.png"), early));
  }
  for (const Outcome& outcome : outcomes) CHECK(outcome.out == outcomes[0].out);

  // commands, not pixels
  const std::string recording = slurp(folder / "one.script");
  INFO(recording);
  CHECK(lines_with(recording, "at 6 layer +normals").size() == 1);
  CHECK(lines_with(recording, "layer +aabbs").size() == 1);
  CHECK(lines_with(recording, "set contact.friction ").size() == 1);
  CHECK(lines_with(recording, "panel filter fric").size() == 1);
  CHECK(lines_with(recording, "set simulation.gravity 0 -12 0").size() == 1);
  CHECK(lines_with(recording, "panel sort gap").size() == 2);
  CHECK(lines_with(recording, "select contact").size() == 1);
  CHECK(lines_with(recording, "camera eye").size() == 1);
  CHECK(lines_with(recording, "seek").size() == 1);
  CHECK(lines_with(recording, "ui click").empty());
  CHECK(lines_with(recording, "ui press").empty());

  // what was recorded from the recording is the recording
  const Outcome replay = debug(folder, "s.toml", "one.script", {"--out", "replay", "--record", "again.script"});
  INFO(replay.err);
  REQUIRE(replay.code == 0);
  CHECK(end_of(replay) == std::pair(frame, hash));
  CHECK(same(slurp(folder / "replay/early.png"), early));
  CHECK(same(slurp(folder / "replay/end.png"), picture));
  const auto body = [](const std::string& text) { return text.substr(text.find('\n')); };
  CHECK(body(slurp(folder / "again.script")) == body(recording));
}

TEST_CASE("a slider moved at frame 30, then back by 20 and on again, ends where an uninterrupted run does") {
  struct Case {
    const char *name, *scene, *path, *value;
  };
  const Case c = GENERATE(Case{"rigid", kRigid, "contact.friction", "0.05"},
                          Case{"soft", kSoft, "body.beam.material.young", "4e5"});
  CAPTURE(c.name);
  const TempFolder folder;
  folder.write("s.toml", c.scene);
  folder.write(
      "a.script",
      fmt::format("step 30\nui drag parameters/{} {}\nstep 30\nback 20\nui key space\nui wait 40\nui key space\n",
                  c.path, c.value));
  const Outcome by_hand = debug(folder, "s.toml", "a.script", {"--record", "r.script"});
  INFO(by_hand.err);
  REQUIRE(by_hand.code == 0);
  CHECK(by_hand.err.empty());  // nothing came out otherwise than before
  const auto set = lines_with(slurp(folder / "r.script"), std::string("set ") + c.path);
  REQUIRE(set.size() == 1);
  folder.write("run.script", fmt::format("at 31 {}\n", set[0]));
  const Outcome run = impinge_run(
      folder.path(), {"run", "s.toml", "--script", "run.script", "--out", "out", "--frames", "100", "--no-images"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const auto [frame, hash] = end_of(by_hand);
  CAPTURE(frame);
  CHECK(frame >= 80);
  CHECK(hash == hash_in(folder / "out/stats.csv", frame));
  // the slider did something
  const Outcome plain =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "plain", "--frames", "100", "--no-images"});
  REQUIRE(plain.code == 0);
  CHECK(hash != hash_in(folder / "plain/stats.csv", frame));
  CHECK(hash_in(folder / "out/stats.csv", 30) == hash_in(folder / "plain/stats.csv", 30));
}

TEST_CASE("a change in the past makes another future") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 60\nseek 20\nset simulation.gravity 0 -5 0\nstep 5\nback 10\nstep 25\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.err.empty());
  folder.write("run.script", "at 21 set simulation.gravity 0 -5 0\n");
  REQUIRE(impinge_run(folder.path(),
                      {"run", "s.toml", "--script", "run.script", "--out", "out", "--frames", "41", "--no-images"})
              .code == 0);
  CHECK(end_of(outcome) == std::pair(40, hash_in(folder / "out/stats.csv", 40)));
}

TEST_CASE("10000 frames keep the memory's bound, and any of them comes back", "[long]") {
  const TempFolder folder;
  const fs::path scene = folder.write("s.toml", R"([simulation]
sleeping = false
gravity = [0.3, -9.81, 0]
[contact]
friction = 0.02
[[body]]
name = "floor"
kind = "static"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
position = [0, 0.25, 0]
)");
  const auto execute = [](Debugger& debugger, const std::string& line) {
    static const std::string kTest = "test";
    debugger.execute({line, &kTest, 1, 1});
  };
  DebuggerOptions options;
  options.most_bytes = std::size_t{1} << 20;
  Debugger debugger(scene, {}, {}, options);
  std::map<int, std::uint64_t> hashes;
  std::size_t most = 0;
  for (int frame = 0; frame < 10'000; frame += 50) {
    hashes[frame] = debugger.state_hash();
    execute(debugger, "step 50");
    most = std::max(most, debugger.model().snapshot_bytes);
  }
  CHECK(most <= options.most_bytes);
  CHECK(most > options.most_bytes / 2);
  CHECK(debugger.model().snapshots < 10'000);
  Debugger fresh(scene, {}, {}, options);
  execute(fresh, "step 5000");
  for (const int frame : {5000, 4950, 0, 9950, 50, 7300}) {
    CAPTURE(frame);
    execute(debugger, fmt::format("seek {}", frame));
    CHECK(debugger.model().frame == frame);
    CHECK(debugger.state_hash() == hashes[frame]);
    CHECK(debugger.model().snapshot_bytes <= options.most_bytes);
  }
  CHECK(fresh.state_hash() == hashes[5000]);
  CHECK(hashes[5000] != hashes[4950]);
  for (const ConsoleLine& line : debugger.model().console) CHECK(line.kind != ConsoleLine::problem);
}

TEST_CASE("what is wrong is one message that says where, what is allowed and what to do") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("file", "");
  struct Case {
    const char* script;
    std::vector<std::string> parts;
    std::vector<std::string> more = {};
  };
  const std::vector<Case> cases = {
      {"step\nui click transport/plai\n",
       {"a.script:2:1: no widget 'transport/plai'; ", "did you mean 'transport/play'?"}},
      {"ui drag parameters/contact.frictoin 1\n", {"a.script:1:1: ", "did you mean 'parameters/contact.friction'?"}},
      {"ui drag layers/meshes 1\n", {"a.script:1:1: 'layers/meshes' is no slider; "}},
      {"ui drag parameters/contact.friction -3\n",
       {"a.script:1:1: -3 on the slider 'parameters/contact.friction'; it goes from 0 to "}},
      {"\n  stepp 3\n", {"a.script:2:3: unknown command 'stepp'; allowed: set, ", "did you mean 'step'?"}},
      {"seek -1\n", {"a.script:1:6: ", "-1", "change it"}},
      {"seek 3.5\n", {"a.script:1:6: "}},
      {"back 0\n", {"a.script:1:6: "}},
      {"select contact 99\n", {"a.script:1:16: contact 99; frame 0 has 0 contacts, counted from 0; "}},
      {"select body bal\n", {"a.script:1:13: unknown body 'bal'; allowed: floor, crate, ball; did you mean 'ball'?"}},
      {"panel sort gapp\n", {"a.script:1:12: unknown column 'gapp'; ", "did you mean 'gap'?"}},
      {"panel plot +kinetic\n", {"a.script:1:13: unknown column 'kinetic'; ", "kinetic_J"}},
      {"panel scroll nowhere 3\n", {"a.script:1:14: unknown panel 'nowhere'; allowed: "}},
      {"ui key f12\n", {"a.script:1:8: unknown key 'f12'; allowed: tab, "}},
      {"ui press top\n", {"a.script:1:10: unknown button 'top'; "}},
      {"set contact.frictoin 1\n",
       {"a.script:1:5: unknown parameter 'contact.frictoin'; ", "did you mean 'contact.friction'?"}},
      {"shot a.jpg\n", {"a.script:1:6: 'a.jpg'; a file name that ends in .png is wanted; "}},
      {"shot ../../a.png\n", {"a.script:1:6: '../../a.png', which leads out of --out; a path below --out is wanted; "}},
      {"bundle a/../../b.tar\n", {"a.script:1:8: 'a/../../b.tar', which leads out of --out; "}},
      {"plots /tmp/p.csv\n",
       {"a.script:1:7: '/tmp/p.csv', which is not below --out; a path from --out on is wanted; "}},
      {"step\nfreeze ../f.step\n", {"a.script:2:8: '../f.step', which leads out of --out; "}},
      {"export ply ../e\n", {"a.script:1:12: '../e', which leads out of --out; "}},
      {"shot file/a.png\n", {"a.script:1:1: ", "file/a.png can't be written ("}},
      {"step\n", {"--size is 640x480; the panels want 800x500 at least", "choose a larger one"}, {"--size", "640x480"}},
      {"step\n", {"--size is 960x600; the panels want 1600x1000 at least", "a smaller --scale"}, {"--scale", "2"}},
      {"step\n",
       {"--record is file/r.script, which can't be written (Not a directory); "},
       {"--record", "file/r.script"}},
      {"step\n", {"--record is the script itself, a.script; another file is wanted"}, {"--record", "a.script"}},
      {"step\n", {"--record is s.toml, which is there and no recording; "}, {"--record", "s.toml"}},
      {"step 5\nui key f12\n", {"a.script:2:8: unknown key 'f12'; "}, {"--record", "kept.script"}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.script);
    folder.write("a.script", c.script);
    const Outcome outcome = debug(folder, "s.toml", "a.script", c.more);
    CHECK(outcome.out.empty());
    for (const std::string& part : c.parts) check_refused(outcome, part);
  }
}

TEST_CASE("a scene that diverges says so and can be gone on with from the last good frame") {
  const TempFolder folder;
  folder.write("s.toml",
               "[simulation]\ngravity = [0, 1e4, 0]\nframe_time = 10\n[[body]]\nname = \"rocket\"\nkind = "
               "\"dynamic\"\nshape = { sphere = { radius = 1 } }\n");
  const Outcome run =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "out", "--frames", "100000", "--no-images"});
  REQUIRE(run.code == 3);
  const std::string table = slurp(folder / "out/stats.csv");
  const auto last = static_cast<int>(std::count(table.begin(), table.end(), '\n')) - 2;
  folder.write("a.script", "step 100000\nshot stuck.png\nback 4\nstep 2\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script");
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.find("diverged: ") != std::string::npos);
  CHECK(outcome.error_lines() == 1);
  CHECK(end_of(outcome) == std::pair(last - 2, hash_in(folder / "out/stats.csv", last - 2)));
  CHECK(fs::exists(folder / "stuck.png"));
}

TEST_CASE("a script that ends in an error keeps what was done before") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "step 4\nset contact.friction 0.1\nselect contact 99\n");
  CHECK(debug(folder, "s.toml", "a.script", {"--record", "r.script"}).code == 2);
  CHECK(slurp(folder / "r.script").find("step 4\nset contact.friction 0.1\n") != std::string::npos);
}

TEST_CASE("an error before anything is done leaves an older recording as it was, and makes none") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("good.script", "step 2\n");
  REQUIRE(debug(folder, "s.toml", "good.script", {"--record", "r.script"}).code == 0);
  const std::string before = slurp(folder / "r.script");
  REQUIRE(before.find("step 2\n") != std::string::npos);
  folder.write("wrong.toml", std::string(kRigid) + "[contact]\nfrictoin = 1\n");
  folder.write("wrong.script", "step 2\nstepp\n");
  folder.write("timed.script", "at 3 set contact.frictoin 1\n");
  folder.write("first.script", "select contact 99\n");
  for (const auto& [scene, script] : {std::pair("wrong.toml", "good.script"),
                                      {"nowhere.toml", "good.script"},
                                      {"s.toml", "nowhere.script"},
                                      {"s.toml", "wrong.script"},
                                      {"s.toml", "timed.script"},
                                      {"s.toml", "first.script"}}) {
    CAPTURE(scene, script);
    CHECK(debug(folder, scene, script, {"--record", "r.script"}).code == 2);
    CHECK(slurp(folder / "r.script") == before);
    CHECK(debug(folder, scene, script, {"--record", "new.script"}).code == 2);
    CHECK_FALSE(fs::exists(folder / "new.script"));
  }
  fs::create_directory(folder / "taken");
  CHECK(debug(folder, "s.toml", "good.script", {"--record", "taken"}).err.find("can't be written (Is a directory)") !=
        std::string::npos);
}

TEST_CASE("a break pauses play") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "break when contacts > 0\nplay\nui wait 100\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script");
  INFO(outcome.err);
  CHECK(outcome.code == 0);
  CHECK(outcome.err.find("stopped by break when contacts > 0") != std::string::npos);
  folder.write("run.script", "break when contacts > 0\n");
  impinge_run(folder.path(),
              {"run", "s.toml", "--script", "run.script", "--out", "out", "--frames", "100", "--no-images"});
  const auto [frame, hash] = end_of(outcome);
  CHECK(frame < 100);
  CHECK(hash == hash_in(folder / "out/stats.csv", frame));
  CHECK(hash_in(folder / "out/stats.csv", frame + 1).empty());  // the run stopped there too
}

TEST_CASE("debug says what its script expects beyond the frames that were made, as run does") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "expect bodies == 3 at 5\nexpect bodies == 4 at 500\nstep 10\nback 5\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script");
  CHECK(outcome.code == 0);
  CHECK(outcome.err.find("1 expect line lies after the last frame 10 and was not checked") != std::string::npos);
}
