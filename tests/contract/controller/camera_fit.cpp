// view.camera.fit = "all": what flies off stays in the picture, each of which depends on its own frame alone.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "tests/support/program/refusal.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

// a ball falls past a sheet for two seconds, 20 m, and another flies off to the side
const std::string kScene = R"([[body]]
name = "sheet"
kind = "static"
shape = { box = { size = [2, 0.1, 2] } }
[[body]]
name = "ball"
kind = "dynamic"
shape = { sphere = { radius = 0.5 } }
position = [1.8, 1, 0]
[[body]]
name = "shot"
kind = "dynamic"
shape = { sphere = { radius = 0.5 } }
position = [-1.8, 1, 0]
velocity = [-15, 10, 0]
[view]
backdrop = "flat"
layers = ["meshes"]
colors = ["ball=ff0000", "shot=00ff00", "sheet=808080"]
panel = { figures = false, legend = false }
)";

/// Pixels of a colour of which one channel is all there is.
int pixels_of(const Image& image, int channel) {
  int count = 0;
  for (std::size_t k = 0; k < image.rgb.size(); k += 3) {
    const int own = image.rgb[k + static_cast<std::size_t>(channel)],
              others = image.rgb[k] + image.rgb[k + 1] + image.rgb[k + 2] - own;
    count += own > 60 && others < own / 2;
  }
  return count;
}

}  // namespace

TEST_CASE("camera fit: what leaves the first view is in every picture, and a run that goes on draws the same") {
  const TempFolder folder;
  folder.write("s.toml", kScene);
  const auto run = [&](const std::string& out, int frames, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run",     "s.toml", "--out",  out, "--frames", std::to_string(frames),
                                      "--quiet", "--size", "320x180"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = impinge_run(folder.path(), words);
    INFO(outcome.err);
    CHECK(outcome.code == 0);
  };
  const auto picture = [&](const std::string& out, int frame) {
    return read_png(folder / fmt::format("{}/frames/{:06}.png", out, frame));
  };
  const std::vector<std::string> all = {"--set", "view.camera.fit=all"};
  run("start", 120, {});
  run("all", 120, all);
  CHECK(pixels_of(picture("start", 120), 0) == 0);
  CHECK(pixels_of(picture("start", 120), 1) == 0);
  for (const int frame : {0, 30, 60, 90, 120}) {
    CAPTURE(frame);
    CHECK(pixels_of(picture("all", frame), 0) > 0);
    CHECK(pixels_of(picture("all", frame), 1) > 0);
  }
  // as long as all is seen it stays where it is
  CHECK(picture("all", 0) == picture("start", 0));
  CHECK(picture("all", 120).rgb != picture("start", 120).rgb);
  // states are the same, and pictures those of a run that goes on, from a snapshot and run.toml's own camera
  run("parts", 50, all);
  std::vector<std::string> on = all;
  on.emplace_back("--resume");
  run("parts", 120, on);
  for (const int frame : {0, 50, 51, 120}) CHECK(picture("parts", frame) == picture("all", frame));
  REQUIRE(impinge_run(folder.path(), {"run", "all/run.toml", "--out", "again", "--quiet", "--size", "320x180"}).code ==
          0);
  for (const int frame : {0, 51, 120}) CHECK(picture("again", frame) == picture("all", frame));
  // the debugger shows the same frame from the same place, however it comes there
  folder.write("a.script", "step 120\nshot a.png\nseek 10\nseek 120\nshot b.png\n");
  CHECK(impinge_run(folder.path(), {"debug", "s.toml", "--headless", "--script", "a.script", "--out", "dbg", "--set",
                                    "view.camera.fit=all", "--size", "960x600"})
            .code == 0);
  const Image a = read_png(folder / "dbg/a.png");
  CHECK(pixels_of(a, 0) > 0);
  CHECK(pixels_of(a, 1) > 0);
  check_refused(folder, {"run", "s.toml", "--out", "no", "--set", "view.camera.fit=al"},
                "--set view.camera.fit=al: ", "did you mean 'all'?");
}
