// Small helpers for pages that stand alone.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

/// For text and for attributes in double quotes.
std::string html_text(std::string_view text);
/// "data:image/TYPE;base64,..." of the bytes of a picture's file.
std::string data_uri(std::string_view type, std::string_view bytes);
inline std::string png_data_uri(std::string_view bytes) { return data_uri("png", bytes); }

}  // namespace impinge
