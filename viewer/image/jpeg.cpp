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
  const auto append = [](void* context, void* bytes, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
  };
  const bool written =
      stbi_write_jpg_to_func(append, &out, image.width, image.height, 3, image.rgb.data(), quality) != 0;
  IMPINGE_ASSERT(written);
  return out;
}

}  // namespace impinge
