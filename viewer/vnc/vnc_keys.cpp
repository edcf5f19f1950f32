#include "viewer/vnc/vnc_keys.hpp"

#include <algorithm>
#include <utility>

#include "viewer/panels/debug/ui.hpp"

namespace impinge {

int key_of_symbol(std::uint32_t symbol) {
  static constexpr std::pair<std::uint32_t, const char*> kKeys[] = {
      {0xff09, "tab"},       {0xff51, "left"},  {0xff53, "right"},  {0xff52, "up"},        {0xff54, "down"},
      {0xff50, "home"},      {0xff57, "end"},   {0xffff, "delete"}, {0xff08, "backspace"}, {0x0020, "space"},
      {0xff0d, "enter"},     {0xff8d, "enter"}, {0xff1b, "escape"}, {0xffbe, "f1"},        {0xff55, "page_up"},
      {0xff56, "page_down"}, {0xffe3, "ctrl"},  {0xffe4, "ctrl"},   {0xffe1, "shift"},     {0xffe2, "shift"}};
  std::string name;
  for (const auto& [code, word] : kKeys)
    if (code == symbol) name = word;
  const std::uint32_t lower = symbol >= 'A' && symbol <= 'Z' ? symbol + 32 : symbol;
  if (lower >= 'a' && lower <= 'z') name = static_cast<char>(lower);
  const auto it = std::find(key_names().begin(), key_names().end(), name);
  return it == key_names().end() ? -1 : static_cast<int>(it - key_names().begin());
}

std::string text_of_symbol(std::uint32_t symbol) {
  const bool is_latin = (symbol >= 0x20 && symbol <= 0x7e) || (symbol >= 0xa0 && symbol <= 0xff);
  const bool is_unicode = symbol >= 0x01000100 && symbol <= 0x0110ffff;
  if (!is_latin && !is_unicode) return "";
  const std::uint32_t c = is_unicode ? symbol - 0x01000000 : symbol;
  const auto byte = [](std::uint32_t bits) { return static_cast<char>(bits); };
  if (c >= 0xd800 && c <= 0xdfff) return "";
  if (c < 0x80) return {byte(c)};
  if (c < 0x800) return {byte(0xc0 | c >> 6), byte(0x80 | (c & 63))};
  if (c < 0x10000) return {byte(0xe0 | c >> 12), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63))};
  return {byte(0xf0 | c >> 18), byte(0x80 | (c >> 12 & 63)), byte(0x80 | (c >> 6 & 63)), byte(0x80 | (c & 63))};
}

}  // namespace impinge
