#include "engine/core/archive.hpp"

#include <fmt/format.h>

namespace impinge {

std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed) {
  const auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  };
  std::uint64_t h = mix(seed + 0x9E3779B97F4A7C15ull * (bytes.size() + 1));
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t n = std::min<std::size_t>(8, bytes.size());
    std::memcpy(&word, bytes.data(), n);
    bytes.remove_prefix(n);
    h = mix(h ^ word) + 0x9E3779B97F4A7C15ull;
  }
  return mix(h);
}

std::string hex64(std::uint64_t value) { return fmt::format("{:016x}", value); }

}  // namespace impinge
