// What reads the words of a line: each refuses at the word that is wrong.
#pragma once

#include <span>

#include "viewer/controller/text_place.hpp"

namespace impinge {

using LineWords = std::span<const PlacedText>;

/// Position of the word among the names; `what` it is, for the message.
std::size_t find(const PlacedText& word, const char* what, const std::vector<std::string>& names);
/// So many words, the first included.
void want(LineWords words, std::size_t least, std::size_t most, const char* usage);
double number(const PlacedText& word, double low, double high, bool whole = false);
/// Everything after the first `skip` words, as it was written.
std::string rest(const PlacedText& line, LineWords words, std::size_t skip);

}  // namespace impinge
