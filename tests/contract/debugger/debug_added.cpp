// Bodies that lines add: by hand, in scripts of a run, in bundles; undone; refused; and in files for other programs.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

const std::string kSoft = std::string(kSoftCube) + R"(rotation = [0, 30, 0]
friction = 0.7
fixed = [ { box = { min = [-5, 1.1, -5], max = [5, 2, 5] } } ]
)";

Outcome end_run(const TempFolder& folder, const std::string& scene, const std::string& script, int frames,
                std::vector<std::string> more = {}) {
  folder.write("run.script", script);
  std::vector<std::string> words = {
      "run", scene, "--out", "o", "--script", "run.script", "--frames", std::to_string(frames), "--no-images"};
  if (std::find(more.begin(), more.end(), "--resume") == more.end()) words.push_back("--force");
  words.insert(words.end(), more.begin(), more.end());
  return impinge_run(folder.path(), words);
}

/// The state hashes of a run, by frame.
std::vector<std::string> states(const TempFolder& folder, const std::string& scene, const std::string& script,
                                int frames, const std::vector<std::string>& more = {}) {
  const Outcome outcome = end_run(folder, scene, script, frames, more);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  std::vector<std::string> list;
  for (int k = 0; k <= frames; ++k) list.push_back(hash_in(folder / "o/stats.csv", k));
  return list;
}

constexpr const char* kBall = "add ball_2 like ball at 0.2 1.5 0.1 velocity 0 -1 0";
constexpr const char* kJelly = "add jelly_2 like jelly at 0.3 2 0 turn 0 1 0 60";

}  // namespace

TEST_CASE("a body that a script adds at frame 0 is the one that a scene has at its end") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft);
  const std::string ball = R"([[body]]
name = "ball_2"
kind = "dynamic"
shape = { sphere = { radius = 0.3 } }
position = [0.2, 1.5, 0.1]
velocity = [0, -1, 0]
)",
                    jelly = R"([[body]]
name = "jelly_2"
kind = "deformable"
shape = { box = { size = [0.5, 0.5, 0.5] } }
volume = { lattice = { cells = 2 } }
material = { young = 3e4, density = 400 }
friction = 0.7
position = [0.3, 2, 0]
)";
  for (const char* response : {"constraint_anticipation", "iterative_constraint_anticipation", "sequential_impulse",
                               "simultaneous_impulse", "penalty", "soft_constraint", "quick"}) {
    CAPTURE(response);
    const std::string set = "response.method=" + std::string(response);
    folder.write("with.toml", std::string(kRigid) + kSoft + ball);
    CHECK(states(folder, "s.toml", fmt::format("at 0 {}\n", kBall), 12, {"--set", set}) ==
          states(folder, "with.toml", "", 12, {"--set", set}));
    // the same corners are held, wherever they are; a quarter turn is exact enough to be the same box
    folder.write("with.toml",
                 std::string(kRigid) + kSoft + jelly +
                     "rotation = [0, 30, 0]\nfixed = [ { box = { min = [-5, 2.2, -5], max = [5, 3, 5] } } ]\n");
    CHECK(states(folder, "s.toml", "at 0 add jelly_2 like jelly at 0.3 2 0\n", 12, {"--set", set}) ==
          states(folder, "with.toml", "", 12, {"--set", set}));
  }
  // turned: about the axes of the world, from how the scene has it
  folder.write("free.toml", std::string(kRigid));
  folder.write("with.toml", std::string(kRigid) + R"([[body]]
name = "crate_2"
kind = "dynamic"
shape = { box = { size = [1, 0.5, 1] } }
material = { density = 500 }
position = [3, 2, 0]
rotation = [10, 20, 90]
)");
  const auto height = [&](const std::string& scene, const std::string& script) {
    const Outcome outcome = end_run(folder, scene, script, 20, {"--export", "poses.csv"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    std::istringstream rows(slurp(folder / "o/export/poses.csv"));
    std::string line, last;
    while (std::getline(rows, line))
      if (line.find(",crate_2,") != std::string::npos) last = line;
    std::vector<double> numbers;
    std::istringstream cells(last);
    for (std::string cell; std::getline(cells, cell, ',');)
      if (cell != "crate_2") numbers.push_back(std::stod(cell));
    return numbers;
  };
  const std::vector<double> wanted = height("with.toml", ""),
                            found = height("free.toml", "at 0 add crate_2 like crate at 3 2 0 turn 0 0 2 90\n");
  REQUIRE(wanted.size() == found.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) CHECK(found[i] == Approx(wanted[i]).margin(1e-9));
}

TEST_CASE("a body that is added by hand is what a script of a run adds, in recordings, bundles and runs gone on with") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft);
  const std::vector<std::string> plain = states(folder, "s.toml", "", 40);
  const std::pair<std::string, std::string> cases[] = {
      {fmt::format("step 10\n{}\nstep 30\n", kBall), fmt::format("at 11 {}\n", kBall)},
      {fmt::format("step 10\n{}\nstep 5\n{}\nstep 25\n", kJelly, kBall),
       fmt::format("at 16 {}\nat 11 {}\n", kBall, kJelly)},
      {fmt::format(
           "step 10\nset body.ball.friction 0.05\n{}\nset body.ball_2.restitution 0.5\nstep 4\npush ball_2 90 0 "
           "0\nstep 6\ndelete ball_2\nstep 20\n",
           kBall),
       fmt::format(
           "at 11 set body.ball.friction 0.05\nat 11 {}\nat 11 set body.ball_2.restitution 0.5\nat 15 push ball_2 "
           "90 0 0\nat 21 delete ball_2\n",
           kBall)},
      // a copy of a copy
      {fmt::format("step 10\n{}\nadd ball_3 like ball_2 at 1 2 0\nstep 30\n", kBall),
       fmt::format("at 11 {}\nat 11 add ball_3 like ball_2 at 1 2 0\n", kBall)}};
  for (const auto& [lines, script] : cases) {
    CAPTURE(lines);
    const std::vector<std::string> wanted = states(folder, "s.toml", script, 40);
    CHECK(std::equal(plain.begin(), plain.begin() + 11, wanted.begin()));
    CHECK(wanted[11] != plain[11]);
    const End end(40, wanted[40]);
    CHECK(end_of_lines(folder, lines) == end);
    CHECK(end_of_lines(folder, lines, {"--threads", "1"}) == end);
    CHECK(end_of_lines(folder, lines + "back 35\nstep stage 5\nseek 40\n") == end);
    CHECK(end_of_lines(folder, lines + "seek 0\nseek 40\n", {"--memory", "1"}) == end);
    for (const int cut : {5, 13, 25}) {
      states(folder, "s.toml", script, cut);
      CHECK(end_run(folder, "s.toml", script, 40, {"--resume"}).code == 0);
      CHECK(hash_in(folder / "o/stats.csv", 40) == wanted[40]);
    }
    CHECK(impinge_run(folder.path(), {"replay", "o"}).code == 0);
    folder.write("c.script", "seek 40\nseek 20\nback 14\nstep 34\n");
    CHECK(end_of(debug(folder, "o", "c.script")) == end);
    folder.write("a.script", lines + "bundle b.tar\n");
    REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
    CHECK(impinge_run(folder.path(), {"replay", "b.tar"}).code == 0);
    folder.write("c.script", "back 33\nseek 40\n");
    CHECK(end_of(debug(folder, "b.tar", "c.script")) == end);
  }
}

