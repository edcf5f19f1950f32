// Pictures inside pages that stand alone.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

/// "data:image/png;base64,..." of a PNG file's bytes [RFC 4648 §4].
std::string png_data_uri(std::string_view bytes);

}  // namespace impinge
