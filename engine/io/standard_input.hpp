// What comes by standard input, as a whole.
#pragma once

#include <cstdint>
#include <string>

namespace impinge {

/// All of it, however often it is asked for, and until an interrupt. Throws InputError where there is none, or more than
/// `limit` bytes of it.
const std::string& standard_input(std::uint64_t limit);

}  // namespace impinge
