// Bodies that are pulled, pushed, moved and deleted: by lines, in scripts of a run, and by the mouse.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// The state of the last frame of a run with a script.
End end_of_run(const TempFolder& folder, const std::string& script, int frames, std::vector<std::string> more = {}) {
  folder.write("run.script", script);
  std::vector<std::string> words = {"run",         "s.toml",     "--out",    "o",
                                    "--script",    "run.script", "--frames", std::to_string(frames),
                                    "--no-images", "--force"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = impinge_run(folder.path(), words);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  return {frames, hash_in(folder / "o/stats.csv", frames)};
}

int changed_pixels(const Image& a, const Image& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) count += !std::equal(&a.rgb[i], &a.rgb[i] + 3, &b.rgb[i]);
  return count;
}

}  // namespace

TEST_CASE("what is done to bodies by hand is what a script of a run does, and what a bundle and a replay do") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid));
  const auto by_script = [&](const std::string& lines) { return end_of_run(folder, lines, 50); };
  const End plain = by_script("");
  const std::pair<const char*, const char*> cases[] = {
      {"step 10\npull crate 0.5 0.25 0.5 to 1 1.5 0\nstep 20\nrelease crate\nstep 20\n",
       "at 11 pull crate 0.5 0.25 0.5 to 1 1.5 0\nat 31 release crate\n"},
      {"step 10\npull ball 0 0 0.3 to 0 2 0 stiffness 800\nstep 5\npull ball 0 0 0.3 to 1 2 0 stiffness 800\nstep 35\n",
       "at 11 pull ball 0 0 0.3 to 0 2 0 stiffness 800\nat 16 pull ball 0 0 0.3 to 1 2 0 stiffness 800\n"},
      {"step 10\npush ball 200 100 0 at 0.1 0.8 0.2\nstep 40\n", "at 11 push ball 200 100 0 at 0.1 0.8 0.2\n"},
      {"step 10\nmove crate 0 0.4 0.1 turn 0 0 1 45\nstep 40\n", "at 11 move crate 0 0.4 0.1 turn 0 0 1 45\n"},
      {"step 10\ndelete crate\nstep 40\n", "at 11 delete crate\n"},
      // in their order, where a frame has several
      {"step 10\nset body.ball.velocity 0 3 0\npush ball 300 0 0\nset body.ball.velocity 1 3 0\npush ball 0 0 99\nstep "
       "40\n",
       "at 11 set body.ball.velocity 0 3 0\nat 11 push ball 300 0 0\nat 11 set body.ball.velocity 1 3 0\n"
       "at 11 push ball 0 0 99\n"},
      {"step 10\npush ball 300 0 0\nset body.ball.velocity 0 3 0\nback 5\nstep 45\n",
       "at 11 push ball 300 0 0\nat 11 set body.ball.velocity 0 3 0\n"}};
  for (const auto& [lines, script] : cases) {
    CAPTURE(lines);
    const End wanted = by_script(script);
    CHECK(wanted.second != plain.second);
    CHECK(end_of_lines(folder, lines) == wanted);
    CHECK(end_of_lines(folder, lines, {"--threads", "1"}) == wanted);
    // once more from a state in the middle, and read anew where none is kept
    CHECK(end_of_lines(folder, std::string(lines) + "back 30\nstep stage 5\nseek 50\n") == wanted);
    CHECK(end_of_lines(folder, std::string(lines) + "seek 0\nseek 50\n", {"--memory", "1"}) == wanted);
    // a run that is gone on with
    end_of_run(folder, script, 20);
    CHECK(impinge_run(folder.path(), {"run", "s.toml", "--out", "o", "--script", "run.script", "--frames", "50",
                                      "--no-images", "--resume"})
              .code == 0);
    CHECK(hash_in(folder / "o/stats.csv", 50) == wanted.second);
    // a bundle makes every frame again, and its recording is in it
    folder.write("a.script", std::string(lines) + "bundle b.tar\n");
    REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
    CHECK(impinge_run(folder.path(), {"replay", "b.tar"}).code == 0);
  }
}

