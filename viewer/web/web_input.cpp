#include "viewer/web/web_input.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/core/utf8.hpp"

namespace impinge {
namespace {

constexpr float kMostWheel = 100.0f;
constexpr std::size_t kMostText = 64;  // bytes typed at once

std::string_view next_word(std::string_view& rest) {
  const std::size_t end = rest.find(' ');
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
  return word;
}

std::optional<float> number(std::string_view text, float low, float high) {
  float value = 0.0f;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return std::clamp(value, low, high);
}

std::optional<int> place_in(const std::vector<std::string>& names, std::string_view name) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return std::nullopt;
  return static_cast<int>(it - names.begin());
}

bool can_be_typed(std::string_view text) {
  return !text.empty() && text.size() <= kMostText && find_invalid_utf8(text) == text.npos &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) >= ' ' && c != 0x7f; });
}

}  // namespace

std::optional<UiEvent> parse_web_event(std::string_view line, int width, int height) {
  std::string_view rest = line;
  const std::string_view verb = next_word(rest);
  UiEvent event;
  if (verb == "type") {
    if (!can_be_typed(rest)) return std::nullopt;
    event.kind = UiEvent::type, event.text = rest;
    return event;
  }
  const std::string_view first = next_word(rest);
  std::optional<int> code = 0;
  if (verb == "move") {
    const std::optional<float> x = number(first, 0.0f, static_cast<float>(width - 1)),
                               y = number(next_word(rest), 0.0f, static_cast<float>(height - 1));
    if (!x || !y) return std::nullopt;
    event.kind = UiEvent::move, event.x = *x, event.y = *y;
  } else if (verb == "wheel") {
    const std::optional<float> y = number(first, -kMostWheel, kMostWheel);
    if (!y) return std::nullopt;
    event.kind = UiEvent::wheel, event.y = *y;
  } else if (verb == "press" || verb == "release") {
    event.kind = verb == "press" ? UiEvent::press : UiEvent::release;
    code = place_in(button_names(), first);
  } else if (verb == "down" || verb == "up") {
    event.kind = verb == "down" ? UiEvent::key_down : UiEvent::key_up;
    code = place_in(key_names(), first);
  } else {
    return std::nullopt;
  }
  if (!code || !rest.empty()) return std::nullopt;
  event.code = *code;
  return event;
}

}  // namespace impinge
