// Numbers as bytes, low byte first, on every machine. Doubles as their 64 bits: what is read is what was written.
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <type_traits>

#include "engine/core/types.hpp"

namespace impinge {

template <class T>
using BitsOf =
    std::conditional_t<sizeof(T) == 8, std::uint64_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint8_t>>;

class LittleEndianWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) {
    const auto bits = std::bit_cast<BitsOf<T>>(value);
    for (std::size_t k = 0; k < sizeof(T); ++k)
      bytes_.push_back(static_cast<char>(static_cast<std::uint8_t>(bits >> (8 * k))));
  }
  void put(const Vec3& v) { put(v.x()), put(v.y()), put(v.z()); }
  void put(const VecX& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) put(v[i]);
  }
  /// Row by row.
  void put(const Mat3& m) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) put(m(r, c));
  }
  void put_count(std::size_t n) { put(static_cast<std::uint32_t>(n)); }
  void put_text(std::string_view text) {
    put_count(text.size());
    bytes_.append(text);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Bits of a T at `at`; the bytes must be there.
template <class T>
T little_endian_at(std::string_view bytes, std::size_t at) {
  BitsOf<T> bits = 0;
  for (std::size_t k = 0; k < sizeof(T); ++k)
    bits = static_cast<BitsOf<T>>(
        bits | static_cast<BitsOf<T>>(static_cast<BitsOf<T>>(static_cast<std::uint8_t>(bytes[at + k])) << (8 * k)));
  return std::bit_cast<T>(bits);
}

/// 64-bit FNV-1a: no change of a single byte goes unseen.
inline std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : bytes) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001b3ull;
  return hash;
}

}  // namespace impinge
