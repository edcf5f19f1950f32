// Bodies hidden, looked at alone, locked, framed and followed: by lines, in scripts of a run, and by the outliner.
#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

bool same(const std::string& a, const std::string& b) { return !a.empty() && a == b; }

}  // namespace

TEST_CASE("a script of a run hides, isolates, frames and follows, as the scene's own rows do") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "at 2 hide crate\nat 4 show all\nat 6 isolate ball\nat 8 show crate\nat 10 frame ball\n"
               "at 12 follow ball\nat 20 follow none\n");
  const auto run = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> words = {"run", "s.toml", "--out", out, "--size", "320x180"};
    if (std::find(more.begin(), more.end(), "--frames") == more.end()) words.insert(words.end(), {"--frames", "22"});
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
  };
  run("script", {"--script", "a.script"});
  run("plain", {});
  run("hidden", {"--set", "view.hidden=[crate]"});
  run("alone", {"--set", "view.hidden=[floor,crate]"});
  const auto pixels = [&](const std::string& out, int frame) {
    return read_png(folder.path() / out / "frames" / fmt::format("{:06}.png", frame)).rgb;
  };
  CHECK((pixels("script", 1) == pixels("plain", 1)));
  CHECK((pixels("script", 2) == pixels("hidden", 2)));
  CHECK((pixels("script", 3) != pixels("plain", 3)));
  CHECK((pixels("script", 5) == pixels("plain", 5)));
  CHECK((pixels("script", 7) == pixels("alone", 7)));
  CHECK((pixels("script", 11) != pixels("alone", 11)));
  for (const char* out : {"script", "plain"}) CHECK(hash_in(folder.path() / out / "stats.csv", 22) != "");
  CHECK(hash_in(folder / "script/stats.csv", 22) == hash_in(folder / "plain/stats.csv", 22));

  // a run that is gone on with has what was hidden
  run("resumed", {"--script", "a.script", "--frames", "15"});
  run("resumed", {"--script", "a.script", "--resume"});
  for (const int frame : {14, 18, 22}) CHECK((pixels("resumed", frame) == pixels("script", frame)));
}

TEST_CASE("a body that is not there is one message at its place") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const std::pair<const char*, const char*> cases[] = {
      {"hide crat\n", "a.script:1:6: unknown body 'crat'; bodies: floor, crate, ball; did you mean 'crate'?"},
      {"hide\n", "a.script:1:1: 'hide' without a body; hide NAME... is wanted; "},
      {"show\n", "a.script:1:1: 'show' without a body; show NAME...|all is wanted; "},
      {"hide all\n", "a.script:1:6: unknown body 'all'; "},
      {"follow ball crate\n", "a.script:1:13: 'crate' after the body; one body can be followed; "},
      {"follow al\n", "a.script:1:8: unknown body 'al'; "},
      {"frame crate bal\n", "a.script:1:13: unknown body 'bal'; "},
      {"set view.hidden [crate, bal]\n", "a.script:1:17: unknown body 'bal'; "},
      {"color ball\n", "a.script:1:7: 'ball' for a colour; color NAME... RRGGBB|none is wanted; "},
      {"color none\n", "a.script:1:7: 'color' without a body; color NAME... RRGGBB|none is wanted; "},
      {"color bal none\n", "a.script:1:7: unknown body 'bal'; "},
      {"color ball e0702\n", "a.script:1:12: 'e0702' for a colour; "},
      {"set view.colors [\"bal=e07020\"]\n", "a.script:1:17: unknown body 'bal'; "},
      {"set view.colors [\"ball=orange\"]\n", "a.script:1:17: 'ball=orange'; NAME=rrggbb is wanted; "},
      {"panel sort bodies sped\n", "a.script:1:19: unknown column 'sped'; "},
      {"panel columns body +mass\n", "a.script:1:15: unknown table 'body'; allowed: contacts, bodies, groups, pairs; "},
      {"panel columns bodies mass\n", "a.script:1:22: 'mass'; +COLUMN or -COLUMN is wanted; "},
      {"panel tab pair\n", "a.script:1:11: unknown tab 'pair'; allowed: bodies, groups, pairs; did you mean 'pairs'?"},
      {"panel front outlner\n", "a.script:1:13: unknown panel 'outlner'; "},
  };
  for (const auto& [line, message] : cases) {
    CAPTURE(line);
    folder.write("a.script", line);
    check_refused(debug(folder, "s.toml", "a.script"), message);
  }
  const Outcome set = impinge_run(folder.path(), {"run", "s.toml", "--out", "o", "--set", "view.hidden=[bal]"});
  CHECK(set.code == 2);
  CHECK(set.err.find("--set view.hidden=[bal]: 'bal' for view.hidden; bodies: floor, crate, ball; did you mean "
                     "'ball'?") != std::string::npos);
  folder.write("a.script", "hide crate\n");
  const Outcome bare = impinge_run(folder.path(), {"run", "s.toml", "--out", "o", "--script", "a.script"});
  CHECK(bare.code == 2);
  CHECK(bare.err.find("put 'at K' before it") != std::string::npos);
}