TEST_CASE("what was done to bodies is undone and done again, a drag as a whole") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const auto end = [&](const std::string& lines) { return end_of_lines(folder, lines); };
  const End plain = end("step 60\n");
  std::string drag = "step 20\n";
  for (int k = 0; k < 10; ++k) drag += fmt::format("pull ball 0 0.3 0 to {} 2 0\nstep\n", 0.1 * k);
  drag += "release ball\n";
  const End dragged = end(drag + "step 30\n");
  CHECK(dragged != plain);
  CHECK(end(drag + "undo\nseek 60\n") == plain);
  CHECK(end(drag + "undo\n").first == 20);
  CHECK(end(drag + "step 5\nundo\nredo\nseek 60\n") == dragged);
  CHECK(end(drag + "back 4\nundo\nstep 3\nredo\nseek 60\n") == dragged);
  for (const char* line : {"delete crate\n", "push crate 300 900 0\n", "move ball 0.4 0 0\n"}) {
    CAPTURE(line);
    const End done = end(std::string("step 20\n") + line + "step 40\n");
    CHECK(done != plain);
    CHECK(end(std::string("step 20\n") + line + "step 30\nundo\nseek 60\n") == plain);
    CHECK(end(std::string("step 20\n") + line + "undo\nredo\nseek 60\n") == done);
    CHECK(end(std::string("step 20\n") + line + "step 9\nset contact.friction 0\nundo\nundo\nredo\nseek 60\n") == done);
  }
  // a second drag is a change of its own
  CHECK(end(drag + "pull ball 0 0.3 0 to 0 2 0\nstep 3\nrelease ball\nundo\nseek 60\n") == dragged);
}

TEST_CASE("what can't be done to a body is one message at its place") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoftCube);
  const std::pair<const char*, const char*> cases[] = {
      {"pull crat 0 0 0 to 1 1 1", "unknown body 'crat'; bodies: floor, crate, ball, jelly; did you mean 'crate'?"},
      {"pull floor 0 0 0 to 1 1 1", "'pull' of 'floor', which no force moves; a dynamic or deformable body is wanted"},
      {"push floor 0 0 1", "'push' of 'floor', which no force moves"},
      {"move floor 0 0 1", "'move' of 'floor', which no force moves"},
      {"release floor", "'release' of 'floor', which no force moves"},
      {"pull ball 0 0 0 1 1 1", "'1'; pull BODY X Y Z to X Y Z [stiffness K] is wanted; write to before the place"},
      {"pull ball 0 0 0 to 1 1", "'pull' without the place that it is pulled to; pull BODY X Y Z to X Y Z"},
      {"pull ball 0 0 0 to 1 1 1 stiffness -3", "-3"},
      {"pull ball 0 0 0 to 1 1 1 hard", "'hard' after all that 'pull' takes; "},
      {"push ball 0 0 nan", "nan"},
      {"push ball 0 inf 0", "inf"},
      {"push ball 1e300 0 0", "1e+300 is out of range for push; "},
      {"push ball", "'push' without an impulse, N s; push BODY JX JY JZ [at X Y Z] is wanted"},
      {"move ball 0 0 0 turn 0 0 0 9", "an axis of no length; "},
      {"move jelly 0 0 0 turn 0 0 1 9", "'turn' of the deformable body 'jelly'; "},
      {"delete", "'delete' without a body; delete BODY is wanted"},
      {"delete ball crate", "'crate' after all that 'delete' takes; "},
      {"delet ball", "unknown command 'delet'"}};
  for (const auto& [line, message] : cases) {
    CAPTURE(line);
    folder.write("a.script", std::string("step 2\n") + line + "\n");
    const Outcome by_hand = debug(folder, "s.toml", "a.script");
    check_refused(by_hand, message);
    CHECK(by_hand.err.find("a.script:2:") != std::string::npos);
    folder.write("a.script", std::string("\nat 3 ") + line + "\n");
    const Outcome in_run =
        impinge_run(folder.path(), {"run", "s.toml", "--out", "o", "--script", "a.script", "--no-images"});
    check_refused(in_run, message);
    CHECK(in_run.err.find("a.script:2:") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "o"));
  }
}

