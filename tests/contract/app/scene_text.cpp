// Text and names that come in: encoding, depth and length, refused before anything is written, by every way in.
#include <catch2/catch.hpp>

#include "tests/support/geometry/mesh_text.hpp"
#include "tests/support/program/refusal.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"([[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.5 } }
)";
const std::string kBadName =
    "b\xFF\xFE"
    "d";
const std::vector<std::string> kRun = {"run", "s.toml", "--out", "out", "--frames", "2", "--no-images"};

std::vector<std::string> run_with(const std::vector<std::string>& more) {
  std::vector<std::string> words = kRun;
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("text that is not UTF-8 is refused by every way in, with its place") {
  const TempFolder folder;
  const std::string scene = kScene;
  // a name in Latin-1, in a literal text, in a file large enough to read far beyond its end
  std::string large = scene;
  while (large.size() < 200'000) large += "# a remark, and more of it so that the file grows\n";
  folder.write("s.toml",
               "# K\xC3\xA4"
               "fer\n" +
                   replaced(large, "\"ball\"",
                            "'K\xE4"
                            "fer'"));
  check_refused(folder, kRun, "s.toml:3:10: ", "byte 0xE4 is not UTF-8");
  check_refused(folder, {"check", "s.toml"}, "s.toml:3:10: ", "byte 0xE4 is not UTF-8");
  folder.write("s.toml", "[[body]]\nname = '\xD8'\xD8\n");
  check_refused(folder, {"info", "s.toml"}, "s.toml:2:9: ", "byte 0xD8 is not UTF-8");

  folder.write("s.toml", scene);
  check_refused(folder, run_with({"--set", "body.ball.surface='\xD8'"}), "command line: ", "\\xD8'' is not UTF-8");
  folder.write("a.script", "at 1 set contact.friction 0.5\n# M\xC3\xA4rz, M\xE4rz\n");
  check_refused(folder, run_with({"--script", "a.script"}), "a.script:2:10: ", "byte 0xE4 is not UTF-8");
  folder.write("w.toml", "[sweep]\nscene = 's.toml'\nvary = ['contact.friction=0.1,\xE4']\n");
  check_refused(folder, {"sweep", "w.toml", "--out", "out"}, "w.toml:3:31: ", "byte 0xE4 is not UTF-8");

  REQUIRE(impinge_run(folder.path(), kRun).code == 0);
  const std::string record = slurp(folder / "out/run.toml");
  folder.write("out/run.toml", "# \xE4\n" + record);
  check_refused(folder, {"replay", "out"}, "out/run.toml:1:3: ", "byte 0xE4 is not UTF-8");
  folder.write("out/run.toml", record);
  CHECK(impinge_run(folder.path(), {"replay", "out"}).code == 0);
}

TEST_CASE("keys and heads of many parts are refused by their depth") {
  const TempFolder folder;
  const auto parts = [](int count) {
    std::string text = "a";
    while (--count > 0) text += ".a";
    return text;
  };
  for (const int count : {65, 12'000, 20'000}) {
    folder.write("s.toml", parts(count) + " = 1\n");
    check_refused(folder, {"check", "s.toml"}, "s.toml:1:128: ", "nested deeper than 64");
    folder.write("s.toml", "[" + parts(count) + "]\n");
    check_refused(folder, {"check", "s.toml"}, "s.toml:1:129: ", "nested deeper than 64");
  }
}

TEST_CASE("names of bodies are of a length that names of files can have") {
  const TempFolder folder;
  const auto scene = [&](std::size_t letters) {
    folder.write("s.toml", replaced(kScene, "ball", std::string(letters, 'n')));
  };
  scene(129);
  check_refused(folder, kRun, "s.toml:2:8: ", "a body's name of 129 letters; at most 128 are allowed");
  scene(5000);
  check_refused(folder, run_with({"--export", "ply"}), "s.toml:2:8: ", "at most 128 are allowed");
  folder.write("s.toml", replaced(kScene, "ball", std::string(5000, ' ')));
  check_refused(folder, kRun, "s.toml:2:8: ", "...\" as a body's name");
  folder.write("s.toml", std::string(kScene) + "[[attachment]]\nname = \"" + std::string(200, 'n') +
                             "\"\nbody_a = \"ball\"\npoint = [0, 0, 0]\n");
  check_refused(folder, kRun, "s.toml:6:8: ", "an attachment's name of 200 letters");
  scene(128);
  CHECK(impinge_run(folder.path(), run_with({"--export", "ply"})).code == 0);
  CHECK(fs::exists(folder / ("out/surfaces/000002/" + std::string(128, 'n') + ".ply")));
}

TEST_CASE("a mistaken name among many is answered by a message that can be read") {
  const TempFolder folder;
  std::string scene;
  for (int i = 0; i < 500; ++i) scene += replaced(kScene, "ball", "ball_" + std::to_string(i));
  folder.write("s.toml", scene);
  const Outcome outcome = impinge_run(folder.path(), run_with({"--set", "body.bal_499.mass=2"}));
  CHECK(outcome.code == 2);
  CHECK(outcome.err.size() < 1000);
  CHECK(outcome.err.find("and 480 more; did you mean 'ball_499'?") != std::string::npos);
}

TEST_CASE("files that say they are empty and are not do not pass for empty scenes") {
  const TempFolder folder;
  for (const char* file : {"/proc/cpuinfo", "/proc/self/mem", "/proc/self/status"})
    check_refused(folder, {"check", file}, std::string(file) + ": ", "");
  folder.write("s.toml", kScene);
  check_refused(folder, run_with({"--script", "/proc/cpuinfo"}), "/proc/cpuinfo: ", "says that it is empty and is not");
  folder.write("empty.toml", "");
  CHECK(impinge_run(folder.path(), {"check", "empty.toml"}).code == 0);
}

TEST_CASE("folders and files whose names are not UTF-8 are refused before frame 0") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  folder.write(kBadName + "/s.toml", kScene);
  folder.write(kBadName + "/a.script", "at 1 set contact.friction 0.5\n");
  folder.write(kBadName + "/w.toml", "[sweep]\nscene = 's.toml'\nvary = ['contact.friction=0.1,0.2']\n");
  folder.write("a.script", "at 1 set contact.friction 0.5\n");
  folder.write("bad\xFF.script", "at 1 set contact.friction 0.5\n");
  const std::string shown = "b\\xFF\\xFEd";
  const std::string from = fs::canonical(folder.path()).string() + "/" + shown;
  const auto refused = [&](const std::vector<std::string>& words) {
    check_refused(folder, words, "command line: ", "is not UTF-8");
  };
  // named on the command line
  refused({"run", kBadName + "/s.toml", "--out", "out", "--no-images"});
  refused({"run", "s.toml", "--out", kBadName + "/out", "--no-images"});
  refused({"run", "s.toml", "--out", "out", "--no-images", "--script", "bad\xFF.script"});
  refused({"sweep", kBadName + "/s.toml", "--vary", "contact.friction=0.1,0.2", "--out", "out"});
  refused({"debug", "s.toml", "--headless", "--script", "a.script", "--record", "r\xFF.script"});
  refused({"diff", kBadName, kBadName, "--out", "out"});
  refused({"test", ".", "--junit", "j\xFF.xml"});

  // standing in one
  const auto refused_inside = [&](std::vector<std::string> words) {
    const auto before = listing(folder.path());
    const Outcome outcome = impinge_run(folder / kBadName, words);
    INFO(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(outcome.error_lines() == 1);
    CHECK(outcome.err.find(shown) != std::string::npos);
    CHECK(outcome.err.find("is not UTF-8") != std::string::npos);
    CHECK(listing(folder.path()) == before);
  };
  refused_inside(kRun);
  refused_inside({"check", "s.toml"});
  refused_inside({"sweep", "s.toml", "--vary", "contact.friction=0.1,0.2", "--no-images", "--out", "out"});
  refused_inside({"sweep", "w.toml", "--out", "out"});
  refused_inside({"debug", "s.toml", "--headless", "--script", "a.script", "--record", "r.script"});
  refused_inside({"test", ".", "--junit", "j.xml"});
}

TEST_CASE("pictures and tests whose names are not UTF-8 are refused before a report is begun") {
  const TempFolder folder;
  folder.write("tests/one.toml", kScene);
  folder.write("tests/one.script", "expect contacts == 0 at 1\n");
  REQUIRE(
      impinge_run(folder.path(), {"run", "tests/one.toml", "--out", "a", "--frames", "1", "--size", "32x32"}).code ==
      0);
  fs::create_directories(folder / "b/frames");
  fs::copy(folder / "a/frames/000001.png", folder / "b/frames/\xE4.png");
  check_refused(folder, {"diff", "a/frames", "b/frames", "--out", "report"}, "b/frames/\\xE4.png: ", "is not UTF-8");
  folder.write("tests/tw\xF6.script", "expect contacts == 0 at 1\n");
  check_refused(folder, {"test", "tests", "--junit", "j.xml", "--out", "t"}, "tests/tw\\xF6.script: ", "is not UTF-8");
}
