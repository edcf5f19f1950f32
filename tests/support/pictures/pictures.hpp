// Pictures with a known content, and a CRC-32 and chunk walk that share nothing with the PNG writer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/random.hpp"
#include "viewer/image/image.hpp"
#include "viewer/image/label.hpp"

namespace impinge::test {

inline Image plain(int width, int height, Rgb colour = {40, 44, 52}) {
  Image image(width, height);
  fill_rectangle(image, 0, 0, width, height, colour);
  return image;
}

inline Image noise(int width, int height, std::uint64_t seed) {
  Image image(width, height);
  Random random(seed);
  for (auto& value : image.rgb) value = static_cast<std::uint8_t>(random.below(256));
  return image;
}

inline void draw_disc(Image& image, double x, double y, double radius, Rgb colour = {220, 140, 60}) {
  for (int j = 0; j < image.height; ++j)
    for (int i = 0; i < image.width; ++i)
      if ((i - x) * (i - x) + (j - y) * (j - y) < radius * radius)
        std::copy(colour.begin(), colour.end(), image.pixel(i, j));
}

/// Bit by bit, from the polynomial in the PNG specification's annex D.
inline std::uint32_t plain_crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

inline std::uint32_t four_bytes(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = at; k < at + 4; ++k) value = 256 * value + static_cast<std::uint8_t>(bytes.at(k));
  return value;
}

struct PngChunk {
  std::size_t begin = 0;  ///< of the length field
  std::string type, data;
  bool crc_holds = false;
};

/// Throws std::out_of_range where the file ends too early.
inline std::vector<PngChunk> png_chunks(const std::string& file) {
  std::vector<PngChunk> chunks;
  for (std::size_t at = 8; at < file.size(); at += 12 + chunks.back().data.size()) {
    const std::uint32_t size = four_bytes(file, at);
    PngChunk chunk{at, file.substr(at + 4, 4), file.substr(at + 8, size), false};
    chunk.crc_holds = plain_crc32(chunk.type + chunk.data) == four_bytes(file, at + 8 + size);
    chunks.push_back(chunk);
  }
  return chunks;
}

}  // namespace impinge::test