TEST_CASE("an added body is undone and added again, also before others") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft);
  const auto end = [&](const std::string& lines) { return end_of_lines(folder, lines); };
  const std::string early = "seek 10\n" + std::string(kBall) + "\n", late = "seek 20\n" + std::string(kJelly) + "\n";
  const End plain = end("step 40\n"), both = end(early + late + "seek 40\n"), first = end(early + "seek 40\n");
  CHECK(first != plain);
  CHECK(both != first);
  CHECK(end(early + late + "seek 30\nundo\nseek 40\n") == first);
  CHECK(end(early + late + "seek 30\nundo\nundo\nseek 40\n") == plain);
  CHECK(end(early + late + "seek 30\nundo\nundo\nredo\nredo\nseek 40\n") == both);
  CHECK(end(early + "undo\nredo\nseek 40\n") == first);
  // in the past: what was known after it is another future, and comes back with undo
  CHECK(end(late + "seek 30\n" + early + "seek 40\n") == first);
  CHECK(end(late + "seek 30\n" + early + "seek 15\nundo\nseek 40\n") == end(late + "seek 40\n"));
  // the name is free again
  CHECK(end(early + "undo\nadd ball_2 like crate at 0 3 0\nundo\n" + early + "seek 40\n") == first);
  // before one that a script adds later, of which a line behind it speaks
  const std::string script = fmt::format("at 25 {}\nbreak when speed(jelly_2) > 0.05\n", kJelly);
  const End wanted{30, states(folder, "s.toml", fmt::format("at 11 {}\nat 25 {}\n", kBall, kJelly), 30)[30]};
  CHECK(end(script + early + "break off\nseek 30\n") == wanted);
  folder.write("a.script", script + early + "seek 60\n");
  const int stopped = end_of(debug(folder, "s.toml", "a.script")).first;
  CHECK(stopped >= 25);
  CHECK(stopped < 60);
}

