// impinge test, as a user's continuous integration runs it.
#include <catch2/catch.hpp>

#include <regex>

#include "tests/support/pictures/picture_scene.hpp"
#include "viewer/image/difference.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::string kScene = std::string(kCrateOnSlab) + R"(position = [0, 0.26, 0]
)" + kFrontView + R"(layers = ["meshes", "contacts"]
)";

struct Suite {
  TempFolder folder;
  Suite() {
    folder.write("suite/rest.toml", kScene);
    folder.write("suite/rest.script", "expect contacts > 0 at 4\nexpect image pictures/rest.png at 4\n");
    folder.write("suite/fall.toml", kScene);
    folder.write("suite/fall.script", "at 1 set body.crate.velocity 0 3 0\nexpect contacts == 0 at 6\n");
  }
  Outcome run(const std::vector<std::string>& more = {}) const {
    return told(folder, {"test", "suite", "--out", "out"}, more);
  }
};

}  // namespace

TEST_CASE("a suite without its pictures fails, --update writes them, then it passes") {
  const Suite suite;
  const Outcome before = suite.run();
  CHECK(before.code == 1);
  CHECK(holds(before.out, "FAILED  rest: 1 expectation, 1 picture"));
  CHECK(holds(before.out,
              "suite/rest.script:2:1: frame 4: rest.png: there is no suite/pictures/rest.png; impinge test suite "
              "--update writes it"));
  CHECK(holds(before.out, "ok      fall: 1 expectation, 0 pictures"));
  CHECK(holds(before.out, "2 tests: 1 ok, 1 failed"));
  CHECK_FALSE(fs::exists(suite.folder / "suite/pictures"));

  const Outcome update = suite.run({"--update", "--size", "200x120"});
  CHECK(update.code == 0);
  CHECK(holds(update.out, "new: suite/pictures/rest.png"));
  CHECK(read_png(suite.folder / "suite/pictures/rest.png").width == 200);
  const Outcome after = suite.run();
  CHECK(after.code == 0);
  CHECK(holds(after.out, "2 tests: 2 ok, 0 failed"));
  // the script alone says the same
  CHECK(impinge_run(suite.folder.path(), {"run", "suite/rest.toml", "--script", "suite/rest.script", "--out", "alone",
                                          "--frames", "4", "--size", "200x120"})
            .code == 0);
}

TEST_CASE("a failure says why, leaves pictures and a report, and how to see it again") {
  const Suite suite;
  REQUIRE(suite.run({"--update"}).code == 0);
  suite.folder.write("suite/rest.toml", replaced(kScene, "size = [1, 0.5, 1]", "size = [1, 0.52, 1]"));
  suite.folder.write("suite/fall.script", "at 1 set body.crate.velocity 0 3 0\nexpect contacts > 2 at 6\n");
  const Outcome outcome = suite.run({"--junit", "junit.xml"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "suite/fall.script:2:1: frame 6: expected contacts > 2; found contacts = 0"));
  CHECK(holds(outcome.out, "the state changed"));
  CHECK(holds(outcome.out, "meshes: crate changed"));
  CHECK(holds(outcome.out, "see:   out/rest/report.html"));
  CHECK(fs::exists(suite.folder / "out/rest/report.html"));
  CHECK(fs::exists(suite.folder / "out/rest/rest.png"));
  CHECK(holds(slurp(suite.folder / "out/fall/report.html"),
              "<li>suite/fall.script:2:1: frame 6: expected contacts &gt; 2; found contacts = 0"));
  CHECK(fs::exists(suite.folder / "out/rest/run/frames/000004.png"));
  // the command it prints does show the failure
  std::smatch again;
  REQUIRE(std::regex_search(outcome.out, again, std::regex("again: impinge (run suite/fall.toml[^\n]*)")));
  std::vector<std::string> words;
  std::istringstream in(again[1].str());
  for (std::string word; in >> word;) words.push_back(word);
  CHECK(impinge_run(suite.folder.path(), words).code == 1);

  const std::string xml = slurp(suite.folder / "junit.xml");
  CHECK(holds(xml, "<testsuite name=\"suite\" tests=\"2\" failures=\"2\" errors=\"0\""));
  CHECK(holds(xml, "<failure message=\"suite/fall.script:2:1: frame 6: expected contacts &gt; 2;"));
  CHECK(holds(xml, "<testcase classname=\"suite\" name=\"rest\""));

  // what was meant is taken over on purpose
  const Outcome update = suite.run({"--update"});
  CHECK(update.code == 1);  // the figures still fail
  CHECK(holds(update.out, "rewrote suite/pictures/rest.png"));
  CHECK(holds(suite.run().out, "ok      rest"));
  CHECK_FALSE(fs::exists(suite.folder / "out/rest/report.html"));
}

