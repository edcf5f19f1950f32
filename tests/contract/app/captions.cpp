// Colours that bodies are given, and lines of the script below the pictures: in a run, gone on with, and exported.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>

#include "tests/support/program/debug_session.hpp"
#include "viewer/draw/body_color.hpp"
#include "viewer/image/label.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

void run_pictures(const TempFolder& folder, const std::string& out, std::vector<std::string> more) {
  std::vector<std::string> words = {"run", "s.toml", "--out", out, "--size", "640x360"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = impinge_run(folder.path(), words);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
}

std::vector<std::uint8_t> pixels(const TempFolder& folder, const std::string& out, int frame) {
  return read_png(folder.path() / out / "frames" / fmt::format("{:06}.png", frame)).rgb;
}

/// Pixels that are much greener than anything else in such a picture.
int green(const std::vector<std::uint8_t>& rgb) {
  int count = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    count += rgb[i + 1] > 3 * rgb[i] / 2 + 30 && rgb[i + 1] > 3 * rgb[i + 2] / 2 + 30;
  return count;
}

}  // namespace

TEST_CASE("a body has the colour that it is given, in pictures and in what is exported") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script", "at 2 color ball 10e010\nat 4 color ball none\n");
  run_pictures(folder, "plain", {"--frames", "5"});
  run_pictures(folder, "script", {"--frames", "5", "--script", "a.script"});
  run_pictures(folder, "set", {"--frames", "5", "--set", R"(view.colors=["ball=#10E010"])", "--export", "gltf"});
  for (const int frame : {0, 1, 4, 5}) CHECK((pixels(folder, "script", frame) == pixels(folder, "plain", frame)));
  for (const int frame : {2, 3}) CHECK((pixels(folder, "script", frame) == pixels(folder, "set", frame)));
  CHECK(green(pixels(folder, "plain", 3)) < 20);
  CHECK(green(pixels(folder, "set", 3)) > 300);
  CHECK(hash_in(folder / "script/stats.csv", 5) == hash_in(folder / "plain/stats.csv", 5));
  // as light, by the formula of sRGB: ((c / 255 + 0.055) / 1.055)^2.4 of 0x10 and 0xe0
  const std::string gltf = slurp(folder.path() / "set" / "export" / "s.glb");
  CHECK(gltf.find("\"baseColorFactor\":[0.00518,0.74540,0.00518,1]") != std::string::npos);
  // from frame 0 on: in the run's export, and in one that is made afterwards
  folder.write("start.script", "at 0 color ball 10e010\n");
  run_pictures(folder, "start", {"--frames", "1", "--script", "start.script", "--export", "gltf"});
  REQUIRE(impinge_run(folder.path(), {"export", "start", "--format", "gltf", "--out", "after"}).code == 0);
  for (const char* file : {"start/export/s.glb", "after/s.glb"})
    CHECK(slurp(folder / file).find("\"baseColorFactor\":[0.00518,0.74540,0.00518,1]") != std::string::npos);
  const Outcome wrong =
      impinge_run(folder.path(), {"run", "s.toml", "--out", "no", "--set", R"(view.colors=["bal=10e010"])"});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("'bal' for view.colors; bodies: floor, crate, ball; did you mean 'ball'?") != std::string::npos);
}

TEST_CASE("a colour is read and written back, and nothing else is one") {
  for (const char* text : {"10e010", "ffffff", "000000", "a1b2c3"}) {
    REQUIRE(read_color(text));
    CHECK(color_text(*read_color(text)) == text);
    CHECK(read_color(std::string("#") + text) == read_color(text));
  }
  for (const char* text :
       {"", "#", "fff", "#12345", "1234567", "-12345", "+12345", "0x1234", "12345g", "red", " 12345"})
    CHECK_FALSE(read_color(text));
  CHECK(given_color({"a=b=010203", "b=0a0b0c", "a=b=040506"}, "a=b") == read_color("040506"));
  CHECK_FALSE(given_color({"ball=010203"}, "bal"));
}

TEST_CASE("lines of the script stand below the pictures for as long as is asked, also when a run is gone on with") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  folder.write("a.script",
               "at 3 set contact.friction 0.4\nat 3 layer +aabbs\nfrom 6 to 8 ramp contact.friction 0.4 0.7\n"
               "at 20 set view.caption.text \"the end\"\n");
  const std::vector<std::string> with = {
      "--script", "a.script", "--set", "view.caption.lines=changes", "--set", "view.caption.time=0.1"};
  const auto run = [&](const std::string& out, std::vector<std::string> words, const char* frames) {
    words.insert(words.end(), {"--frames", frames});
    run_pictures(folder, out, words);
  };
  run("plain", {"--script", "a.script"}, "22");
  run("captions", with, "22");
  const auto differs = [&](int frame) { return pixels(folder, "plain", frame) != pixels(folder, "captions", frame); };
  // kRigid has 60 frames a second: six frames of the last line, of the ramp's that is at frame 8
  for (const int frame : {0, 2, 14, 19, 20, 22}) CHECK_FALSE(differs(frame));
  for (const int frame : {3, 5, 8, 9, 13}) CHECK(differs(frame));
  CHECK(pixels(folder, "plain", 19) != pixels(folder, "plain", 20));  // a text of one's own stands by itself
  run("resumed", with, "7");
  std::vector<std::string> on = with;
  on.emplace_back("--resume");
  run("resumed", on, "22");
  for (const int frame : {5, 9, 13, 21}) CHECK((pixels(folder, "resumed", frame) == pixels(folder, "captions", frame)));
  CHECK(hash_in(folder / "captions/stats.csv", 22) == hash_in(folder / "plain/stats.csv", 22));
}

