// Small copies of pictures for pages that hold them: a tenth of a PNG file's bytes.
#pragma once

#include <string>

#include "viewer/image/image.hpp"

namespace impinge {

/// A JPEG file; quality 1..100. Throws InternalError on an empty image.
std::string encode_jpeg(const Image& image, int quality);

}  // namespace impinge
