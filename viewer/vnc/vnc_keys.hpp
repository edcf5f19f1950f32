// X's key symbols, which VNC sends, as the debugger's keys and text.
#pragma once

#include <cstdint>
#include <string>

namespace impinge {

/// Of key_names(); -1 for others.
int key_of_symbol(std::uint32_t symbol);
/// What it types, UTF-8; "" for keys that type nothing.
std::string text_of_symbol(std::uint32_t symbol);

}  // namespace impinge