TEST_CASE("what can't be added is one message at its place") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft + R"([[body]]
name = "led"
kind = "deformable"
shape = { box = { size = [0.5, 0.5, 0.5] } }
volume = { lattice = { cells = 2 } }
position = [9, 0.9, 0]
fixed = [ { box = { min = [-5, 1.1, -5], max = [15, 2, 5] }, motion = [ { time = 0, position = [0, 0, 0] }, { time = 1, position = [1, 0, 0] } ] } ]
)");
  const std::tuple<const char*, const char*, int> cases[] = {
      {"add ball like crate at 0 1 0", "a second body named 'ball'; names must differ, also from deleted ones", 5},
      {"add b like bal at 0 1 0", "unknown body 'bal'; bodies: floor, crate, ball, jelly, led; did you mean 'ball'?",
       12},
      {"add b like floor at 0 1 0", "a copy of 'floor', which no force moves; a dynamic or deformable body is wanted",
       12},
      {"add b like led at 0 1 0", "a copy of 'led', whose held nodes move on a path of their own", 12},
      {"add 2b like ball at 0 1 0", "\"2b\" as a body's name; letters, digits, _ and - are allowed", 5},
      {"add b as ball at 0 1 0", "'as'; add NAME like BODY at X Y Z [velocity VX VY VZ]", 7},
      {"add b like ball 0 1 0", "'0'; add NAME like BODY at X Y Z", 17},
      {"add b like ball at 0 1", "'add' without the place of its file's origin, m", 1},
      {"add b like ball at 0 1 nan", "nan", 24},
      {"add b like ball at 0 1e9 0", "1e+09 is out of range", 22},
      {"add b like ball at 0 1 0 turn 0 0 0 9", "an axis of no length; ", 35},
      {"add b like ball at 0 1 0 velocity 0 0", "'add' without a velocity, m/s", 1},
      {"add b like ball at 0 1 0 hard", "'hard' after all that 'add' takes; ", 26},
      {"add", "'add' without a name; add NAME like BODY at X Y Z", 1}};
  for (const auto& [line, message, column] : cases) {
    CAPTURE(line);
    folder.write("a.script", std::string("step 2\n") + line + "\n");
    const Outcome by_hand = debug(folder, "s.toml", "a.script");
    check_refused(by_hand, message);
    CHECK(by_hand.err.find(fmt::format("a.script:2:{}:", column)) != std::string::npos);
    const Outcome in_run = end_run(folder, "s.toml", std::string("\nat 3 ") + line + "\n", 5);
    check_refused(in_run, message);
    CHECK(in_run.err.find(fmt::format("run.script:2:{}:", column + 5)) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "o"));
  }
  // a name twice; one that comes later; one that an earlier line of a session gives
  check_refused(end_run(folder, "s.toml", "at 3 add b like ball at 0 1 0\nat 9 add b like ball at 0 1 0\n", 5),
                "run.script:2:10: a second body named 'b'");
  check_refused(end_run(folder, "s.toml", "at 9 add b like ball at 0 1 0\nat 3 add c like b at 0 1 0\n", 5),
                "run.script:2:17: unknown body 'b'");
  folder.write("a.script", "add b like ball at 0 1 0\npush b 1 0 0\nadd b like ball at 0 1 0\n");
  const Outcome twice = debug(folder, "s.toml", "a.script");
  check_refused(twice, "a.script:3:5: a second body named 'b'");
}

TEST_CASE("a body that is added into another is said to be, and where bodies are not yet nothing shows them") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid));
  const Outcome run = end_run(folder, "s.toml", "at 4 add crate_2 like crate at 0 0.6 0\n", 8);
  CHECK(run.code == 0);
  CHECK(run.err.find("note: frame 4: 'crate_2' was added ") != std::string::npos);
  CHECK(run.err.find(" into 'crate': they are pushed apart") != std::string::npos);
  // pictures of frames before it are those of a scene without it, and later ones show it
  folder.write("plain.script", "step 3\nshot plain.png\n");
  folder.write("a.script", "at 4 add crate_2 like crate at 0 1.6 0\nstep 3\nshot before.png\nstep 1\nshot after.png\n");
  REQUIRE(debug(folder, "s.toml", "plain.script").code == 0);
  REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
  CHECK((read_png(folder / "before.png").rgb == read_png(folder / "plain.png").rgb));
  CHECK((read_png(folder / "after.png").rgb != read_png(folder / "plain.png").rgb));
}

TEST_CASE("the books of frames before a body was added tell nothing of it, and need not") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid));
  folder.write("a.script",
               fmt::format("step 10\n{}\nbreak when energy_from(gravity,ball_2) > 0\nstep 5\npanel plot "
                           "+energy_from(gravity,ball_2)\nshot a.png\nselect body ball_2\npanel front ledger\n"
                           "shot b.png\nback 8\nshot c.png\nseek 15\nplots p.csv\n",
                           kBall));
  const Outcome outcome = debug(folder, "s.toml", "a.script");
  INFO(outcome.err);
  CHECK(outcome.code == 0);
}

