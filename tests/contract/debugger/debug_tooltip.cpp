// A tooltip goes with a click, until the pointer moves on; and a recording draws the same, though it has no clicks.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/support/program/debug_session.hpp"
#include "viewer/image/png.hpp"

using namespace impinge;
using namespace impinge::test;

namespace {

/// Rows of the picture, from the first to the last, in which two of the same size differ; -1 for none.
std::pair<int, int> differing_rows(const Image& a, const Image& b) {
  REQUIRE((a.width == b.width && a.height == b.height));
  int first = -1, last = -1;
  for (int y = 0; y < a.height; ++y) {
    if (std::equal(a.pixel(0, y), a.pixel(0, y) + 3 * a.width, b.pixel(0, y))) continue;
    last = y;
    if (first < 0) first = y;
  }
  return {first, last};
}

}  // namespace

TEST_CASE("what was clicked has no tooltip until the pointer moves, in a session and in its recording") {
  const TempFolder folder;
  folder.write("s.toml", kRigid);
  // the pointer's place is what the first recording says
  folder.write("a.script", "ui click transport/step\nshot clicked.png\n");
  REQUIRE(debug(folder, "s.toml", "a.script", {"--out", "out", "--record", "rec.script"}).code == 0);
  const std::string recording = slurp(folder / "rec.script");
  INFO(recording);
  int x = -1, y = -1;
  const std::size_t at = recording.find("ui move ");
  REQUIRE(at != std::string::npos);
  REQUIRE(std::sscanf(recording.c_str() + at, "ui move %d %d", &x, &y) == 2);
  CHECK(recording.find(fmt::format("ui move {} {} clicked\n", x, y)) != std::string::npos);

  // moved there without a click, and away from it
  folder.write("b.script",
               fmt::format("step\nui move {0} {1}\nshot hovered.png\nui move {0} {1} clicked\nshot hushed.png\n"
                           "ui move {2} {1}\nshot moved.png\nui move 480 200\nshot away.png\n",
                           x, y, x + 1));
  REQUIRE(debug(folder, "s.toml", "b.script", {"--out", "out"}).code == 0);
  const auto picture = [&](const std::string& name) { return read_png(folder / ("out/" + name)); };
  // all but the console, which says what was done: left of it
  const auto left = [&](const std::string& name) {
    const Image whole = picture(name);
    Image part(whole.width / 2, whole.height);
    for (int row = 0; row < part.height; ++row) std::copy_n(whole.pixel(0, row), 3 * part.width, part.pixel(0, row));
    return part;
  };
  const Image clicked = left("clicked.png"), hovered = left("hovered.png"), away = left("away.png");
  CHECK(clicked == left("hushed.png"));
  // without it only the button is another, a line of the window high; with it more is
  const auto [top, bottom] = differing_rows(clicked, away);
  CHECK((top >= 0 && top <= y && bottom >= y && bottom - top < 26));
  const auto [above, below] = differing_rows(hovered, away);
  CHECK(below - above > 40);
  CHECK(left("moved.png") == hovered);

  // the recording makes the same picture, to the byte, and the same recording
  REQUIRE(debug(folder, "s.toml", "rec.script", {"--out", "again", "--record", "rec2.script"}).code == 0);
  CHECK(slurp(folder / "again/clicked.png") == slurp(folder / "out/clicked.png"));
  const auto lines = [](const std::string& text) { return text.substr(text.find('\n')); };
  CHECK(lines(slurp(folder / "rec2.script")) == lines(recording));
  folder.write("c.script", "ui move 3 4 pressed\n");
  CHECK(debug(folder, "s.toml", "c.script").err.rfind("c.script:1:13: ", 0) == 0);
}