TEST_CASE("what is done in the outliner is lines, and they show the same pixels again") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", R"(step 50
ui click panels/outliner
ui click outliner/sort:speed
ui click outliner/sort:speed
ui click outliner/row:ball
ui click outliner/hide:crate
shot hidden.png
ui click outliner/hide:crate
ui click outliner/lock:ball
ui click outliner/frame
ui click outliner/follow
step 5
ui click outliner/isolate
ui click outliner/color
ui click outliner/color:d02020
ui key escape
shot alone.png
ui click outliner/show_all
ui click outliner/columns
ui click outliner/columns:mass
ui key escape
ui click outliner/pairs
ui click outliner/row:crate,ball
ui click outliner/groups
ui click outliner/row:0
ui click outliner/bodies
ui click outliner/search
ui text ba
ui key enter
ui key h
shot end.png
)");
  const Outcome first = debug(folder, "s.toml", "a.script", {"--out", "one", "--record", "r.script"});
  INFO(first.err);
  REQUIRE(first.code == 0);
  const std::string recording = slurp(folder / "r.script");
  INFO(recording);
  for (const char* line :
       {"panel front outliner\n", "panel sort bodies speed\n", "panel sort bodies speed down\n", "select body ball\n",
        "hide crate\n", "show crate\n", "lock ball\n", "frame ball\n", "follow ball\n", "isolate ball\n",
        "color ball d02020\n", "show all\n", "panel columns bodies +mass\n", "panel tab pairs\n", "select contact ",
        "panel tab groups\n", "panel search ba\n"})
    CHECK(recording.find("\n" + std::string(line)) != std::string::npos);
  CHECK(recording.find("ui click") == std::string::npos);
  const Outcome again = debug(folder, "s.toml", "r.script", {"--out", "two"});
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(again.out == first.out);
  for (const char* picture : {"hidden.png", "alone.png", "end.png"})
    CHECK(same(slurp(folder.path() / "one" / picture), slurp(folder.path() / "two" / picture)));
}

TEST_CASE("a click goes through a locked body to what lies behind it") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const std::string look = "camera eye 0 0.2 4\ncamera target 0 0.2 0\nlayer -contacts -normals\n",
                    click = "ui move 483 224\nui press left\nui release left\n";
  const auto picked = [&](const std::string& before) {
    folder.write("a.script", look + before + click);
    const Outcome outcome = debug(folder, "s.toml", "a.script", {"--record", "r.script"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const std::string recording = slurp(folder / "r.script");
    fs::remove(folder / "r.script");
    const std::size_t at = recording.find("select ");
    return at == std::string::npos ? "" : recording.substr(at, recording.find_first_of("\n", at) - at);
  };
  CHECK(picked("").starts_with("select body crate"));
  CHECK(picked("lock crate\n") == "select none");
  CHECK(picked("lock crate\nunlock all\n").starts_with("select body crate"));
  CHECK(picked("hide crate\n") == "select none");
}
