// PNG files: 8-bit RGB or RGBA pictures that say in tEXt chunks what they show.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "viewer/image/image.hpp"

namespace impinge {

/// Keyword (1 to 79 printable ASCII characters) and text (any bytes but NUL) of each tEXt chunk, in the file's order.
using PngText = std::vector<std::pair<std::string, std::string>>;

/// Grey, as the backdrop `flat`.
inline constexpr std::uint8_t kBehind[3] = {0x3f, 0x46, 0x50};

/// The same image and text give the same bytes. Throws InternalError on an empty image or a keyword or text that a
/// chunk can't hold.
std::string encode_png(const Image& image, const PngText& text = {});

/// `name` stands in the messages. Throws InputError where the bytes are no PNG file, are damaged (every chunk's
/// checksum is tested) or hold more than 2^26 pixels. What is transparent is laid over kBehind: whoever compares pictures
/// or shows them small sees what an eye would.
Image decode_png(std::string_view bytes, const std::string& name);

/// Complete or not at all: writes beside `path`, then renames. Throws InputError naming the path where that fails.
void write_png(const std::filesystem::path& path, const Image& image, const PngText& text = {});

/// Throws InputError where the file is missing, unreadable, no PNG, damaged or too large.
Image read_png(const std::filesystem::path& path);
PngText read_png_text(const std::filesystem::path& path);

}  // namespace impinge
