// impinge diff, test and compare where the disk is full: one clear message, nothing half written, and the same words
// work once there is room.
#include <catch2/catch.hpp>

#include "tests/support/pictures/picture_scene.hpp"
#include "tests/support/program/small_disk.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

namespace fs = std::filesystem;

const std::string kScene = std::string(kCrateOnSlab) + R"(position = [0, 1, 0]
)" + kFrontView;

/// A folder with the scene and two runs of it that part, and in it a disk that the sizes say.
struct Files {
  TempFolder folder;
  Files() {
    folder.write("s.toml", kScene);
    run({"run", "s.toml", "--out", "a", "--frames", "12", "--size", "320x180", "--ids", "--quiet"}, 0);
    run({"run", "s.toml", "--out", "b", "--frames", "12", "--size", "320x180", "--ids", "--quiet", "--set",
         "simulation.gravity=[0,-30,0]"},
        0);
  }
  Outcome run(const std::vector<std::string>& words, int code) const {
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.code == code);
    return outcome;
  }
  /// Refused for want of room, with one line; returns it all.
  Outcome refused(const std::vector<std::string>& words) const {
    const Outcome outcome = run(words, 2);
    INFO(outcome.err);
    CHECK(outcome.error_lines() == 1);
    CHECK(outcome.err.rfind("disk/", 0) == 0);
    CHECK(outcome.err.find("No space left on device); free space or choose another --out") != std::string::npos);
    for (const std::string& name : listing(folder / "disk")) CHECK_FALSE(fs::path(name).extension() == ".tmp");
    return outcome;
  }
  std::vector<std::string> on_disk() const { return listing(folder / "disk"); }
};

bool can_mount(const SmallDisk& disk) {
  if (!disk.is_mounted()) WARN("skipped: no small file system can be mounted here (it takes root)");
  return disk.is_mounted();
}

}  // namespace

TEST_CASE("a diff onto a full disk leaves no part of its report") {
  const Files files;
  const SmallDisk disk(files.folder / "disk", "64k");
  if (!can_mount(disk)) return;
  const std::vector<std::string> words = {"diff", "a", "b", "--out", "disk/shown"};
  CHECK(files.refused(words).out.empty());
  CHECK(files.on_disk().empty());
  REQUIRE(disk.resize("16m"));
  files.run(words, 1);
  CHECK(fs::exists(files.folder / "disk/shown/report.html"));
}

TEST_CASE("baselines on a full disk are old or new, each with its own ids, and --update goes on when there is room") {
  const Files files;
  const SmallDisk disk(files.folder / "disk", "1m");
  if (!can_mount(disk)) return;
  files.run({"diff", "disk/kept", "a", "--update"}, 0);
  REQUIRE(fs::exists(files.folder / "disk/kept/ids/000009.png"));
  std::uintmax_t used = 0;
  for (const std::string& name : files.on_disk())
    if (fs::is_regular_file(name)) used += (fs::file_size(name) + 4095) / 4096 * 4;
  REQUIRE(disk.resize(std::to_string(used + 4) + "k"));  // room for one page more, not for two files at once
  files.refused({"diff", "disk/kept", "b", "--update"});
  for (int frame = 0; frame <= 12; ++frame) {
    const std::string name = fmt::format("{:06}.png", frame);
    const std::string now = slurp(files.folder / ("disk/kept/" + name));
    CAPTURE(name);
    CHECK((now == slurp(files.folder / ("a/frames/" + name)) || now == slurp(files.folder / ("b/frames/" + name))));
  }
  REQUIRE(disk.resize("2m"));
  files.run({"diff", "disk/kept", "b", "--update"}, 0);
  files.run({"diff", "disk/kept", "b"}, 0);
  CHECK(slurp(files.folder / "disk/kept/ids/000009.png") == slurp(files.folder / "b/ids/000009.png"));
}

TEST_CASE("a comparison of runs onto a full disk tells what it found, and leaves nothing") {
  const Files files;
  const SmallDisk disk(files.folder / "disk", "24k");
  if (!can_mount(disk)) return;
  const std::vector<std::string> words = {"compare", "a", "b", "--out", "disk/apart"};
  const Outcome full = files.refused(words);
  CHECK(full.out.find("the first that differs is frame 1 of 13") != std::string::npos);
  CHECK(full.out.find("figures:") == std::string::npos);
  CHECK(files.on_disk().empty());
  REQUIRE(disk.resize("16m"));
  CHECK(files.run(words, 1).out.find("sheet:  disk/apart/sheet.png") != std::string::npos);
}

TEST_CASE("a suite of tests on a full disk ends at once, and its XML tells so") {
  const Files files;
  for (const char* name : {"one", "two"}) {
    files.folder.write(fmt::format("suite/{}.toml", name), kScene);
    files.folder.write(fmt::format("suite/{}.script", name),
                       "expect contacts == 0 at 4\nexpect image pictures/x.png at 4\n");
  }
  files.run({"test", "suite", "--out", "out", "--update"}, 0);
  const SmallDisk disk(files.folder / "disk", "24k");
  if (!can_mount(disk)) return;
  const std::vector<std::string> words = {"test", "suite", "--out", "disk/out", "--junit", "junit.xml"};
  CHECK(files.refused(words).out.empty());
  const std::string xml = slurp(files.folder / "junit.xml");
  CHECK(xml.find("tests=\"1\" failures=\"0\" errors=\"1\"") != std::string::npos);
  CHECK(xml.find("the tests after this one were not run") != std::string::npos);
  // no room for the XML either, or hardly any: none is left that could pass for a good one
  std::vector<std::string> both = words;
  both.back() = "disk/junit.xml";
  files.refused(both);
  if (fs::exists(files.folder / "disk/junit.xml"))
    CHECK(slurp(files.folder / "disk/junit.xml").find("the tests after this one were not run") != std::string::npos);
  REQUIRE(disk.resize("16m"));
  CHECK(files.run(words, 0).out.find("2 tests: 2 ok, 0 failed") != std::string::npos);
}
