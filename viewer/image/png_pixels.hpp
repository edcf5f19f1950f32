// The pixel part of a PNG file, by a private copy of stb: no symbol of it leaves png_pixels.cpp, so the shared libstb
// that Dear ImGui brings along stays untouched.
#pragma once

#include <string>
#include <string_view>

#include "viewer/image/image.hpp"

namespace impinge {

/// A PNG file of 8-bit RGB, or RGBA if the image has alpha, without any text. Throws InternalError on an empty image.
std::string encode_png_pixels(const Image& image);

/// The pixels of a whole PNG file as 8-bit RGB: grey and palettes are expanded; alpha where the file has it. False, with
/// `reason` set, where stb can't decode it. The checksums are not looked at.
bool decode_png_pixels(std::string_view file, Image& image, std::string& reason);

}  // namespace impinge
