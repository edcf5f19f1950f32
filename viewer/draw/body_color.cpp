#include "viewer/draw/body_color.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace impinge {

std::optional<Color> read_color(std::string_view text) {
  constexpr std::size_t kDigits = 6;
  std::uint32_t rgb = 0;
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != kDigits) return std::nullopt;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, rgb, 16);
  if (error != std::errc() || stop != end) return std::nullopt;
  return hex(rgb);
}

std::string color_text(Color color) {
  const auto of_255 = [](float share) { return std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)); };
  return fmt::format("{:02x}{:02x}{:02x}", of_255(color.r), of_255(color.g), of_255(color.b));
}

std::string_view name_in(std::string_view entry) { return entry.substr(0, entry.rfind('=')); }

std::optional<Color> color_in(std::string_view entry) {
  const std::size_t sign = entry.rfind('=');
  return sign == std::string_view::npos ? std::nullopt : read_color(entry.substr(sign + 1));
}

void give_color(std::vector<std::string>& entries, const std::vector<std::string>& bodies, std::optional<Color> color) {
  for (const std::string& body : bodies) {
    std::erase_if(entries, [&](const std::string& entry) { return name_in(entry) == body; });
    if (color) entries.push_back(body + "=" + color_text(*color));
  }
}

std::optional<Color> given_color(const std::vector<std::string>& entries, std::string_view body) {
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
    if (name_in(*entry) == body) return color_in(*entry);
  return std::nullopt;
}

}  // namespace impinge
