// Words that will mean something in a later version: refused with a message of their own until then, never taken for
// something else.
#pragma once

#include <span>
#include <string_view>

namespace impinge {

std::span<const std::string_view> reserved_commands();

struct ReservedOption {
  std::string_view command, option;
};
std::span<const ReservedOption> reserved_options();

}  // namespace impinge
