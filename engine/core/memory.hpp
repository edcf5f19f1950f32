// How much memory the program may hold, looked at before much is taken.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace impinge {

/// Bytes that may be resident at once. By default half of what the machine has, or the control group that the program
/// runs in, if that is less.
std::uint64_t memory_limit();
void set_memory_limit(std::uint64_t bytes);
/// What was set, 0 for nothing.
std::uint64_t given_memory_limit();

/// Bytes of the program that are resident now.
std::uint64_t memory_in_use();

/// Throws InputError unless `more` bytes fit beside what is in use: "PLACE: WHAT needs about 4.8 GiB of memory; ...;
/// REMEDY, or raise --memory-limit". `place` may be empty.
void check_memory(const std::string& place, const std::string& what, double more, const std::string& remedy);

/// "512M", "4G", "1.5G", "2048K", "1T" (powers of 1024), or plain bytes; nothing where it is none of these, or 0.
std::optional<std::uint64_t> parse_bytes(std::string_view text);

/// Three digits and a unit: "4.83 GiB".
std::string describe_bytes(double bytes);

}  // namespace impinge