TEST_CASE("a drag with the mouse pulls the point under it, and its recording does the same") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoftCube + "[view.camera]\neye = [0, 0.6, 6]\ntarget = [0, 0.6, 0]\n");
  const auto drag_at = [&](int x, int y, const char* key) {
    return fmt::format(
        "step 5\nui move {} {}\nui key ctrl down\nui press left\nui move {} {}\nui wait 1\nui move {} {}\nui key ctrl "
        "up\n"
        "shot asked.png\nstep 4\nui move {} {}\nshot pulled.png\nstep 4\nui release left\nstep 20\n{}",
        x, y, x + 20, y - 30, x + 40, y - 60, x + 60, y - 90, key);
  };
  folder.write("a.script", "step 5\nshot plain.png\n");
  REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
  // the ball, the crate, the jelly
  for (const auto& [x, y] : {std::pair(470, 155), {460, 245}, {365, 195}}) {
    CAPTURE(x, y);
    folder.write("a.script", drag_at(x, y, ""));
    const Outcome outcome = debug(folder, "s.toml", "a.script", {"--record", "made.script"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::string made = slurp(folder / "made.script");
    CAPTURE(made);
    CHECK(made.find("\npull ") != std::string::npos);
    CHECK(made.find("camera") == std::string::npos);
    CHECK(made.find("\nrelease ") != std::string::npos);
    // one line a frame
    CHECK(std::count(made.begin(), made.end(), '\n') < 16);
    const Image asked = read_png(folder / "asked.png"), drawn = read_png(folder / "pulled.png");
    folder.write("b.script", made);
    CHECK(debug(folder, "s.toml", "b.script").out == outcome.out);
    CHECK(read_png(folder / "asked.png").rgb == asked.rgb);
    CHECK(read_png(folder / "pulled.png").rgb == drawn.rgb);
    CHECK(changed_pixels(asked, read_png(folder / "plain.png")) > 50);  // an arrow before it acts
    // the same with the model alone
    folder.write("a.script", drag_at(x, y, "undo\nseek 33\n"));
    CHECK(end_of(debug(folder, "s.toml", "a.script")) == end_of_run(folder, "", 33));
  }
}

TEST_CASE("a drag while it plays is one line for each frame in which the mouse moved, and one change") {
  const TempFolder folder;
  folder.write("s.toml", std::string(kRigid) + kSoftCube + "[view.camera]\neye = [0, 0.6, 6]\ntarget = [0, 0.6, 0]\n");
  std::string drag = "step 5\nui move 365 195\nui key ctrl down\nui press left\nplay\n";
  for (int k = 1; k <= 8; ++k) drag += fmt::format("ui move {} {}\nui wait 2\n", 365 + 10 * k, 195 - 8 * k);
  drag += "ui release left\nui key ctrl up\npause\n";
  folder.write("a.script", drag);
  const Outcome outcome = debug(folder, "s.toml", "a.script", {"--record", "made.script"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  const std::string made = slurp(folder / "made.script");
  CAPTURE(made);
  std::istringstream lines(made);
  int pulls = 0;
  std::string before;
  for (std::string line; std::getline(lines, line); before = line) {
    const bool is_pull = line.starts_with("pull jelly ");
    pulls += is_pull;
    CHECK_FALSE((is_pull && before.starts_with("pull ")));
  }
  CHECK(pulls == 8);
  CHECK(made.find("release jelly") != std::string::npos);
  folder.write("b.script", made);
  CHECK(debug(folder, "s.toml", "b.script").out == outcome.out);
  folder.write("a.script", drag + "undo\nseek 40\n");
  CHECK(end_of(debug(folder, "s.toml", "a.script")) == end_of_run(folder, "", 40));
}

TEST_CASE("a deleted body is neither seen nor picked, and why, outliner and figures say so") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write(
      "a.script",
      "step 30\nselect body crate\ndelete crate\nstep\nwhy ball crate\nwhy crate floor\nframe crate\nshot a.png\n"
      "undo\nstep\nshot b.png\n");
  const Outcome outcome = debug(folder, "s.toml", "a.script", {"--record", "made.script"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(changed_pixels(read_png(folder / "a.png"), read_png(folder / "b.png")) > 3000);
  end_of_run(folder, "at 5 delete crate\n", 8, {"--export", "obj,vtu"});
  const auto is_there = [&](const std::string& file) { return std::filesystem::exists(folder / ("o/export/" + file)); };
  CHECK(is_there("crate.000004.obj"));
  CHECK_FALSE(is_there("crate.000005.obj"));
  CHECK(is_there("ball.000008.obj"));
  CHECK(slurp(folder / "o/export/rigid.000004.vtu").size() > slurp(folder / "o/export/rigid.000005.vtu").size());
  std::istringstream stats(slurp(folder / "o/stats.csv"));
  std::string header, line;
  std::getline(stats, header);
  std::vector<std::string> lines;
  while (std::getline(stats, line)) lines.push_back(line);
  const auto column = [&](const std::string& name, std::size_t row) {
    std::istringstream names(header), cells(lines.at(row));
    std::string n, c;
    while (std::getline(names, n, ',') && std::getline(cells, c, ','))
      if (n == name) return c;
    return std::string("none");
  };
  CHECK(column("bodies", 4) == "3");
  CHECK(column("bodies", 5) == "2");
}
