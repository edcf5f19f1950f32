// Commands that a message hands to a shell.
#pragma once

#include <string>
#include <string_view>

namespace impinge {

/// The text as one word of sh: plain where that is safe, in single quotes otherwise.
std::string shell_word(std::string_view text);

}  // namespace impinge
