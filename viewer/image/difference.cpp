#include "viewer/image/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

using Flags = std::vector<std::uint8_t>;  // one a pixel, row by row

/// The colour of a corner that leaves the fewest pixels over: a panel may cover any three of the corners.
const std::uint8_t* background(const Image& image) {
  const std::uint8_t* const corners[] = {image.pixel(0, 0), image.pixel(image.width - 1, 0),
                                         image.pixel(0, image.height - 1),
                                         image.pixel(image.width - 1, image.height - 1)};
  std::int64_t count[4] = {};
  for (const std::uint8_t *p = image.rgb.data(), *end = p + image.rgb.size(); p != end; p += 3)
    for (int k = 0; k < 4; ++k) count[k] += std::equal(p, p + 3, corners[k]);
  return corners[std::max_element(count, count + 4) - count];
}

/// Fills worst_window and worst_at. A summed-area table makes each place four look-ups [Crow84].
void find_worst_window(const Flags& differs, int width, int height, Difference& difference) {
  const std::size_t stride = static_cast<std::size_t>(width) + 1;
  std::vector<std::int32_t> sum(stride * (height + 1), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0, row = 0; x < width; ++x) {
      row += differs[static_cast<std::size_t>(y) * width + x];
      sum[(y + 1) * stride + x + 1] = sum[y * stride + x + 1] + row;
    }
  const int w = std::min(difference.settings.window, width), h = std::min(difference.settings.window, height);
  for (int y = 0; y + h <= height; ++y)
    for (int x = 0; x + w <= width; ++x) {
      const int count =
          sum[(y + h) * stride + x + w] - sum[y * stride + x + w] - sum[(y + h) * stride + x] + sum[y * stride + x];
      if (count > difference.worst_window) {
        difference.worst_window = count;
        difference.worst_at = {x, y};
      }
    }
}

/// Fills the counts, the box and max_level; answers which pixels differ.
Flags find_differing(const Image& a, const Image& b, const Image* mask, Difference& difference) {
  const int tolerance = difference.settings.tolerance;
  const std::uint8_t *back_a = background(a), *back_b = background(b);
  Flags differs(a.rgb.size() / 3, 0);
  int low[2] = {a.width, a.height}, high[2] = {-1, -1};
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * a.width + x;
      if (is_left_out(mask, pixel)) continue;
      ++difference.compared;
      const std::uint8_t *p = a.pixel(x, y), *q = b.pixel(x, y);
      difference.drawn += channel_difference(p, back_a) > tolerance || channel_difference(q, back_b) > tolerance;
      const int level = channel_difference(p, q);
      difference.max_level = std::max(difference.max_level, level);
      if (level <= tolerance) continue;
      differs[pixel] = 1;
      ++difference.differing;
      low[0] = std::min(low[0], x), low[1] = std::min(low[1], y);
      high[0] = std::max(high[0], x), high[1] = std::max(high[1], y);
    }
  if (difference.differing > 0) difference.box = {low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1};
  return differs;
}

std::string describe(const Difference& d) {
  if (d.identical) return fmt::format("identical: {} pixels", d.compared);
  const auto& s = d.settings;
  std::string text = fmt::format("{} of {} pixels differ by more than {} levels (at most {} may), the most by {}",
                                 d.differing, d.compared, s.tolerance, d.allowed, d.max_level);
  if (d.differing > 0) {
    text += fmt::format("; {:.3g} % of the {} drawn ones", 100 * d.share_of_drawn, d.drawn);
    text += fmt::format("; {} in the {} x {} window at ({}, {}) (at most {} may)", d.worst_window, s.window, s.window,
                        d.worst_at[0], d.worst_at[1], s.allowed_in_window);
    text += fmt::format("; all within {} x {} at ({}, {})", d.box[2], d.box[3], d.box[0], d.box[1]);
    if (d.too_many && d.too_dense)
      text += "; breaks the limit on the whole picture and that on a window";
    else if (!d.same)
      text += d.too_many ? "; breaks the limit on the whole picture" : "; breaks the limit on a window";
  }
  return (d.same ? "same: " : "different: ") + text;
}

}  // namespace

int channel_difference(const std::uint8_t* l, const std::uint8_t* r) {
  return std::max({std::abs(l[0] - r[0]), std::abs(l[1] - r[1]), std::abs(l[2] - r[2])});
}

Difference compare(const Image& a, const Image& b, const DifferenceSettings& settings, const Image* mask) {
  IMPINGE_ASSERT(settings.window > 0);
  Difference difference;
  difference.settings = settings;
  if (mask != nullptr && (mask->width != a.width || mask->height != a.height))
    throw InputError(
        fmt::format("the mask has {} x {} pixels; the picture's {} x {} are wanted; draw it over that picture",
                    mask->width, mask->height, a.width, a.height));
  if (a.width != b.width || a.height != b.height) {
    difference.reason =
        fmt::format("different: the sizes are {} x {} and {} x {} pixels", a.width, a.height, b.width, b.height);
    return difference;
  }
  if (a.rgb.empty()) {
    difference.same = difference.identical = true;
    difference.reason = describe(difference);
    return difference;
  }
  const Flags differs = find_differing(a, b, mask, difference);
  difference.identical = difference.max_level == 0;
  if (difference.differing > 0) {
    // where nothing is drawn, in pictures of two backgrounds, every pixel differs and the first limit speaks
    if (difference.drawn > 0) difference.share_of_drawn = static_cast<double>(difference.differing) / difference.drawn;
    find_worst_window(differs, a.width, a.height, difference);
  }
  difference.allowed =
      static_cast<std::int64_t>(std::min(std::ceil(settings.allowed_per_megapixel * difference.compared / 1e6),
                                         std::floor(settings.allowed_of_drawn * difference.drawn)));
  difference.too_many = difference.differing > difference.allowed;
  difference.too_dense = difference.worst_window > settings.allowed_in_window;
  difference.same = !difference.too_many && !difference.too_dense;
  difference.reason = describe(difference);
  return difference;
}

}  // namespace impinge
