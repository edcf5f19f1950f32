// Four floats that are reckoned with at once: by SSE2, which every x86-64 has, or one after another elsewhere. The bits
// are the same, since each of these operations is rounded exactly.
#pragma once

#include <cmath>
#include <cstddef>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace impinge {

#ifdef __SSE2__
class FourFloats {
 public:
  FourFloats() = default;
  explicit FourFloats(float all) : value_(_mm_set1_ps(all)) {}
  /// Four that stand one after another, at a multiple of 16 bytes.
  static FourFloats at(const float* first) { return {_mm_load_ps(first)}; }
  void store(float* first) const { _mm_store_ps(first, value_); }

  friend FourFloats operator+(FourFloats a, FourFloats b) { return {_mm_add_ps(a.value_, b.value_)}; }
  friend FourFloats operator-(FourFloats a, FourFloats b) { return {_mm_sub_ps(a.value_, b.value_)}; }
  friend FourFloats operator*(FourFloats a, FourFloats b) { return {_mm_mul_ps(a.value_, b.value_)}; }
  friend FourFloats operator/(FourFloats a, FourFloats b) { return {_mm_div_ps(a.value_, b.value_)}; }
  /// a where it is larger, else b: b too where either is not a number.
  friend FourFloats larger(FourFloats a, FourFloats b) { return {_mm_max_ps(a.value_, b.value_)}; }
  friend FourFloats square_root(FourFloats a) { return {_mm_sqrt_ps(a.value_)}; }
  friend FourFloats magnitude(FourFloats a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.value_)}; }
  /// Bit k: whether the k-th of a is larger than that of b, which nothing is that is not a number.
  friend unsigned is_larger(FourFloats a, FourFloats b) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmpgt_ps(a.value_, b.value_)));
  }

 private:
  FourFloats(__m128 value) : value_(value) {}
  __m128 value_;
};
#else
class FourFloats {
 public:
  FourFloats() = default;
  explicit FourFloats(float all) : value_{all, all, all, all} {}
  static FourFloats at(const float* first) {
    return each([&](int k) { return first[k]; });
  }
  void store(float* first) const {
    for (int k = 0; k < 4; ++k) first[k] = value_[k];
  }

  friend FourFloats operator+(FourFloats a, FourFloats b) {
    return each([&](int k) { return a.value_[k] + b.value_[k]; });
  }
  friend FourFloats operator-(FourFloats a, FourFloats b) {
    return each([&](int k) { return a.value_[k] - b.value_[k]; });
  }
  friend FourFloats operator*(FourFloats a, FourFloats b) {
    return each([&](int k) { return a.value_[k] * b.value_[k]; });
  }
  friend FourFloats operator/(FourFloats a, FourFloats b) {
    return each([&](int k) { return a.value_[k] / b.value_[k]; });
  }
  friend FourFloats larger(FourFloats a, FourFloats b) {
    return each([&](int k) { return a.value_[k] > b.value_[k] ? a.value_[k] : b.value_[k]; });
  }
  friend FourFloats square_root(FourFloats a) {
    return each([&](int k) { return std::sqrt(a.value_[k]); });
  }
  friend FourFloats magnitude(FourFloats a) {
    return each([&](int k) { return std::abs(a.value_[k]); });
  }
  friend unsigned is_larger(FourFloats a, FourFloats b) {
    unsigned bits = 0;
    for (int k = 0; k < 4; ++k) bits |= a.value_[k] > b.value_[k] ? 1u << k : 0u;
    return bits;
  }

 private:
  template <class Value>
  static FourFloats each(Value&& value) {
    FourFloats result;
    for (int k = 0; k < 4; ++k) result.value_[k] = value(k);
    return result;
  }
  float value_[4];
};
#endif

}  // namespace impinge
