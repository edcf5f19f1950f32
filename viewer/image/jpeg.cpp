#include "viewer/image/jpeg.hpp"

#include "engine/core/error.hpp"

// a private copy, as in png_pixels.cpp
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>

namespace impinge {

std::string encode_jpeg(const Image& image, int quality) {
  IMPINGE_ASSERT(image.width > 0 && image.height > 0);
  std::string out;
  const auto append = [](void* context, void* bytes, int size) { static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size)); };
  const bool written = stbi_write_jpg_to_func(append, &out, image.width, image.height, 3, image.rgb.data(), quality) != 0;
  IMPINGE_ASSERT(written);
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace impinge
