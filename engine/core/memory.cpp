#include "engine/core/memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <fstream>

#include "engine/core/error.hpp"

namespace impinge {

namespace {

/// The first number of a file of the kernel's; nothing where there is none ("max").
std::optional<std::uint64_t> number_in(const char* file) {
  std::ifstream in(file);
  std::uint64_t value = 0;
  return in >> value ? std::optional(value) : std::nullopt;
}

std::uint64_t machine_memory() {
  std::uint64_t bytes =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
  // the control group that the program is shut up in, where it is (version 2, version 1)
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (const auto most = number_in(file)) bytes = std::min(bytes, *most);
  return bytes;
}

std::atomic<std::uint64_t> given_limit{0};

}  // namespace

std::uint64_t memory_limit() {
  static const std::uint64_t half = machine_memory() / 2;
  const std::uint64_t given = given_limit.load();
  return given > 0 ? given : half;
}

void set_memory_limit(std::uint64_t bytes) { given_limit = bytes; }

std::uint64_t given_memory_limit() { return given_limit; }

std::uint64_t memory_in_use() {
  std::ifstream in("/proc/self/statm");
  std::uint64_t mapped = 0, resident = 0;
  in >> mapped >> resident;
  return in ? resident * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE)) : 0;
}

void check_memory(const std::string& place, const std::string& what, double more, const std::string& remedy) {
  constexpr double kSmall = 16 << 20;  // not worth asking the kernel
  if (more <= kSmall && more < 0.01 * static_cast<double>(memory_limit())) return;
  const double whole = more + static_cast<double>(memory_in_use());
  if (whole <= static_cast<double>(memory_limit())) return;
  throw InputError(fmt::format("{}{}{} needs about {} of memory; {} are allowed ({}); {}, or raise --memory-limit",
                               place, place.empty() ? "" : ": ", what, describe_bytes(whole),
                               describe_bytes(static_cast<double>(memory_limit())),
                               given_limit > 0 ? "--memory-limit" : "half of the machine's", remedy));
}

std::optional<std::uint64_t> parse_bytes(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc()) return std::nullopt;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (unit.size() > 1) return std::nullopt;
  if (unit.size() == 1) {
    const std::size_t power = std::string_view("KMGT").find(unit[0]);
    if (power == std::string_view::npos) return std::nullopt;
    for (std::size_t i = 0; i <= power; ++i) value *= 1024.0;
  }
  if (!(value >= 1.0 && value < 1e18)) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

std::string describe_bytes(double bytes) {
  constexpr const char* kUnits[] = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB"};
  std::size_t unit = 0;
  while (bytes >= 1000.0 && unit + 1 < std::size(kUnits)) bytes /= 1024.0, ++unit;
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace impinge
