// Are two pictures the same to a beholder? Renderers of other machines move a dozen pixels of a million, anywhere and
// by any amount; a fault moves many that lie together, or much of what little is drawn. So a pixel counts once it
// differs by more than `tolerance`, and three limits hold: in all, of what is drawn, and in any window. A limit on
// levels alone, or on the count alone, lets an arrow vanish unseen.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "viewer/image/image.hpp"

namespace impinge {

struct DifferenceSettings {
  int tolerance = 3;                  ///< of 255: largest difference of a channel that counts as equal
  double allowed_per_megapixel = 40;  ///< differing pixels, of 10^6 compared ones; rounded up
  double allowed_of_drawn = 0.02;     ///< differing pixels as a share of those drawn in either picture; rounded down
  int window = 16;                    ///< side of the square window that is moved over every place, in pixels
  int allowed_in_window = 6;          ///< differing pixels in any window
};

struct Difference {
  bool same = false;                      ///< within every limit
  bool identical = false;                 ///< every compared pixel is equal
  std::int64_t compared = 0;              ///< pixels: all that the mask doesn't leave out
  std::int64_t differing = 0;             ///< pixels that differ by more than the tolerance
  std::int64_t allowed = 0;               ///< the lower of the limits on `differing`
  std::int64_t drawn = 0;                 ///< pixels unlike the background in either picture
  double share_of_drawn = 0;              ///< differing / drawn; 0 where nothing is drawn
  int max_level = 0;                      ///< largest difference of a channel, tolerated ones too
  std::array<int, 4> box = {0, 0, 0, 0};  ///< x, y, width, height around the differing pixels
  int worst_window = 0;                   ///< differing pixels in the fullest window
  std::array<int, 2> worst_at = {0, 0};   ///< x, y of its upper left corner: the first such one, row by row
  bool too_many = false;                  ///< more than `allowed` in all
  bool too_dense = false;                 ///< more than settings.allowed_in_window in a window
  DifferenceSettings settings;
  std::string reason;  ///< one line: what was found and which limits it breaks
};

/// Compares `a` (the reference) with `b`. The background is the commonest colour of the picture's four corners. Where
/// `mask` is given, its black pixels are left out. Pictures of unlike sizes are not the same, whatever the limits.
/// Throws InputError where the mask's size is not that of `a`.
Difference compare(const Image& a, const Image& b, const DifferenceSettings& settings = {},
                   const Image* mask = nullptr);

/// A, B and, over a dim grey A, the pixels that differ (yellow to red as the difference grows; tolerated ones blue),
/// side by side, with the fullest window framed and `difference.reason` below. Small pictures are enlarged.
Image difference_panels(const Image& a, const Image& b, const Difference& difference, const Image* mask = nullptr);

/// The third of the panels alone, as large as the pictures; pixels that differ get `surround` dark red ones on every
/// side.
Image difference_overlay(const Image& a, const Image& b, int tolerance, int surround, const Image* mask = nullptr);

/// Largest difference of a channel between two pixels.
int channel_difference(const std::uint8_t* l, const std::uint8_t* r);

}  // namespace impinge
