#include "viewer/panels/overlay/plot.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "viewer/gl/packed_color.hpp"

namespace impinge {
namespace {

constexpr Color kPlotInk = hex(0x20242a), kGrid = hex(0xdfe3e8), kPlotPaper = hex(0xffffff), kFront = hex(0x8a939c);
constexpr std::array<Color, 7> kColors = {hex(0x0072b2), hex(0xd55e00), hex(0x009e73), hex(0xcc79a7),
                                          hex(0x56b4e9), hex(0xe69f00), hex(0x000000)};
constexpr int kMarks = 4;                          // circle, square, triangle, diamond
constexpr double kLowest = 1e-18, kHighest = 1e6;  // y beyond these is drawn at the edge
constexpr double kZeroShift = 0.3;                 // decades left of 1 where a count of 0 stands
constexpr std::size_t kLegendLetters = 24;         // of a line of its note
constexpr int kMarkEvery = 26;                     // pixels between marks of one line

/// One axis: decades, and where they are on the picture.
struct Axis {
  double low = 0.0, high = 1.0;  // log10
  float from = 0.0f, to = 0.0f;  // pixels
  float at(double decade) const { return from + (to - from) * static_cast<float>((decade - low) / (high - low)); }
};

class Painter {
 public:
  Painter(const Pen& pen, const Plot& plot) : pen_(pen), plot_(plot), u_(pen.unit) {}

  void draw() {
    pen_.list.AddRectFilled({0, 0}, {pen_.picture_width, pen_.picture_height}, packed(kPlotPaper));
    find_ranges();
    const float legend = legend_width(), margin = 14.0f * u_;
    x_.from = margin + 7.0f * letter(), x_.to = pen_.picture_width - legend - 2.0f * margin;
    y_.from = pen_.picture_height - margin - 3.2f * pen_.text_size, y_.to = margin + 3.4f * pen_.text_size;
    pen_.text(margin, margin * 0.8f, kPlotInk, plot_.title);
    pen_.text(margin, margin * 0.8f + 1.5f * pen_.text_size, kPlotInk, plot_.y_label);
    pen_.text(0.5f * (x_.from + x_.to - pen_.text_width(plot_.x_label)), pen_.picture_height - margin - pen_.text_size,
              kPlotInk, plot_.x_label);
    draw_grid();
    pen_.list.PushClipRect({x_.from - 5.0f * u_, y_.to - 5.0f * u_}, {x_.to + 5.0f * u_, y_.from + 5.0f * u_});
    draw_front();
    for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_series(i);
    draw_rings();
    for (const Vec2& p : plot_.doubtful)
      if (is_drawn(p)) draw_cross(place(p));
    pen_.list.PopClipRect();
    draw_legend(x_.to + margin, y_.to);
  }

 private:
  float letter() const { return pen_.text_width("0"); }
  double decade_x(double x) const {
    return plot_.x_linear ? x : plot_.x_counts && x == 0.0 ? -kZeroShift : std::log10(x);
  }
  static double decade_y(double y) { return std::log10(std::clamp(y, kLowest, kHighest)); }
  bool is_drawn(const Vec2& p) const {
    return std::isfinite(p.x()) && !std::isnan(p.y()) && p.y() >= 0.0 &&
           (p.x() > 0.0 || ((plot_.x_counts || plot_.x_linear) && p.x() == 0.0));
  }

  void find_ranges() {
    double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
    for (const PlotSeries& s : plot_.series)
      for (const Vec2& p : s.points) {
        if (!is_drawn(p)) continue;
        x0 = std::min(x0, decade_x(p.x())), x1 = std::max(x1, decade_x(p.x()));
        y0 = std::min(y0, decade_y(p.y())), y1 = std::max(y1, decade_y(p.y()));
      }
    if (x0 > x1) x0 = 0.0, x1 = 1.0, y0 = -1.0, y1 = 0.0;
    if (plot_.x_linear) {
      x_.low = 0.0, x_.high = std::max(x1, 1.0);
      y_.low = std::floor(y0), y_.high = std::max(std::ceil(y1), y_.low + 1.0);
      return;
    }
    // time axes end where the data do, rounded to thirds of a decade; counts begin at 0 or 1
    x_.low = plot_.x_counts ? std::min(x0, 0.0) : std::floor(3.0 * x0 - 0.2) / 3.0;
    x_.high = std::max(x_.low + 0.5, std::ceil(3.0 * x1 + 0.1) / 3.0);
    y_.low = std::floor(y0), y_.high = std::max(std::ceil(y1), y_.low + 1.0);
  }