TEST_CASE("a picture that two frames share is written only if they look alike") {
  const Suite suite;
  const std::string shared = "expect image pictures/a.png at 4\nexpect image pictures/../pictures/a.png at 9\n";
  suite.folder.write("suite/fall.script", "at 5 set body.crate.velocity 0 3 0\n" + shared);
  const Outcome outcome = suite.run({"--update", "--only", "fall"});
  CHECK(outcome.code == 1);
  CHECK(
      holds(outcome.out,
            "suite/fall.script:3:1: a.png at frame 9, and at frame 4 (suite/fall.script:2:1), which looks different; a "
            "picture of its own for each is wanted; name another file"));
  CHECK_FALSE(fs::exists(suite.folder / "suite/pictures/a.png"));
  suite.folder.write("suite/fall.script", shared);  // it stays where it is
  CHECK(suite.run({"--update", "--only", "fall"}).code == 0);
  CHECK(suite.run({"--only", "fall"}).code == 0);
}

TEST_CASE("what is wrong with one test is an error of that test, and the others run") {
  const Suite suite;
  REQUIRE(suite.run({"--update"}).code == 0);
  suite.folder.write("suite/bad.toml", "[[body]]\nname = 3\n");
  suite.folder.write("suite/bad.script", "expect contacts > 0 at 1\n");
  suite.folder.write("suite/lost.script", "expect contacts > 0 at 1\n");
  suite.folder.write("suite/nothing.toml", kScene);
  suite.folder.write("suite/nothing.script", "at 1 set contact.friction 0\n");
  suite.folder.write("suite/sizes.toml", kScene);
  suite.folder.write("suite/sizes.script",
                     "expect image pictures/rest.png at 4\nexpect image pictures/small.png at 4\n");
  suite.folder.write("suite/text.toml", kScene);
  suite.folder.write("suite/text.script", "expect image pictures/text.png at 4\n");
  suite.folder.write("suite/pictures/text.png", "no picture");
  write_png(suite.folder / "suite/pictures/small.png", Image(64, 48));
  const Outcome outcome = suite.run({"--junit", "junit.xml"});
  CHECK(outcome.code == 1);
  CHECK(holds(outcome.out, "ERROR   bad: "));
  CHECK(holds(outcome.out, "suite/bad.toml:2:8: "));
  CHECK(holds(outcome.out, "suite/lost.script: has no scene lost.toml beside it"));
  CHECK(holds(outcome.out, "suite/nothing.script: expects nothing"));
  CHECK(holds(outcome.out,
              "suite/sizes.script:2:1: suite/pictures/small.png has 64x48 pixels; 320x180 as in "
              "suite/pictures/rest.png are wanted"));
  CHECK(holds(outcome.out, "suite/pictures/text.png: is not a PNG file"));
  CHECK(holds(outcome.out, "7 tests: 2 ok, 5 failed"));
  CHECK(holds(slurp(suite.folder / "junit.xml"), "failures=\"0\" errors=\"5\""));
}

TEST_CASE("test --only runs the tests that it names, and knows no others") {
  const Suite suite;
  suite.folder.write("suite/late.toml", kScene);
  suite.folder.write("suite/late.script", "expect bodies == 7 at 1\n");
  const Outcome one = suite.run({"--only", "fall", "--junit", "one.xml"});
  CHECK(one.code == 0);
  CHECK(holds(one.out, "ok      fall: "));
  CHECK_FALSE(holds(one.out, "rest"));
  CHECK(holds(one.out, "1 test of 3: 1 ok, 0 failed"));
  CHECK_FALSE(fs::exists(suite.folder / "out/late"));
  CHECK(holds(slurp(suite.folder / "one.xml"), "tests=\"1\""));
  const Outcome two = suite.run({"--only", "late,fall"});
  CHECK(two.code == 1);
  CHECK(two.out.find("ok      fall") < two.out.find("FAILED  late"));
  CHECK(holds(two.out, "2 tests of 3: 1 ok, 1 failed"));
  // written anew: the picture of the test that is named and no other
  CHECK(suite.run({"--only", "fall", "--update"}).code == 0);
  CHECK_FALSE(fs::exists(suite.folder / "suite/pictures"));
  check_refused(suite.folder, {"test", "suite", "--only", "fall,reast"},
                "command line: --only names 'reast'; tests of suite: fall, late, rest", "did you mean 'rest'?");
  check_refused(suite.folder, {"test", "suite", "--only", "fall,"}, "command line: --only is 'fall,'", "without gaps");

  // names may hold commas
  for (const char* ending : {".toml", ".script"}) {
    fs::rename(suite.folder / ("suite/late" + std::string(ending)), suite.folder / ("suite/a,b" + std::string(ending)));
    fs::copy_file(suite.folder / ("suite/fall" + std::string(ending)),
                  suite.folder / ("suite/b" + std::string(ending)));
  }
  const Outcome comma = suite.run({"--only", "a\\,b"});
  CHECK(comma.code == 1);
  CHECK(holds(comma.out, "FAILED  a,b: "));
  CHECK(holds(comma.out, "1 test of 4: 0 ok, 1 failed"));
  const Outcome both = suite.run({"--only", "fall,a\\,b", "--only", "b"});
  CHECK(holds(both.out, "FAILED  a,b: "));
  CHECK(holds(both.out, "3 tests of 4: 2 ok, 1 failed"));
  check_refused(suite.folder, {"test", "suite", "--only", "a,b"},
                "command line: --only names 'a'; tests of suite: a\\,b", "--only");
}

