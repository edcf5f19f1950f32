// Text is UTF-8 throughout: what comes in is looked at once, here, before anything is made of it.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

/// The text behind the mark of byte order that some editors put at its start and nobody sees.
std::string_view without_byte_order_mark(std::string_view text);

/// The first byte that does not belong to a well-formed sequence (RFC 3629: no overlong forms, no surrogates, nothing
/// beyond U+10FFFF), or npos.
std::size_t find_invalid_utf8(std::string_view text);

/// The text with each byte that is no UTF-8 written as \xHH, so that it can stand in a message or a document.
std::string readable_utf8(std::string_view text);

/// How many characters (code points) the well-formed text has.
std::size_t count_characters(std::string_view text);

/// The first `most` characters, and "..." where there are more.
std::string shortened(std::string_view text, std::size_t most);

/// Throws InputError `name:line:column: ...` at the first byte that is no UTF-8; columns count characters, from 1.
void check_utf8(const std::string& name, std::string_view text);

/// The same for a name of a file or folder, which is going to stand in what is written: it must be readable again.
void check_utf8_name(std::string_view path);

}  // namespace impinge