TEST_CASE("a caption of several lines has a row for each, all of them in its box") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  const auto rows = [&](const std::string& out, const std::string& text) {
    run_pictures(folder, out, {"--frames", "0", "--set", "view.caption.text=\"" + text + "\""});
    const std::vector<std::uint8_t> with = pixels(folder, out, 0), without = pixels(folder, "plain", 0);
    std::pair<int, int> range(360, -1);  // rows that the caption changes
    for (int y = 0; y < 360; ++y)
      if (!std::equal(&with[3 * 640 * y], &with[3 * 640 * y] + 3 * 640, &without[3 * 640 * y]))
        range = {std::min(range.first, y), y};
    return range;
  };
  run_pictures(folder, "plain", {"--frames", "0"});
  constexpr int kRow = 13, kBelow = 5;  // pixels of a small picture: from a row to the next, and below the box
  const auto one = rows("one", "mgy"), three = rows("three", R"(mgy\nmgy\nmgy)"), gap = rows("gap", R"(mgy\n\nmgy\n)");
  CHECK(one.second == 359 - kBelow);
  CHECK(three.second == one.second);
  CHECK(three.first == one.first - 2 * kRow);
  CHECK(gap == three);
}

TEST_CASE("characters of a caption that there are no letters for are told of, once each") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  CHECK(missing_letters("plain ÄÖü Ωж ≤ €\n").empty());
  CHECK(missing_letters("世 and 界, 世 again").size() == 6);  // of three bytes each
  CHECK(missing_letters("\xF0\x9F\x98\x80") == "\xF0\x9F\x98\x80");
  const auto told = [&](std::vector<std::string> words) {
    const Outcome outcome = impinge_run(folder.path(), words);
    REQUIRE(outcome.code == 0);
    return outcome.out + outcome.err;
  };
  const std::string note = "view.caption.text has '世', for which there are no letters: pictures show '?'";
  CHECK(told({"check", "s.toml", "--set", "view.caption.text=\"ball 世\""}).find("warning: missing-letters: " + note) !=
        std::string::npos);
  folder.write("a.script", "at 2 set view.caption.text \"世\"\n");
  const std::vector<std::string> run = {"run", "s.toml", "--script", "a.script", "--frames", "1", "--size", "64x64"};
  const auto with = [&](std::initializer_list<std::string> more) {
    std::vector<std::string> words = run;
    words.insert(words.end(), more);
    return words;
  };
  CHECK(told(with({"--out", "a"})).find("note: " + note) != std::string::npos);
  CHECK(told(with({"--out", "b", "--no-images"})).find("letters") == std::string::npos);
}

TEST_CASE("marks are as large in a picture that stands upright as in the square on its shorter side") {
  const TempFolder folder;
  folder.write("s.toml", R"([simulation]
gravity = [0, 0, 0]
[contact]
max_push_out = 1e-9
[[body]]
name = "floor"
kind = "static"
shape = { box = { size = [4, 0.2, 4] } }
[[body]]
name = "crate"
kind = "dynamic"
shape = { box = { size = [1, 1, 1] } }
position = [0, 0.599, 0]
[view]
camera = { eye = [0, 2.5, 6], target = [0, 0.3, 0] }
)");
  const auto marked = [&](const std::string& size) {
    std::vector<std::uint8_t> with[2];
    for (const int has_marks : {0, 1}) {
      const std::string out = size + (has_marks != 0 ? "marks" : "");
      REQUIRE(impinge_run(
                  folder.path(),
                  {"run", "s.toml", "--frames", "0", "--size", size, "--out", out, "--set", "view.panel.legend=false",
                   "--set", has_marks != 0 ? "view.layers=[\"meshes\",\"contacts\"]" : "view.layers=[\"meshes\"]"})
                  .code == 0);
      with[has_marks] = pixels(folder, out, 0);
    }
    int count = 0;
    for (std::size_t i = 0; i < with[0].size(); i += 3) count += !std::equal(&with[0][i], &with[0][i] + 3, &with[1][i]);
    return count;
  };
  const int square = marked("360x360"), upright = marked("360x720"), wide = marked("720x360");
  CAPTURE(square, upright, wide);
  CHECK(square > 20);
  CHECK(upright < 1.5 * square);
  CHECK(upright > square / 1.5);
  CHECK(wide < 1.5 * square);
}
