// What browsers may say: the lines that our page sends and no others, numbers within the window.
#include <catch2/catch.hpp>

#include <random>

#include "viewer/web/web_input.hpp"

using namespace impinge;

TEST_CASE("a browser's lines are events") {
  const auto event = [](std::string_view line) { return parse_web_event(line, 960, 600); };
  const auto move = event("move 12.5 599");
  REQUIRE(move);
  CHECK((move->kind == UiEvent::move && move->x == 12.5f && move->y == 599.0f));
  const auto outside = event("move -30 1e6");  // dragged out of the window
  REQUIRE(outside);
  CHECK((outside->x == 0.0f && outside->y == 599.0f));
  const auto press = event("press middle");
  REQUIRE(press);
  CHECK((press->kind == UiEvent::press && button_names().at(static_cast<std::size_t>(press->code)) == "middle"));
  const auto key = event("up page_down");
  REQUIRE(key);
  CHECK((key->kind == UiEvent::key_up && key_names().at(static_cast<std::size_t>(key->code)) == "page_down"));
  const auto blank = event("type  ");
  REQUIRE(blank);
  CHECK(blank->text == " ");
  const auto text = event("type \u00e9");
  REQUIRE(text);
  CHECK(text->text == "\u00e9");
  const auto wheel = event("wheel -1e9");
  REQUIRE(wheel);
  CHECK(wheel->y == -100.0f);
}

TEST_CASE("anything else is no event") {
  for (const std::string_view line :
       {"",           " ",           "move",  "move 1",       "move 1 2 3", "move nan 1", "move 1 inf",
        "move 1,5 2", "move 0x10 2", "press", "press fourth", "press 0",    "down",       "down q",
        "wheel",      "wheel up",    "type",  "type ",        "type \x01",  "type \n",    "type \xff",
        "seen it",    "MOVE 1 2",    "quit",  "password x"})
    CHECK_FALSE(parse_web_event(line, 960, 600));
  CHECK_FALSE(parse_web_event("type " + std::string(65, 'a'), 960, 600));
  std::mt19937 random(7);
  for (int k = 0; k < 100'000; ++k) {  // whatever comes, numbers stay within the window
    std::string line = k % 2 == 0 ? "move " : "";
    for (unsigned n = random() % 24; n > 0; --n)
      line += k % 2 == 0 ? "0123456789.e+- "[random() % 15] : static_cast<char>(random());
    if (const auto event = parse_web_event(line, 960, 600))
      CHECK((event->x >= 0.0f && event->x < 960.0f && event->y > -101.0f && event->y < 600.0f));
  }
}
