#include "viewer/image/contact_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "viewer/image/label.hpp"
#include "viewer/image/png.hpp"

namespace impinge {

namespace {

constexpr Rgb kPaper = {18, 20, 24}, kInk = {225, 225, 225};
constexpr int kMargin = 8;

/// One output pixel's share of a row or column: input pixels from `first` on, with whole-number weights.
struct Span {
  int first = 0;
  std::vector<std::uint32_t> weights;
};

/// Output pixel k covers [k * from, (k + 1) * from) in units of 1 / to input pixels, so every overlap is a whole number
/// and the weights add up to `from`.
std::vector<Span> spans(int from, int to) {
  std::vector<Span> spans(to);
  for (std::int64_t k = 0; k < to; ++k) {
    const std::int64_t begin = k * from, end = begin + from;
    spans[k].first = static_cast<int>(begin / to);
    for (std::int64_t pixel = begin / to; pixel * to < end; ++pixel)
      spans[k].weights.push_back(
          static_cast<std::uint32_t>(std::min(end, (pixel + 1) * to) - std::max(begin, pixel * to)));
  }
  return spans;
}

/// At most `room` pixels wide, the last characters: they tell frames apart.
std::string label_of(const std::filesystem::path& frame, int room, int scale) {
  const std::string stem = frame.stem().string();
  const std::string digits = stem.substr(stem.find_last_not_of("0123456789") + 1);
  std::string label = digits.empty() ? stem : digits;
  while (!label.empty() && text_width(label, scale) > room) {
    std::size_t next = 1;  // of a character, which in UTF-8 may be several bytes
    while (next < label.size() && (static_cast<unsigned char>(label[next]) & 0xc0) == 0x80) ++next;
    label.erase(0, next);
  }
  return label;
}

/// Evenly from the first to the last.
std::vector<std::size_t> choose(std::size_t count, std::size_t at_most) {
  const std::size_t chosen = std::min(count, at_most);
  std::vector<std::size_t> choice(chosen, 0);
  for (std::size_t k = 1; k < chosen; ++k) choice[k] = (k * (count - 1) + (chosen - 1) / 2) / (chosen - 1);
  return choice;
}

}  // namespace

Image reduce_image(const Image& image, int width, int height) {
  IMPINGE_ASSERT(width > 0 && height > 0 && width <= image.width && height <= image.height);
  Image out(width, height);
  const std::vector<Span> columns = spans(image.width, width), rows = spans(image.height, height);
  const std::uint64_t area = static_cast<std::uint64_t>(image.width) * image.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      std::uint64_t sum[3] = {area / 2, area / 2, area / 2};  // rounds to nearest
      for (std::size_t j = 0; j < rows[y].weights.size(); ++j) {
        const std::uint8_t* p = image.pixel(columns[x].first, rows[y].first + static_cast<int>(j));
        for (const std::uint32_t weight : columns[x].weights)
          for (std::uint64_t& s : sum) s += static_cast<std::uint64_t>(weight) * rows[y].weights[j] * *p++;
      }
      for (int c = 0; c < 3; ++c) out.pixel(x, y)[c] = static_cast<std::uint8_t>(sum[c] / area);
    }
  return out;
}

Image make_contact_sheet(std::span<const std::filesystem::path> frames, int columns, int max_frames,
                         int thumbnail_width) {
  IMPINGE_ASSERT(columns > 0 && max_frames > 0 && thumbnail_width > 0);
  if (frames.empty())
    throw InputError("contact sheet: there are no frames; at least one is wanted; run the scene first");
  const std::vector<std::size_t> choice = choose(frames.size(), static_cast<std::size_t>(max_frames));
  const int shown = static_cast<int>(choice.size());
  columns = std::min(columns, shown);
  const int rows = (shown + columns - 1) / columns;

  Image frame = read_png(frames[choice[0]]);
  const int frame_width = frame.width, frame_height = frame.height, width = std::min(thumbnail_width, frame_width);
  const int height =
      std::max(1, static_cast<int>((std::int64_t{width} * frame_height + frame_width / 2) / frame_width));
  const int label_scale = width >= 160 ? 2 : 1, cell_height = height + 4 + text_height(label_scale) + kMargin;
  Image sheet(kMargin + columns * (width + kMargin), kMargin + rows * cell_height);
  fill_rectangle(sheet, 0, 0, sheet.width, sheet.height, kPaper);

  for (int k = 0; k < shown; ++k) {
    const std::filesystem::path& path = frames[choice[k]];
    if (k > 0) frame = read_png(path);
    if (frame.width != frame_width || frame.height != frame_height)
      throw InputError(fmt::format("{}: has {} x {} pixels; {} x {} as in {} are wanted; make one sheet a size",
                                   path.string(), frame.width, frame.height, frame_width, frame_height,
                                   frames[0].string()));
    const Image small = reduce_image(frame, width, height);
    const int x = kMargin + k % columns * (width + kMargin), y = kMargin + k / columns * cell_height;
    for (int row = 0; row < height; ++row) std::copy_n(small.pixel(0, row), 3 * width, sheet.pixel(x, y + row));
    draw_text(sheet, x, y + height + 4, label_of(path, width, label_scale), kInk, label_scale);
  }
  return sheet;
}

}  // namespace impinge
