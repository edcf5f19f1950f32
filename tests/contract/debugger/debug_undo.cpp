// What is taken back is as if it had never been done, and what is done again as if it had not been taken back.
#include <fmt/format.h>

#include <map>

#include "tests/support/program/debug_session.hpp"
#include "tests/support/random.hpp"

using namespace impinge;
using namespace impinge::test;

TEST_CASE("a change that is undone, wherever one stands by then, leaves no trace, and comes back by redo") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const auto plain = end_of_lines(folder, "step 60\n");
  const auto changed = end_of_lines(folder, "step 30\nset contact.friction 0.02\nstep 30\n");
  REQUIRE(plain.second != changed.second);
  const auto end = [&](const std::string& lines) { return end_of_lines(folder, lines); };
  CHECK(end("step 30\nset contact.friction 0.02\nundo\nstep 30\n") == plain);
  CHECK(end("step 30\nset contact.friction 0.02\nstep 25\nundo\nstep 30\n") == plain);
  CHECK(end("step 30\nset contact.friction 0.02\nback 10\nundo\nseek 60\n") == plain);
  CHECK(end("step 30\nset contact.friction 0.02\nstep 25\nundo\nredo\nstep 30\n") == changed);
  CHECK(end("step 30\nset contact.friction 0.02\nstep 25\nundo\nback 3\nredo\nseek 60\n") == changed);
  CHECK(end("step 30\nset contact.friction 0.02\nstep stage 4\nundo\nstep 30\n") == plain);
  // it goes back to where the change was made
  CHECK(end("step 30\nset contact.friction 0.02\nstep 25\nundo\n").first == 30);
  CHECK(end("step 30\nset contact.friction 0.02\nback 10\nundo\n").first == 20);
  // a change in the past forgets what came after it; undone, that is known again, and comes out as it was
  CHECK(end("step 60\nback 30\nset contact.friction 0.02\nundo\nseek 60\n") == plain);
  CHECK(end("step 60\nback 30\nset contact.friction 0.02\nstep 10\nundo\nstep 30\n") == plain);
  // with the later changes that it forgot
  const auto later = end("step 45\nset simulation.gravity 0 -5 0\nstep 15\n");
  CHECK(end("step 45\nset simulation.gravity 0 -5 0\nstep 15\nseek 10\nset contact.friction 0.02\nstep 5\nundo\nseek "
            "60\n") == later);
  // of a body, whose state it changes at once
  CHECK(end("step 30\nset body.ball.friction 0\nset contact.friction 0\nundo\nundo\nstep 30\n") == plain);
  CHECK(end("undo\nredo\nstep 60\n") == plain);
}

TEST_CASE("a run's folder is its own again once a change of it is undone") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--out", "done", "--frames", "50", "--no-images"}).code == 0);
  folder.write("a.script", "seek 20\nset contact.friction 0.01\nstep 40\nundo\nseek 47\n");
  const Outcome outcome = debug(folder, "done", "a.script");
  CHECK(outcome.err.empty());
  CHECK(end_of(outcome) == std::pair(47, hash_in(folder / "done/stats.csv", 47)));
}

TEST_CASE("what is hidden, shown and switched is undone, where the camera is stays") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const auto view_of = [&](const std::string& lines) {
    folder.write("a.script", "step 20\n" + lines + "seek 0\npanel filter x\nbundle b.tar\n");
    REQUIRE(debug(folder, "s.toml", "a.script").code == 0);
    REQUIRE(std::system(("cd " + folder.path().string() + " && tar xf b.tar").c_str()) == 0);
    return slurp(folder / "impinge-bundle/opening.script");  // the view, as lines
  };
  const std::string plain = view_of(""), turned = view_of("camera orbit 30 0\n");
  CHECK(view_of("hide crate\nundo\n") == plain);
  CHECK(view_of("layer +aabbs -contacts\nisolate ball\nset view.clip.offset 0.2\nundo\nundo\nundo\n") == plain);
  CHECK(view_of("lock floor\nhide ball\ncamera orbit 30 0\nundo\nundo\n") == turned);
  const std::string hidden = view_of("hide crate\n");
  CHECK(hidden != plain);
  CHECK(view_of("hide crate\nundo\nredo\n") == hidden);
  CHECK(view_of("hide crate\nhide ball\nundo\n") == hidden);
  CHECK(view_of("hide crate\nundo\nhide crate\nredo\n") == hidden);
  CHECK(view_of("frame crate\nundo\n") == view_of("frame crate\n"));
}

TEST_CASE("of many changes, undone and done again at random, those are left that a list of them has") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  Random random(2016);
  for (int trial = 0; trial < 25; ++trial) {
    // what is to hold: by frame and path, and the same before each change
    using Changes = std::map<int, std::map<std::string, double>>;
    struct Step {
      int frame;
      Changes before;
    };
    Changes changes;
    std::vector<Step> done, undone;
    std::string lines, last;
    int frame = 0;
    const auto take_back = [&](std::vector<Step>& from, std::vector<Step>& to) {
      if (from.empty()) return;
      Step step = from.back();
      from.pop_back();
      frame = std::min(frame, step.frame);
      std::swap(step.before, changes);
      to.push_back(step);
    };
    for (int k = 0; k < 40; ++k) {
      std::string line;
      switch (random.below(6)) {
        case 0:
        case 1: {
          const std::string path = random.below(2) == 0 ? "contact.friction" : "body.ball.friction";
          const double value = 0.01 * random.below(100);
          line = fmt::format("set {} {}", path, value);
          if (!last.starts_with("set " + path)) done.push_back({frame, changes});
          undone.clear();
          changes.erase(changes.upper_bound(frame + 1), changes.end());
          changes[frame + 1][path] = value;
          break;
        }
        case 2:
          line = fmt::format("step {}", 1 + random.below(6));
          frame += std::stoi(line.substr(5));
          break;
        case 3:
          line = fmt::format("back {}", 1 + random.below(6));
          frame = std::max(0, frame - std::stoi(line.substr(5)));
          break;
        case 4:
          line = "redo";
          take_back(undone, done);
          break;
        default:
          line = "undo";
          take_back(done, undone);
      }
      lines += line + "\n";
      last = line;
    }
    INFO(lines);
    const auto end = end_of_lines(folder, lines + "seek 70\n");
    CHECK(end.first == 70);
    std::string script;
    for (const auto& [at, sets] : changes)
      for (const auto& [path, value] : sets) script += fmt::format("at {} set {} {}\n", at, path, value);
    folder.write("run.script", script);
    REQUIRE(impinge_run(folder.path(), {"run", "s.toml", "--script", "run.script", "--out", "o", "--frames", "70",
                                        "--no-images", "--force"})
                .code == 0);
    CHECK(end.second == hash_in(folder / "o/stats.csv", 70));
  }
}