TEST_CASE("test --jobs: what is told and written is the same, in the same order, however many run at once") {
  const Suite suite;
  REQUIRE(suite.run({"--update"}).code == 0);
  suite.folder.write("suite/rest.toml", replaced(kScene, "size = [1, 0.5, 1]", "size = [1, 0.52, 1]"));
  suite.folder.write("suite/bad.toml", "[[body]]\nname = 3\n");
  suite.folder.write("suite/bad.script", "expect contacts > 0 at 1\n");
  // the first by name ends last
  suite.folder.write("suite/a_long.toml", kScene);
  suite.folder.write("suite/a_long.script", "expect contacts > 100 from 0 to 150\n");
  const auto timeless = [](const std::string& text) {
    return std::regex_replace(text, std::regex(R"(\([0-9.]+ s\)|time="[0-9.]+"|out[0-9])"), "T");
  };
  const auto tell = [&](const char* jobs, const char* out) {
    const Outcome outcome = impinge_run(
        suite.folder.path(), {"test", "suite", "--out", out, "--jobs", jobs, "--junit", std::string(out) + ".xml"});
    CHECK(outcome.code == 1);
    CHECK(outcome.err.empty());
    return timeless(outcome.out + slurp(suite.folder / (std::string(out) + ".xml")));
  };
  const std::string one = tell("1", "out1");
  CHECK(holds(one, "4 tests: 1 ok, 3 failed"));
  CHECK(holds(one, "suite/a_long.script:1:1: frame 0: expected contacts > 100 in frames 0 to 150; found contacts = "));
  CHECK(tell("3", "out3") == one);
  for (const char* name : {"rest/report.html", "a_long/report.html", "rest/run/frames/000004.png"})
    CHECK(timeless(slurp(suite.folder / "out3" / name)) == timeless(slurp(suite.folder / "out1" / name)));
  check_refused(suite.folder, {"test", "suite", "--jobs", "0"}, "command line: --jobs is '0'", "from 1 to 4096");
}

TEST_CASE("test --jobs: a test whose process can't write ends the suite, which says so") {
  const Suite suite;
  suite.folder.write("out/fall", "a file where a folder is to be");
  for (const char* jobs : {"1", "2"}) {
    CAPTURE(jobs);
    const Outcome outcome = suite.run({"--jobs", jobs, "--junit", "junit.xml"});
    CHECK(outcome.code == 2);
    CHECK(holds(outcome.err, "out/fall"));
    CHECK_FALSE(holds(outcome.out, "rest"));
    const std::string xml = slurp(suite.folder / "junit.xml");
    CHECK(holds(xml, "<error"));
    CHECK(holds(xml, "the tests after this one were not run"));
  }
}

TEST_CASE("a suite that can't be run at all is refused") {
  const Suite suite;
  check_refused(suite.folder, {"test", "nowhere"}, "nowhere: ", "there is no such folder");
  suite.folder.write("empty/readme.txt", "");
  check_refused(suite.folder, {"test", "empty"}, "empty: ", "holds no script");
  suite.folder.write("file", "");
  check_refused(suite.folder, {"test", "suite", "--out", "file"}, "file: can't be made", "choose another --out");
  check_refused(suite.folder, {"test", "suite", "--out", "/proc/impinge"}, "/proc/impinge: can't be made",
                "choose another --out");
}

TEST_CASE("the limits tell the pictures of the project's own suite apart") {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(IMPINGE_SOURCE_DIR) / "tests/images/suite/baselines"))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  REQUIRE(files.size() >= 9);
  for (std::size_t i = 0; i < files.size(); ++i) {
    CHECK(fs::file_size(files[i]) < 100'000);
    for (std::size_t k = i + 1; k < files.size(); ++k) {
      CAPTURE(files[i], files[k]);
      CHECK_FALSE(compare(read_png(files[i]), read_png(files[k])).same);
    }
  }
}
