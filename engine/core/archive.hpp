// Bytes to and from memory, for snapshots and the state hash.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>

#include "engine/core/error.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T)); }
  void put(const Vec3& v) { put(v.x()), put(v.y()), put(v.z()); }
  void put(const Mat3& m) {
    for (int i = 0; i < 9; ++i) put(m.data()[i]);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  requires std::is_arithmetic_v<T> T get() {
    if (bytes_.size() < sizeof(T)) throw InputError("snapshot: ends early; it is damaged, remove it and run again");
    T value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    return value;
  }
  Vec3 get_vec3() {
    const double x = get<double>(), y = get<double>(), z = get<double>();
    return {x, y, z};
  }
  Mat3 get_mat3() {
    Mat3 m;
    for (int i = 0; i < 9; ++i) m.data()[i] = get<double>();
    return m;
  }
  bool at_end() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

/// 64-bit hash of bytes: the finaliser of splitmix64 chained over 8-byte words. Not for security.
std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t seed = 0);
/// 16 lower-case hex digits.
std::string hex64(std::uint64_t value);

}  // namespace impinge
