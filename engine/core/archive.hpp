// Bytes to and from memory, for snapshots and the state hash.
#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/core/types.hpp"

namespace impinge {

class ByteWriter {
 public:
  ByteWriter() = default;
  /// Writes where other bytes were, and takes their room.
  explicit ByteWriter(std::string room) : bytes_(std::move(room)) { bytes_.clear(); }
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T value) { put_bytes(&value, sizeof(T)); }
  void put(const Vec3& v) { put_bytes(v.data(), 3 * sizeof(double)); }
  void put(const Mat3& m) { put_bytes(m.data(), 9 * sizeof(double)); }
  void put_bytes(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

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
