// What is written below a picture: lines of the script that have just taken effect, and a text of one's own.
#include <imgui.h>

#include <algorithm>

#include "viewer/panels/overlay/picture_panels.hpp"

namespace impinge {
namespace {

constexpr std::size_t kMostLines = 4;  // of the script
constexpr float kWidest = 0.56f;       // of the picture
constexpr Color kCaptionInk = hex(0xf2f4f7), kCaptionLine = hex(0xb9d7f0);

/// Cut at words, and within one that is wider alone.
std::vector<std::string> wrapped_line(const Pen& pen, const std::string& text, float width) {
  std::vector<std::string> lines;
  for (const char *at = text.c_str(), *end = at + text.size(); at < end;) {
    const char* stop = pen.font.CalcWordWrapPositionA(pen.text_size / pen.font.FontSize, at, end, width);
    stop = std::max(stop, at + 1);
    lines.emplace_back(at, stop);
    for (at = stop; at < end && *at == ' ';) ++at;
  }
  return lines;
}

/// And where the text itself ends a line; an empty one stays.
std::vector<std::string> wrapped(const Pen& pen, const std::string& text, float width) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    if (line.ends_with('\r')) line.pop_back();
    begin = end + 1;
    const std::vector<std::string> parts = wrapped_line(pen, line, width);
    lines.insert(lines.end(), parts.begin(), parts.end());
    if (parts.empty()) lines.emplace_back();
  }
  return lines;
}

}  // namespace

PanelArea draw_caption(const Pen& pen, const ViewSettings& settings, const std::vector<PanelArea>& taken) {
  struct Row {
    std::string text;
    Color color;
  };
  const float widest = kWidest * pen.picture_width - 2.0f * pen.padding();
  std::vector<Row> rows;
  const auto add = [&](const std::string& text, Color color) {
    for (std::string& line : wrapped(pen, text, widest)) rows.push_back({std::move(line), color});
  };
  const std::vector<std::string>& lines = settings.lines_shown;
  for (std::size_t i = lines.size() - std::min(lines.size(), kMostLines); i < lines.size(); ++i)
    add(lines[i], kCaptionLine);
  if (!settings.caption.empty()) add(settings.caption, kCaptionInk);
  if (rows.empty()) return {};
  PanelArea area;
  for (const Row& row : rows) area.width = std::max(area.width, pen.text_width(row.text));
  area.width += 2.0f * pen.padding();
  area.height = pen.row() * static_cast<float>(rows.size()) + 2.0f * pen.padding();
  area.x = std::max(0.0f, 0.5f * (pen.picture_width - area.width));
  area.y = pen.picture_height - pen.margin() - area.height;
  const bool meets = std::any_of(taken.begin(), taken.end(), [&](const PanelArea& t) { return panels_meet(t, area); });
  if (meets || area.y < 0.0f || area.width > pen.picture_width) return {};
  pen.sheet(area.x, area.y, area.width, area.height);
  float y = area.y + pen.padding();
  for (const Row& row : rows) {
    pen.text(area.x + 0.5f * (area.width - pen.text_width(row.text)), y, row.color, row.text);
    y += pen.row();
  }
  return area;
}

}  // namespace impinge
