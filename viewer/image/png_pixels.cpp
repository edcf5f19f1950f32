#include "viewer/image/png_pixels.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

#include "engine/core/error.hpp"

namespace {

// stb frees the result with free(). Level 2: a frame in a third of the time that stb's own deflate takes, and smaller.
unsigned char* deflate_for_stb(unsigned char* data, int size, int* out_size, int) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(2), libdeflate_free_compressor);
  if (!compressor) return nullptr;
  const std::size_t room = libdeflate_zlib_compress_bound(compressor.get(), static_cast<std::size_t>(size));
  auto* out = static_cast<unsigned char*>(std::malloc(room));
  if (out == nullptr) return nullptr;
  *out_size =
      static_cast<int>(libdeflate_zlib_compress(compressor.get(), data, static_cast<std::size_t>(size), out, room));
  return out;
}

unsigned int crc_for_stb(unsigned char* data, int size) {
  return libdeflate_crc32(0, data, static_cast<std::size_t>(size));
}

}  // namespace

#define STBIW_ZLIB_COMPRESS deflate_for_stb
#define STBIW_CRC32 crc_for_stb
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>

namespace impinge {

std::string encode_png_pixels(const Image& image) {
  IMPINGE_ASSERT(image.width > 0 && image.height > 0);
  IMPINGE_ASSERT(image.rgb.size() == std::size_t{3} * image.width * image.height);
  IMPINGE_ASSERT(image.alpha.empty() || 3 * image.alpha.size() == image.rgb.size());
  // every pixel minus the one left of it: a fifth smaller than the one above it on floors and gradients, as small as what is
  // chosen row by row, and stb need not try five filters
  [[maybe_unused]] static const int filter = (stbi_write_force_png_filter = 1);
  const int channels = image.alpha.empty() ? 3 : 4;
  std::vector<std::uint8_t> rgba;
  if (channels == 4) rgba.resize(4 * image.alpha.size());
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    std::copy_n(image.rgb.data() + 3 * i, 3, rgba.data() + 4 * i);
    rgba[4 * i + 3] = image.alpha[i];
  }
  const std::uint8_t* pixels = channels == 4 ? rgba.data() : image.rgb.data();
  int size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> file(
      stbi_write_png_to_mem(pixels, channels * image.width, image.width, image.height, channels, &size), std::free);
  IMPINGE_ASSERT(file != nullptr);
  return {reinterpret_cast<const char*>(file.get()), static_cast<std::size_t>(size)};
}

bool decode_png_pixels(std::string_view file, Image& image, std::string& reason) {
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
      stbi_load_from_memory(reinterpret_cast<const unsigned char*>(file.data()), static_cast<int>(file.size()), &width,
                            &height, &channels, 4),
      stbi_image_free);
  if (!pixels) {
    reason = stbi_failure_reason();
    return false;
  }
  Image decoded(width, height);
  const std::size_t count = decoded.rgb.size() / 3;
  for (std::size_t i = 0; i < count; ++i) std::copy_n(pixels.get() + 4 * i, 3, decoded.rgb.data() + 3 * i);
  if (channels == 2 || channels == 4) {
    decoded.alpha.resize(count);
    for (std::size_t i = 0; i < count; ++i) decoded.alpha[i] = pixels.get()[4 * i + 3];
  }
  image = std::move(decoded);
  return true;
}

}  // namespace impinge
