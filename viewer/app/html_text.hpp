// Small helpers for pages that stand alone.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

/// For text and for attributes in double quotes.
std::string html_text(std::string_view text);
/// "data:image/png;base64,..." of a PNG file's bytes.
std::string png_data_uri(std::string_view bytes);

}  // namespace impinge