  void draw_grid() const {
    const ImU32 line = packed(kGrid), ink = packed(kPlotInk);
    const int every = y_.high - y_.low > 12.0 ? 2 : 1;
    for (int d = static_cast<int>(y_.low); d <= static_cast<int>(y_.high); d += every) {
      const float y = std::round(y_.at(d)) + 0.5f;
      pen_.list.AddLine({x_.from, y}, {x_.to, y}, line, u_);
      const std::string text = d == 0 ? "1" : fmt::format("1e{}", d);
      pen_.text(x_.from - pen_.text_width(text) - 7.0f * u_, y - 0.5f * pen_.text_size, kPlotInk, text);
    }
    if (plot_.x_linear) {
      const double raw = x_.high / 10.0, power = std::pow(10.0, std::floor(std::log10(raw))), mantissa = raw / power;
      const double step = power * (mantissa <= 1.0 ? 1.0 : mantissa <= 2.0 ? 2.0 : mantissa <= 5.0 ? 5.0 : 10.0);
      for (int k = 0; k * step <= x_.high * (1.0 + 1e-9); ++k) tick_x(k * step, fmt::format("{:g}", k * step), line);
      pen_.list.AddRect({x_.from, y_.to}, {x_.to, y_.from}, ink, 0.0f, 0, u_);
      return;
    }
    // a short axis has room for 2 and 5 in each decade, one of about a decade for 3 and 7
    const double decades = x_.high - x_.low;
    const auto is_told = [&](int digit) {
      return digit == 1 || (decades < 3.5 && (digit == 2 || digit == 5)) || decades < 1.4;
    };
    for (int d = static_cast<int>(std::floor(x_.low)); d <= static_cast<int>(std::ceil(x_.high)); ++d)
      for (const int digit : {1, 2, 3, 5, 7}) {
        const double at = d + std::log10(digit);
        if (!is_told(digit) || at < x_.low - 1e-9 || at > x_.high + 1e-9 || (plot_.x_counts && at < 0.0)) continue;
        tick_x(at, fmt::format("{:g}", digit * std::pow(10.0, d)), line);
      }
    if (plot_.x_counts && x_.low < 0.0) tick_x(-kZeroShift, "0", line);
    pen_.list.AddRect({x_.from, y_.to}, {x_.to, y_.from}, ink, 0.0f, 0, u_);
  }

  void tick_x(double decade, const std::string& text, ImU32 line) const {
    const float x = std::round(x_.at(decade)) + 0.5f;
    pen_.list.AddLine({x, y_.from}, {x, y_.to}, line, u_);
    pen_.text(x - 0.5f * pen_.text_width(text), y_.from + 5.0f * u_, kPlotInk, text);
  }

  void draw_mark(float x, float y, std::size_t i) const {
    const float r = 4.5f * u_;
    const ImU32 fill = packed(color(i)), paper = packed(kPlotPaper);
    switch (i % kMarks) {
      case 0:
        pen_.list.AddCircleFilled({x, y}, r + u_, paper, 16);
        pen_.list.AddCircleFilled({x, y}, r, fill, 16);
        break;
      case 1:
        pen_.list.AddRectFilled({x - r - u_, y - r - u_}, {x + r + u_, y + r + u_}, paper);
        pen_.list.AddRectFilled({x - r, y - r}, {x + r, y + r}, fill);
        break;
      case 2:
        pen_.list.AddTriangleFilled({x, y - 1.6f * r - u_}, {x + 1.5f * r + u_, y + 1.1f * r + u_},
                                    {x - 1.5f * r - u_, y + 1.1f * r + u_}, paper);
        pen_.list.AddTriangleFilled({x, y - 1.4f * r}, {x + 1.3f * r, y + 0.9f * r}, {x - 1.3f * r, y + 0.9f * r},
                                    fill);
        break;
      default:
        draw_diamond(x, y, 1.45f * r + u_, paper);
        draw_diamond(x, y, 1.4f * r, fill);
    }
  }
  void draw_diamond(float x, float y, float r, ImU32 color) const {
    pen_.list.AddQuadFilled({x, y - r}, {x + r, y}, {x, y + r}, {x - r, y}, color);
  }
  void draw_cross(ImVec2 at) const { pen_.cross(at.x, at.y, 7.0f * u_, 1.6f * u_); }

  void draw_series(std::size_t i) const {
    const PlotSeries& s = plot_.series[i];
    std::vector<ImVec2> line;
    const auto flush = [&] {  // segment by segment: joins of one polyline grow thin where it turns back sharply
      for (std::size_t k = 1; k < line.size(); ++k)
        pen_.list.AddLine(line[k - 1], line[k], packed(color(i)), 2.0f * u_);
      line.clear();
    };
    std::vector<ImVec2> marks;
    for (const Vec2& p : s.points) {
      if (!is_drawn(p)) {
        flush();
        continue;
      }
      const ImVec2 at{x_.at(decade_x(p.x())), y_.at(decade_y(p.y()))};
      // several points a pixel become one line anyway
      if (line.empty() || std::hypot(at.x - line.back().x, at.y - line.back().y) > 0.5f) line.push_back(at);
      if (plot_.marks_all || marks.empty() ||
          std::hypot(at.x - marks.back().x, at.y - marks.back().y) > static_cast<float>(kMarkEvery) * u_ ||
          &p == &s.points.back())
        marks.push_back(at);
    }
    flush();
    for (const ImVec2& m : marks) draw_mark(m.x, m.y, i);
  }

