#include "viewer/app/reserved_words.hpp"

namespace impinge {

namespace {

// who builds one takes its line away
constexpr std::string_view kCommands[] = {
    "show",
    "judge",
    "trace",
};

}  // namespace

std::span<const std::string_view> reserved_commands() { return kCommands; }
std::span<const ReservedOption> reserved_options() { return {}; }  // all that were have come

}  // namespace impinge
