// A run at a glance: small copies of chosen frames in a grid, each with its frame's number.
#pragma once

#include <filesystem>
#include <span>

#include "viewer/image/image.hpp"

namespace impinge {

/// Thumbnails of at most `max_frames` of `frames`, evenly chosen, first and last included, in rows of `columns`. All
/// have the first frame's proportions and are at most `thumbnail_width` pixels wide; the label is the digits that end
/// the file name's stem, or the stem. Throws InputError without frames or where one can't be read or has another size;
/// InternalError unless columns, max_frames and thumbnail_width are positive.
Image make_contact_sheet(std::span<const std::filesystem::path> frames, int columns, int max_frames,
                         int thumbnail_width = 320);

/// `image` reduced by the mean over each pixel's area, partly covered pixels weighted. In sRGB values, as viewers do
/// it. Throws InternalError unless 0 < width <= image.width and 0 < height <= image.height.
Image reduce_image(const Image& image, int width, int height);

}  // namespace impinge