  ImVec2 place(const Vec2& p) const { return {x_.at(decade_x(p.x())), y_.at(decade_y(p.y()))}; }

  // stairs through the best points: what lies below and left of them nothing reached
  void draw_front() const {
    std::vector<ImVec2> corners;
    for (const Vec2& p : plot_.best)
      if (is_drawn(p)) corners.push_back(place(p));
    std::sort(corners.begin(), corners.end(), [](const ImVec2& a, const ImVec2& b) { return a.x < b.x; });
    for (std::size_t i = 1; i < corners.size(); ++i) {
      dashes(corners[i - 1], {corners[i].x, corners[i - 1].y});
      dashes({corners[i].x, corners[i - 1].y}, corners[i]);
    }
  }
  void dashes(ImVec2 a, ImVec2 b) const {
    const float length = std::hypot(b.x - a.x, b.y - a.y), dash = 6.0f * u_;
    for (float at = 0.0f; at < length; at += 2.0f * dash) {
      const float s = at / length, e = std::min(1.0f, (at + dash) / length);
      pen_.list.AddLine({a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}, {a.x + e * (b.x - a.x), a.y + e * (b.y - a.y)},
                        packed(kFront), 1.4f * u_);
    }
  }
  void draw_rings() const {
    for (const Vec2& p : plot_.best)
      if (is_drawn(p)) pen_.list.AddCircle(place(p), 9.5f * u_, packed(kPlotInk), 32, 1.4f * u_);
  }

  static Color color(std::size_t i) { return kColors[i % kColors.size()]; }

  static std::array<std::string, 2> lines_of(const std::string& name) {
    std::size_t at = name.find('-');
    // 1e-6 is one word
    while (at != std::string::npos &&
           (at + 1 == name.size() || !std::isalpha(static_cast<unsigned char>(name[at + 1]))))
      at = name.find('-', at + 1);
    return at == std::string::npos ? std::array<std::string, 2>{name, ""}
                                   : std::array<std::string, 2>{name.substr(0, at), "  " + name.substr(at + 1)};
  }
  float legend_width() const {
    float width = 0.0f;
    for (const PlotSeries& s : plot_.series)
      for (const std::string& line : lines_of(s.name)) width = std::max(width, pen_.text_width(line));
    for (const auto& [points, label] :
         {std::pair(&plot_.best, &plot_.best_label), std::pair(&plot_.doubtful, &plot_.doubtful_label)})
      if (!points->empty())
        for (const std::string& line : wrapped(*label)) width = std::max(width, pen_.text_width(line));
    return width + 40.0f * u_;
  }
  void draw_legend(float x, float y) const {
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      const auto lines = lines_of(plot_.series[i].name);
      const float middle = y + 0.5f * pen_.text_size;
      pen_.list.AddLine({x, middle}, {x + 28.0f * u_, middle}, packed(color(i)), 2.0f * u_);
      draw_mark(x + 14.0f * u_, middle, i);
      for (const std::string& line : lines) {
        if (line.empty()) continue;
        pen_.text(x + 36.0f * u_, y, kPlotInk, line);
        y += pen_.text_size + 2.0f * u_;
      }
      y += 5.0f * u_;
    }
    const ImVec2 sign{x + 14.0f * u_, 0.5f * pen_.text_size};
    if (!plot_.best.empty() && !plot_.best_label.empty()) {
      y += 6.0f * u_;
      pen_.list.AddCircle({sign.x, y + sign.y}, 9.5f * u_, packed(kPlotInk), 32, 1.4f * u_);
      draw_lines(plot_.best_label, x, y);
    }
    if (!plot_.doubtful.empty() && !plot_.doubtful_label.empty()) {
      y += 6.0f * u_;
      draw_cross({sign.x, y + sign.y});
      draw_lines(plot_.doubtful_label, x, y);
    }
  }
  void draw_lines(const std::string& text, float x, float& y) const {
    for (const std::string& line : wrapped(text)) {
      pen_.text(x + 36.0f * u_, y, kPlotInk, line);
      y += pen_.text_size + 2.0f * u_;
    }
  }
  static std::vector<std::string> wrapped(const std::string& text) {
    std::vector<std::string> lines(1);
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      if (!lines.back().empty() && lines.back().size() + end - begin >= kLegendLetters) lines.emplace_back();
      lines.back() += (lines.back().empty() ? "" : " ") + text.substr(begin, end - begin);
      begin = end + 1;
    }
    return lines;
  }

  const Pen& pen_;
  const Plot& plot_;
  float u_;
  Axis x_, y_;
};

}  // namespace

void draw_plot(const Pen& pen, const Plot& plot) { Painter(pen, plot).draw(); }

}  // namespace impinge
