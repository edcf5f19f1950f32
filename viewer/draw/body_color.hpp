// A colour that someone gave a body: "NAME=rrggbb", as `view.colors` and the command `color` have it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/draw/palette.hpp"

namespace impinge {

/// "rrggbb" in either case of letters, also after a "#" (which begins a comment in scripts); none for all else.
std::optional<Color> read_color(std::string_view text);
/// The same back.
std::string color_text(Color color);

/// What an entry is about: "ball" of "ball=e07020", and of "ball".
std::string_view name_in(std::string_view entry);
/// What colour it gives; none where it isn't one.
std::optional<Color> color_in(std::string_view entry);

/// Gives the bodies that colour, instead of what the entries said of them; none: takes it away.
void give_color(std::vector<std::string>& entries, const std::vector<std::string>& bodies, std::optional<Color> color);
/// Of the last entry that names the body.
std::optional<Color> given_color(const std::vector<std::string>& entries, std::string_view body);

}  // namespace impinge
