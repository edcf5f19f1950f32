#include "engine/core/utf8.hpp"

#include <catch2/catch.hpp>

#include "engine/core/error.hpp"

using namespace impinge;

namespace {

std::string encoded(char32_t c) {
  const auto byte = [](char32_t b) { return static_cast<char>(static_cast<unsigned char>(b)); };
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xC0 | c >> 6), byte(0x80 | (c & 0x3F))};
  if (c < 0x10000) return {byte(0xE0 | c >> 12), byte(0x80 | (c >> 6 & 0x3F)), byte(0x80 | (c & 0x3F))};
  return {byte(0xF0 | c >> 18), byte(0x80 | (c >> 12 & 0x3F)), byte(0x80 | (c >> 6 & 0x3F)), byte(0x80 | (c & 0x3F))};
}

bool is_utf8(std::string_view text) { return find_invalid_utf8(text) == std::string_view::npos; }

}  // namespace

TEST_CASE("every character is UTF-8 when encoded, and nothing else is") {
  for (char32_t c = 0; c <= 0x10FFFF; ++c)
    if (is_utf8(encoded(c)) != (c < 0xD800 || c > 0xDFFF)) FAIL("U+" << std::hex << static_cast<unsigned>(c));
  CHECK_FALSE(is_utf8(encoded(0x110000)));

  // all texts of 1, 2 and 3 bytes: there are as many as characters of such lengths can be put together
  const std::int64_t one = 128, two = 0x800 - 0x80, three = 0x10000 - 0x800 - 0x800;  // without the surrogates
  std::int64_t found[4] = {};
  for (int length = 1; length <= 3; ++length)
    for (std::uint32_t bytes = 0; bytes < 1u << 8 * length; ++bytes) {
      const char text[3] = {static_cast<char>(bytes), static_cast<char>(bytes >> 8), static_cast<char>(bytes >> 16)};
      found[length] += is_utf8({text, static_cast<std::size_t>(length)});
    }
  CHECK(found[1] == one);
  CHECK(found[2] == one * one + two);
  CHECK(found[3] == one * one * one + 2 * one * two + three);

  // of 4 bytes, with all that can and some that can't follow the first
  std::int64_t of_four = 0;
  for (int first = 0xF0; first <= 0xFF; ++first)
    for (int second = 0x7D; second <= 0xC2; ++second)
      for (int third = 0x7D; third <= 0xC2; ++third)
        for (int fourth = 0x7D; fourth <= 0xC2; ++fourth) {
          const char text[4] = {static_cast<char>(first), static_cast<char>(second), static_cast<char>(third),
                                static_cast<char>(fourth)};
          of_four += is_utf8({text, 4});
        }
  CHECK(of_four == 0x100000);
}

TEST_CASE("the first byte that is no UTF-8 is found wherever it stands") {
  const std::string fill = "0123456789abcde\xC3\xA4";
  for (std::size_t before = 0; before < 40; ++before)
    for (std::size_t after = 0; after < 20; ++after) {
      std::string text;
      while (text.size() < before) text += fill;
      const std::size_t bad = text.size();
      text += '\xE4';
      text += std::string(after, 'x');
      CHECK(find_invalid_utf8(text) == bad);
    }
  CHECK(find_invalid_utf8("ab\xC3") == 2);  // cut off
  CHECK(find_invalid_utf8("a\xF0\x9F\x98\x80z\xFF") == 6);
  CHECK(readable_utf8("K\xE4"
                      "fer \xC3\xA4") ==
        "K\\xE4"
        "fer \xC3\xA4");
  CHECK(count_characters("K\xC3\xA4"
                         "fer") == 5);
  CHECK(shortened("K\xC3\xA4"
                  "fer",
                  2) == "K\xC3\xA4...");
  CHECK(shortened("K\xC3\xA4"
                  "fer",
                  5) ==
        "K\xC3\xA4"
        "fer");
}

TEST_CASE("what is refused is located by line and character") {
  const auto place = [](const std::string& text) -> std::string {
    try {
      check_utf8("f", text);
      return "";
    } catch (const InputError& error) {
      return std::string(error.what()).substr(0, std::string(error.what()).find(": "));
    }
  };
  CHECK(place("all\ngood \xC3\xA4\n") == "");
  CHECK(place("\xFF\xFE") == "f:1:1");
  CHECK(place("one\n\xC3\xA4\xC3\xA4 \xE4\n") == "f:2:4");
  CHECK(place("\xEF\xBB\xBF"
              "ab\xE4") == "f:1:3");  // the mark at the start is no column
  CHECK(place("a\n\nb\xC3") == "f:3:2");
}
