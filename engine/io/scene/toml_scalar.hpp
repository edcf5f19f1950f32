// Values of a scene text that hold no others: texts, numbers, booleans, dates and times.
#pragma once

#include "engine/io/scene/toml.hpp"
#include "engine/io/scene/toml_cursor.hpp"

namespace impinge {

/// The text that begins with a quote at the cursor, escapes resolved. Of several lines (three quotes) where allowed.
std::string read_toml_text(TomlCursor& in, bool many_lines);

/// The boolean, number, date or time that begins at the cursor; its place is not set. A real number beyond 64 bits is
/// the nearest there is (infinity, 0), for the range of the key to refuse; such an integer is refused here.
TomlNode read_toml_word(TomlCursor& in);

}  // namespace impinge
