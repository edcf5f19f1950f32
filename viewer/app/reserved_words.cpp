#include "viewer/app/reserved_words.hpp"

namespace impinge {

namespace {

// who builds one takes its line away
constexpr std::string_view kCommands[] = {
    "export", "shrink", "clean", "show", "judge", "trace",
};
constexpr ReservedOption kOptions[] = {
    {"run", "--force"}, {"check", "--strict"}, {"check", "--trial"},  {"list", "--json"},
    {"debug", "--vnc"}, {"debug", "--web"},    {"debug", "--listen"}, {"debug", "--password-file"},
};

}  // namespace

std::span<const std::string_view> reserved_commands() { return kCommands; }
std::span<const ReservedOption> reserved_options() { return kOptions; }

}  // namespace impinge
