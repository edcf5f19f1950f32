// Going about within a frame in the debugger: by sub-steps and by stages, there and back, and what is recorded of it.
#include <catch2/catch.hpp>

#include "tests/support/program/debug_session.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

struct Files {
  TempFolder folder;
  Files() {
    folder.write("s.toml", kRigid);
    impinge_run(folder.path(), {"run", "s.toml", "--out", "whole", "--frames", "60", "--no-images"});
  }
  /// What the debugger says at its end.
  std::string end(const std::string& lines, const std::vector<std::string>& more = {}) {
    folder.write("a.script", lines);
    const Outcome said = debug(folder, "s.toml", "a.script", more);
    INFO(lines << said.err);
    CHECK(said.code == 0);
    const auto [frame, hash] = end_of(said);
    CHECK(hash == hash_in(folder / "whole/stats.csv", frame));
    return said.out.substr(0, said.out.find(',')) +
           (said.out.find(';') == std::string::npos
                ? ""
                : said.out.substr(said.out.find(';'), said.out.find('\n') - said.out.find(';')));
  }
};

const std::string kIn = "; in the middle of it: ";

}  // namespace

TEST_CASE("a frame is gone through by sub-steps and stages, there and back, and ends as it always does") {
  Files f;
  CHECK(f.end("step 30\nstep substep\n") == "frame 31" + kIn + "sub-step 1 of 2, end");
  CHECK(f.end("step 30\nstep substep 2\n") == "frame 31");
  CHECK(f.end("step 30\nstep substep 5\n") == "frame 33" + kIn + "sub-step 1 of 2, end");
  CHECK(f.end("step 30\nstep substep 5\nback substep 5\n") == "frame 30");
  CHECK(f.end("step 30\nback substep\n") == "frame 30" + kIn + "sub-step 1 of 2, end");
  CHECK(f.end("step 30\nback substep 2\n") == "frame 29");
  CHECK(f.end("step 30\nstep stage\n") == "frame 31" + kIn + "sub-step 1 of 2, piece 1, free motion");
  CHECK(f.end("step 30\nstep stage 2\n") == "frame 31" + kIn + "sub-step 1 of 2, piece 1, broad phase");
  CHECK(f.end("step 30\nstep stage 3\nback stage\nback stage\n") ==
        "frame 31" + kIn + "sub-step 1 of 2, piece 1, free motion");
  CHECK(f.end("step 30\nstep stage 3\nback stage 3\n") == "frame 30");
  CHECK(f.end("step 30\nback stage\nstep stage\n") == "frame 30");
  CHECK(f.end("step 30\nback stage 400\nstep stage 400\n") == "frame 30");
  CHECK(f.end("back stage\nback substep 3\n") == "frame 0");
  // whole frames are counted from the one in work
  CHECK(f.end("step 30\nstep stage 4\nstep\n") == "frame 32");
  CHECK(f.end("step 30\nstep stage 4\nseek 31\n") == "frame 31");
  CHECK(f.end("step 30\nstep stage 4\nback\n") == "frame 30");
  CHECK(f.end("step 30\nstep stage 4\nplay\nui wait 4\npause\n") == "frame 35");
  // with room for few states
  CHECK(f.end("step 50\nback 20\nstep stage 7\nback stage 100\nstep stage 100\nback stage 7\n", {"--memory", "1"}) ==
        "frame 30");
}

TEST_CASE("a change in the middle of a frame goes back to its start and counts in it") {
  Files f;
  f.folder.write("g.script", "at 31 set simulation.gravity 0 -3 0\n");
  impinge_run(f.folder.path(),
              {"run", "s.toml", "--script", "g.script", "--out", "other", "--frames", "40", "--no-images"});
  f.folder.write("a.script", "step 30\nstep stage 9\nset simulation.gravity 0 -3 0\nstep 3\n");
  const auto [frame, hash] = end_of(debug(f.folder, "s.toml", "a.script"));
  CHECK(frame == 33);
  CHECK(hash == hash_in(f.folder / "other/stats.csv", 33));
}

TEST_CASE("stages look the same when what was done is done again") {
  Files f;
  f.folder.write("a.script",
                 "layer +aabbs +broad_pairs +normals +contact_forces +velocities\nstep 30\nstep stage 2\nshot a.png\n"
                 "step stage 6\nselect contact 0\nshot b.png\nback stage 3\nshot c.png\nui key down\nui key up\n"
                 "step substep\nshot d.png\nfreeze e.step\nshot e.png\n");
  for (const char* out : {"one", "two"}) {
    const Outcome said = debug(f.folder, "s.toml", std::string(out) == "one" ? "a.script" : "r.script",
                               {"--record", std::string(out) == "one" ? "r.script" : "r2.script", "--out", out});
    INFO(said.err);
    REQUIRE(said.code == 0);
  }
  for (const char* shot : {"a.png", "b.png", "c.png", "d.png", "e.png"}) {
    CAPTURE(shot);
    const std::string one = slurp(f.folder / "one" / shot);
    CHECK((!one.empty() && one == slurp(f.folder / "two" / shot)));
  }
  CHECK(slurp(f.folder / "one/a.png") != slurp(f.folder / "one/b.png"));
  const std::string record = slurp(f.folder / "r.script"), second = slurp(f.folder / "r2.script");
  CHECK(second.substr(second.find('\n')) == record.substr(record.find('\n')));
  CHECK(record.find("back stage 3\n") != std::string::npos);
  CHECK(slurp(f.folder / "one/e.step") == slurp(f.folder / "two/e.step"));
}

TEST_CASE("freeze in the debugger writes what run --freeze writes") {
  Files f;
  impinge_run(f.folder.path(), {"run", "s.toml", "--out", "frozen", "--frames", "40", "--no-images", "--freeze", "33"});
  for (const char* lines : {"step 33\nfreeze x.step\n", "step 40\nback 7\nback stage 3\nfreeze x.step\n"}) {
    f.folder.write("a.script", lines);
    REQUIRE(debug(f.folder, "s.toml", "a.script").code == 0);
    const std::string frozen = slurp(f.folder / "frozen/frozen/000033.step");
    CHECK((!frozen.empty() && frozen == slurp(f.folder / "x.step")));
  }
  f.folder.write("a.script", "freeze x.step\n");
  CHECK(debug(f.folder, "s.toml", "a.script").code == 2);
  f.folder.write("a.script", "step\nfreeze x.bin\n");
  CHECK(debug(f.folder, "s.toml", "a.script").code == 2);
}