TEST_CASE("the outliner's button copies the selected body by a line, and the recording gives the same pixels") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft);
  for (const char* name : {"ball", "jelly"}) {
    CAPTURE(name);
    folder.write("a.script",
                 fmt::format("step 8\nselect body {}\nui click outliner/copy\nstep 4\nui click outliner/row:{}_2\nshot "
                             "a.png\nui click outliner/copy\nstep 3\nback 9\nstep 9\nshot b.png\n",
                             name, name));
    const std::vector<std::string> large = {"--size", "1280x800"};  // all rows are seen
    const Outcome outcome = debug(folder, "s.toml", "a.script", {"--record", "made.script", "--size", "1280x800"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::string made = slurp(folder / "made.script");
    CAPTURE(made);
    CHECK(made.find(fmt::format("\nadd {}_2 like {} at ", name, name)) != std::string::npos);
    CHECK(made.find(fmt::format("\nadd {}_3 like {}_2 at ", name, name)) != std::string::npos);
    const Image a = read_png(folder / "a.png"), b = read_png(folder / "b.png");
    folder.write("b.script", made);
    CHECK(debug(folder, "s.toml", "b.script", large).out == outcome.out);
    CHECK((read_png(folder / "a.png").rgb == a.rgb));
    CHECK((read_png(folder / "b.png").rgb == b.rgb));
    // above itself, where it touches nobody
    CHECK(outcome.err.find("was added") == std::string::npos);
  }
}

TEST_CASE("files for other programs show added and deleted bodies in the frames in which they are there") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoft);
  const std::string script =
      fmt::format("at 3 {}\nat 4 {}\nat 6 delete crate\nat 7 delete ball_2\nat 8 delete jelly_2\n", kBall, kJelly);
  const Outcome run =
      end_run(folder, "s.toml", script, 9, {"--export", "obj,vtu,usda,poses.csv,poses.json", "--contacts"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  const auto file = [&](const std::string& name) { return folder / ("o/export/" + name); };
  const auto is_there = [](const std::string& body, int frame) {
    if (body == "ball_2") return frame >= 3 && frame < 7;
    if (body == "jelly_2") return frame >= 4 && frame < 8;
    return body != "crate" || frame < 6;
  };
  for (const char* body : {"crate", "ball", "ball_2", "jelly", "jelly_2"})
    for (int frame = 0; frame <= 9; ++frame) {
      CAPTURE(body, frame);
      CHECK(std::filesystem::exists(file(fmt::format("{}.{:06}.obj", body, frame))) == is_there(body, frame));
    }
  const std::string table = slurp(file("poses.csv")), json = slurp(file("poses.json")), usd = slurp(file("s.usda"));
  for (const char* body : {"crate", "ball", "ball_2"})
    for (int frame = 0; frame <= 9; ++frame) {
      std::istringstream rows(table);
      bool found = false;
      for (std::string line; std::getline(rows, line);)
        found |=
            line.starts_with(fmt::format("{},", frame)) && line.find(fmt::format(",{},", body)) != std::string::npos;
      CAPTURE(body, frame);
      CHECK(found == is_there(body, frame));
    }
  // crate, ball and ball_2 in each frame's list
  CHECK(json.find("\"name\": \"ball_2\"") != std::string::npos);
  std::size_t nulls = 0;
  for (std::size_t at = json.find("null"); at != std::string::npos; at = json.find("null", at + 1)) ++nulls;
  CHECK(nulls == 4 + 6);
  const auto of_prim = [&](const std::string& name) {
    const std::size_t begin = usd.find("def Mesh \"" + name + "\"");
    REQUIRE(begin != std::string::npos);
    return usd.substr(begin, usd.find("\n    }\n", begin) - begin);
  };
  const std::string
      shown = "token visibility.timeSamples = {\n            0: \"inherited\",\n            6: \"invisible\",\n",
      added =
          "token visibility.timeSamples = {\n            0: \"invisible\",\n            3: "
          "\"inherited\",\n            7: \"invisible\",\n";
  CHECK(of_prim("crate").find(shown) != std::string::npos);
  CHECK(of_prim("ball_2").find(added) != std::string::npos);
  CHECK(of_prim("jelly_2").find("            4: \"inherited\",\n            8: \"invisible\",\n") != std::string::npos);
  CHECK(of_prim("ball").find("visibility") == std::string::npos);
  CHECK(slurp(file("bodies.csv")).find("4,ball_2,dynamic\n5,jelly_2,deformable\n") != std::string::npos);
}
