#include "engine/core/utf8.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Bytes of the well-formed sequence at the start of `text`, 0 where there is none (Unicode 15, table 3-7).
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0), second = byte(1);
  const auto follows = [&](std::size_t i) { return i < text.size() && is_continuation(text[i]); };
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  if (first < 0xE0) return follows(1) ? 2 : 0;
  if (first < 0xF0) {
    const bool good = second >= (first == 0xE0 ? 0xA0u : 0x80u) && second <= (first == 0xED ? 0x9Fu : 0xBFu);
    return good && follows(2) ? 3 : 0;
  }
  const bool good = second >= (first == 0xF0 ? 0x90u : 0x80u) && second <= (first == 0xF4 ? 0x8Fu : 0xBFu);
  return good && follows(2) && follows(3) ? 4 : 0;
}

}  // namespace

std::string_view without_byte_order_mark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

std::size_t find_invalid_utf8(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    std::uint64_t eight = 0;  // almost all text is ASCII: eight bytes at a time
    if (i + 8 <= text.size()) {
      std::memcpy(&eight, text.data() + i, 8);
      if ((eight & 0x8080808080808080u) == 0) {
        i += 8;
        continue;
      }
    }
    const std::size_t length = sequence_length(text.substr(i));
    if (length == 0) return i;
    i += length;
  }
  return std::string_view::npos;
}

std::string readable_utf8(std::string_view text) {
  std::string out;
  for (;;) {
    const std::size_t bad = find_invalid_utf8(text);
    out += text.substr(0, bad);
    if (bad == std::string_view::npos) return out;
    out += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[bad]));
    text.remove_prefix(bad + 1);
  }
}

std::size_t count_characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::string shortened(std::string_view text, std::size_t most) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!is_continuation(text[i]) && ++characters > most) return std::string(text.substr(0, i)) + "...";
  return std::string(text);
}

void check_utf8(const std::string& name, std::string_view text) {
  const std::size_t bad = find_invalid_utf8(text);
  if (bad == std::string_view::npos) return;
  const std::string_view before = text.substr(0, bad);
  const std::size_t begin = before.rfind('\n') + 1;  // npos + 1 is 0
  std::string_view line = before.substr(begin);
  if (begin == 0) line = without_byte_order_mark(line);
  throw InputError(fmt::format(
      "{}:{}:{}: byte 0x{:02X} is not UTF-8; text in UTF-8 is wanted; save it as UTF-8 (it may be Latin-1 or UTF-16)",
      name, 1 + std::count(before.begin(), before.end(), '\n'), count_characters(line) + 1,
      static_cast<unsigned char>(text[bad])));
}

void check_utf8_name(std::string_view path) {
  if (find_invalid_utf8(path) == std::string_view::npos) return;
  throw InputError(fmt::format(
      "{}: this name is not UTF-8; files and folders whose names are UTF-8 are taken, since what is written "
      "names them; rename it",
      readable_utf8(path)));
}

}  // namespace impinge
